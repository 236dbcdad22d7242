"""The page of a run in a browser: what people see, and what a click does."""

import pathlib
import types

import pytest

from waggle_tasks.experiments.pages import document

CURSOR = "Number(plots[0].querySelector('.cursor').getAttribute('x1'))"


@pytest.fixture
def browser(chromium: types.ModuleType, recorded: object) -> object:
  with chromium.Browser() as browser:
    browser.open(recorded.folder / document.NAME)
    browser.wait('video.readyState >= 2')
    yield browser


def column(browser: object, time_s: float) -> float:
  """Where the cursor stands at a time, by the drawing's own attributes."""
  left, width, end = browser.eval(
    '[plots[0].dataset.left, plots[0].dataset.width, plots[0].dataset.end]'
    '.map(Number)'
  )
  return left + width * time_s / end


def test_it_loads_its_video_and_nothing_else(
  browser: object, recorded: object
) -> None:
  folder = recorded.folder.resolve().as_uri()
  names = {
    url.removeprefix(f'{folder}/')
    for url in browser.requests
    if not url.startswith('data:')  # The browser's own buttons.
  }
  assert names == {document.NAME, 'composite.webm'}
  end_s = recorded.rollout.times_s[-1]
  assert browser.eval('video.duration') == pytest.approx(end_s, abs=0.3)


@pytest.mark.parametrize('width', [1440, 1280, 1024, 820, 390])
def test_no_words_overlap_and_none_are_clipped(
  chromium: types.ModuleType, browser: object, width: int
) -> None:
  browser.resize(width, 800)
  assert browser.eval('document.documentElement.scrollWidth') <= width
  assert browser.eval(chromium.OVERLAPS) == []
  assert browser.eval(chromium.CLIPPED) == []


def test_the_cursor_follows_the_video(browser: object) -> None:
  browser.eval('video.currentTime = 20')
  browser.wait('!video.seeking && Math.abs(now - 20) < 0.2')
  assert browser.eval(CURSOR) == pytest.approx(column(browser, 20), abs=3)
  assert browser.eval("document.getElementById('now').textContent").startswith(
    '20.00 s'
  )
  browser.eval('video.play()')
  browser.wait('video.currentTime > 20.5')
  browser.eval('video.pause()')
  browser.wait('Math.abs(now - video.currentTime) < 0.15')
  time_s = browser.eval('now')
  assert browser.eval(CURSOR) == pytest.approx(column(browser, time_s))


@pytest.mark.parametrize('number', [0, 1, 4])
def test_a_click_on_a_plot_goes_there(browser: object, number: int) -> None:
  browser.eval(f'plots[{number}].scrollIntoView()')
  left, top, width, height = browser.eval(
    f'(({{left, top, width, height}}) => [left, top, width, height])'
    f'(plots[{number}].getBoundingClientRect())'
  )
  browser.click(left + 0.6 * width, top + height / 2)
  browser.wait('!video.seeking && now > 1')
  drawn = browser.eval(f'plots[{number}].viewBox.baseVal.width')
  cursor = browser.eval(CURSOR)
  assert cursor == pytest.approx(0.6 * drawn, abs=2)
  assert column(browser, browser.eval('video.currentTime')) == pytest.approx(
    cursor, abs=2
  )


def test_arrow_keys_step(browser: object) -> None:
  browser.eval('seek(10)')
  browser.eval(
    "plots[0].dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}))"
  )
  assert browser.eval('now') == pytest.approx(11)


def test_the_room_marks_where_everyone_is(
  browser: object, recorded: object
) -> None:
  way_m = recorded.rollout.positions_m['performer']
  for time_s in (0.0, 6.2, 40.0):
    browser.eval(f'seek({time_s})')
    maps, moved = browser.eval(
      '((plan) => [JSON.parse(plan.dataset.maps), plan.querySelector('
      "'g[data-name=performer]').getAttribute('transform')])(plans[1])"
    )
    x, y = map(float, moved.removeprefix('translate(')[:-1].split())
    (_, low_x, left, scale_x), (_, low_z, bottom, scale_z) = maps
    place_m = way_m[round(time_s / 0.04)]
    assert low_x + (x - left) / scale_x == pytest.approx(place_m[0], abs=0.03)
    assert low_z + (y - bottom) / scale_z == pytest.approx(place_m[2], abs=0.03)


def test_a_drawing_of_the_room_is_looked_at_from_nearer(
  browser: object,
) -> None:
  whole = browser.eval('plans[1].viewBox.baseVal.width')
  press = 'plans[1].parentElement.querySelector(\'[data-zoom="{}"]\').click()'
  browser.eval(press.format('2'))
  browser.eval(press.format('2'))
  assert browser.eval('plans[1].viewBox.baseVal.width') == whole / 4
  said = "plans[1].parentElement.querySelector('output').textContent"
  assert browser.eval(said).endswith(' m wide')
  browser.eval(press.format('0'))
  assert browser.eval('plans[1].viewBox.baseVal.width') == whole


def test_play_and_speed_are_buttons(browser: object) -> None:
  browser.eval("document.getElementById('play').click()")
  browser.wait('!video.paused')
  browser.wait("document.getElementById('play').textContent === 'Pause'")
  browser.eval("rate.value = 4, rate.dispatchEvent(new Event('change')), null")
  assert browser.eval('video.playbackRate') == 4


def test_paper_gets_plots_and_no_controls(browser: object) -> None:
  browser.media('print')
  shown = 'element => getComputedStyle(element).display !== "none"'
  hidden = "[...document.querySelectorAll('video, .bar, .now, .screen')]"
  assert browser.eval(f'{hidden}.length') >= 4
  assert not browser.eval(f'{hidden}.some({shown})')
  assert browser.eval(f'plots.every({shown})')


def test_without_a_video_a_click_moves_the_cursor_alone(
  chromium: types.ModuleType, copied: pathlib.Path
) -> None:
  from waggle_tasks.experiments.pages import run_page

  (copied / 'composite.webm').unlink()
  with chromium.Browser() as browser:
    browser.open(run_page.write(copied))
    browser.eval('seek(12)')
    assert browser.eval(CURSOR) == pytest.approx(column(browser, 12))
