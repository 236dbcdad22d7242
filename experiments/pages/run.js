// Binds the cursor of every plot over time to the video, and clicks to it.
'use strict';

const video = document.querySelector('video');
const plots = [...document.querySelectorAll('svg.timed')];
let now = 0;

// The last entry [time, ...] that has begun.
function latest(entries, time) {
  let found = entries[0];
  for (const entry of entries) if (entry[0] <= time + 1e-6) found = entry;
  return found;
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
