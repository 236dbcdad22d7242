// Binds the cursor of every plot over time to the video, and clicks to it.
'use strict';

const video = document.querySelector('video');
const plots = [...document.querySelectorAll('svg.timed')];
const plans = [...document.querySelectorAll('svg.plan')];
let now = 0;

// The last entry [time, ...] that has begun.
function latest(entries, time) {
  let found = entries[0];
  for (const entry of entries) if (entry[0] <= time + 1e-6) found = entry;
  return found;
}

// Where a moment [time, x, y, z] is on a drawing of the room.
function place(plan, moment) {
  return JSON.parse(plan.dataset.maps).map(
    ([axis, low, begin, scale]) => begin + (moment[axis + 1] - low) * scale);
}

// Marks where everyone is, with the way of the last seconds.
function mark(plan) {
  for (const mark of plan.querySelectorAll('[data-name]')) {
    const way = RUN.ways[mark.dataset.name];
    const here = latest(way, now);
    if (mark.tagName === 'g') {
      mark.removeAttribute('visibility');
      mark.setAttribute('transform', `translate(${place(plan, here).join(' ')})`);
    } else {
      const trail = way.filter(([time]) => now - 8 <= time && time <= now + 1e-6);
      mark.setAttribute('points', trail.map((m) => place(plan, m)).join(' '));
    }
  }
}

// Buttons and dragging choose which part of a drawing is seen.
function zoomable(plan) {
  const {width, height} = plan.viewBox.baseVal;
  const bar = plan.parentElement.querySelector('.zooms');
  const said = bar.querySelector('output');
  const metre = Math.abs(JSON.parse(plan.dataset.maps)[0][3]);
  let nearer = 1, middle = [width / 2, height / 2], from = null;
  const look = () => {
    const seen = [width / nearer, height / nearer];
    middle = middle.map((at, k) => Math.min(
      Math.max(at, seen[k] / 2), [width, height][k] - seen[k] / 2));
    const corner = middle.map((at, k) => at - seen[k] / 2);
    plan.setAttribute('viewBox', [...corner, ...seen].join(' '));
    plan.style.setProperty('--nearer', nearer);
    plan.classList.toggle('near', nearer > 1);
    said.textContent =
      nearer > 1 ? `${(seen[0] / metre).toPrecision(2)} m wide` : '';
  };
  bar.hidden = false;
  for (const button of bar.querySelectorAll('button')) {
    button.addEventListener('click', () => {
      const factor = Number(button.dataset.zoom);
      // From the whole, go to the dance: that is what is hard to see.
      if (nearer === 1 && factor > 1) {
        middle = place(plan, latest(RUN.ways.performer, now));
      }
      nearer = factor ? Math.min(Math.max(nearer * factor, 1), 32) : 1;
      look();
    });
  }
  plan.addEventListener('pointerdown', (event) => {
    if (nearer === 1) return;
    plan.setPointerCapture(event.pointerId);
    from = [event.clientX, event.clientY, ...middle];
  });
  plan.addEventListener('pointermove', (event) => {
    if (!from) return;
    const unit = width / nearer / plan.getBoundingClientRect().width;
    middle = [from[2] - (event.clientX - from[0]) * unit,
              from[3] - (event.clientY - from[1]) * unit];
    look();
  });
  plan.addEventListener('pointerup', () => { from = null; });
}

function show(time) {
  now = Math.min(Math.max(time, 0), RUN.end);
  for (const plot of plots) {
    const {left, width, end} = plot.dataset;
    const x = Number(left) + Number(width) * now / Number(end);
    const cursor = plot.querySelector('.cursor');
    cursor.setAttribute('x1', x);
    cursor.setAttribute('x2', x);
  }
  for (const plan of plans) mark(plan);
  const sent = RUN.sent.find(([from, to]) => from <= now && now < to);
  const said = Object.entries(RUN.readings).map(
    ([name, entries]) => `${name} ${latest(entries, now)[1]}`);
  document.getElementById('now').textContent =
    [`${now.toFixed(2)} s`, `sent ${sent ? sent[2] : 'NULL'}`, ...said]
      .join(' \u00b7 ');
}

function seek(time) {
  show(time);
  if (video) video.currentTime = now;
}

for (const plot of plots) {
  plot.tabIndex = 0;
  plot.addEventListener('click', (event) => {
    const {left, width, end} = plot.dataset;
    const box = plot.getBoundingClientRect();
    const x = (event.clientX - box.left) * plot.viewBox.baseVal.width / box.width;
    seek((x - left) / width * end);
  });
  plot.addEventListener('keydown', (event) => {
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (step) {
      event.preventDefault();
      seek(now + step * (event.shiftKey ? 10 : 1));
    }
  });
}

for (const button of document.querySelectorAll('[data-film]')) {
  button.addEventListener('click', () => {
    const time = now;
    video.src = button.dataset.film;
    video.addEventListener('loadedmetadata', () => seek(time), {once: true});
  });
}

plans.forEach(zoomable);

if (video) {
  // The browser's own controls would cover the strip of events.
  video.controls = false;
  document.querySelector('.bar').hidden = false;
  const play = document.getElementById('play');
  const rate = document.getElementById('rate');
  const toggle = () => (video.paused ? video.play() : video.pause());
  play.addEventListener('click', toggle);
  video.addEventListener('click', toggle);
  for (const name of ['play', 'pause', 'ended']) {
    video.addEventListener(name, () => {
      play.textContent = video.paused ? 'Play' : 'Pause';
    });
  }
  rate.addEventListener('change', () => {
    video.playbackRate = Number(rate.value);
  });
  document.getElementById('full').addEventListener(
    'click', () => video.requestFullscreen());
  const follow = () => {
    show(video.currentTime);
    if (!video.paused && !video.ended) requestAnimationFrame(follow);
  };
  for (const name of ['play', 'seeked', 'timeupdate', 'loadeddata']) {
    video.addEventListener(name, follow);
  }
}
show(0);
