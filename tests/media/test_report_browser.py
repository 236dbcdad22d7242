"""The page of a run in a browser: what people see, and what a click does."""

import pathlib

import chromium
import pytest

from waggle_tasks.experiments.pages import document, run_page

CURSOR = "Number(plots[0].querySelector('.cursor').getAttribute('x1'))"


@pytest.fixture
def page(browser: chromium.Browser, recorded: object) -> chromium.Browser:
  """The browser with the page of a run."""
  browser.open(recorded.folder / document.NAME)
  browser.wait('video.readyState >= 2')
  return browser


def column(page: chromium.Browser, time_s: float) -> float:
  """Where the cursor stands at a time, by the drawing's own attributes."""
  left, width, end = page.eval(
    '[plots[0].dataset.left, plots[0].dataset.width, plots[0].dataset.end]'
    '.map(Number)'
  )
  return left + width * time_s / end


def test_it_loads_its_video_and_nothing_else(
  page: chromium.Browser, recorded: object
) -> None:
  folder = recorded.folder.resolve().as_uri()
  names = {
    url.removeprefix(f'{folder}/')
    for url in page.requests
    if not url.startswith('data:')  # The browser's own buttons.
  }
  assert names == {document.NAME, 'composite.webm'}
  end_s = recorded.rollout.times_s[-1]
  assert page.eval('video.duration') == pytest.approx(end_s, abs=0.5)


@pytest.mark.parametrize('width', [1440, 1280, 1024, 820, 390])
def test_no_words_overlap_and_none_are_clipped(
  page: chromium.Browser, width: int
) -> None:
  page.resize(width, 800)
  assert page.eval('document.documentElement.scrollWidth') <= width
  assert page.eval(chromium.OVERLAPS) == []
  assert page.eval(chromium.CLIPPED) == []


def test_the_cursor_follows_the_video(page: chromium.Browser) -> None:
  page.eval('video.currentTime = 20')
  page.wait('!video.seeking && Math.abs(now - 20) < 0.2')
  assert page.eval(CURSOR) == pytest.approx(column(page, 20), abs=3)
  assert page.eval("document.getElementById('now').textContent").startswith(
    '20.00 s'
  )
  page.eval('video.play()')
  page.wait('video.currentTime > 20.5')
  page.eval('video.pause()')
  page.wait('Math.abs(now - video.currentTime) < 0.15')
  time_s = page.eval('now')
  assert page.eval(CURSOR) == pytest.approx(column(page, time_s))


@pytest.mark.parametrize('number', [0, 1, 4])
def test_a_click_on_a_plot_goes_there(
  page: chromium.Browser, number: int
) -> None:
  page.eval(f'plots[{number}].scrollIntoView()')
  left, top, width, height = page.eval(
    f'(({{left, top, width, height}}) => [left, top, width, height])'
    f'(plots[{number}].getBoundingClientRect())'
  )
  page.click(left + 0.6 * width, top + height / 2)
  page.wait('!video.seeking && now > 1')
  drawn = page.eval(f'plots[{number}].viewBox.baseVal.width')
  cursor = page.eval(CURSOR)
  assert cursor == pytest.approx(0.6 * drawn, abs=2)
  assert column(page, page.eval('video.currentTime')) == pytest.approx(
    cursor, abs=2
  )


def test_arrow_keys_step(page: chromium.Browser) -> None:
  page.eval('seek(10)')
  page.eval(
    "plots[0].dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}))"
  )
  assert page.eval('now') == pytest.approx(11)


def test_the_room_marks_where_everyone_is(
  page: chromium.Browser, recorded: object
) -> None:
  way_m = recorded.rollout.positions_m['performer']
  for time_s in (0.0, 6.2, 40.0):
    page.eval(f'seek({time_s})')
    maps, moved = page.eval(
      '((plan) => [JSON.parse(plan.dataset.maps), plan.querySelector('
      "'g[data-name=performer]').getAttribute('transform')])(plans[1])"
    )
    x, y = map(float, moved.removeprefix('translate(')[:-1].split())
    (_, low_x, left, scale_x), (_, low_z, bottom, scale_z) = maps
    place_m = way_m[round(time_s / 0.04)]
    assert low_x + (x - left) / scale_x == pytest.approx(place_m[0], abs=0.03)
    assert low_z + (y - bottom) / scale_z == pytest.approx(place_m[2], abs=0.03)


def test_a_drawing_of_the_room_is_looked_at_from_nearer(
  page: chromium.Browser,
) -> None:
  whole = page.eval('plans[1].viewBox.baseVal.width')
  press = 'plans[1].parentElement.querySelector(\'[data-zoom="{}"]\').click()'
  page.eval(press.format('2'))
  page.eval(press.format('2'))
  assert page.eval('plans[1].viewBox.baseVal.width') == whole / 4
  said = "plans[1].parentElement.querySelector('output').textContent"
  assert page.eval(said).endswith(' m wide')
  page.eval(press.format('0'))
  assert page.eval('plans[1].viewBox.baseVal.width') == whole


def test_play_and_speed_are_buttons(page: chromium.Browser) -> None:
  page.eval("document.getElementById('play').click()")
  page.wait('!video.paused')
  page.wait("document.getElementById('play').textContent === 'Pause'")
  page.eval("rate.value = 4, rate.dispatchEvent(new Event('change')), null")
  assert page.eval('video.playbackRate') == 4


def test_paper_gets_plots_and_no_controls(page: chromium.Browser) -> None:
  page.media('print')
  shown = 'element => getComputedStyle(element).display !== "none"'
  hidden = "[...document.querySelectorAll('video, .bar, .now, .screen')]"
  assert page.eval(f'{hidden}.length') >= 4
  assert not page.eval(f'{hidden}.some({shown})')
  assert page.eval(f'plots.every({shown})')


def test_without_a_video_a_click_moves_the_cursor_alone(
  browser: chromium.Browser, copied: pathlib.Path
) -> None:
  (copied / 'composite.webm').unlink()
  browser.open(run_page.write(copied))
  browser.eval('seek(12)')
  assert browser.eval(CURSOR) == pytest.approx(column(browser, 12))
