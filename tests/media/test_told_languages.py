"""What people see of a broadcast in levels: its page, its film, its text."""

from collections.abc import Callable
import pathlib
import subprocess

import chromium
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import receiver
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.pages import document, run_page
from waggle_tasks.experiments.record import capture, provenance, story, writer
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import film, layout, moment
from waggle_tasks.protocol.symbols import Symbol

Waggle = Callable[..., subprocess.CompletedProcess[str]]
SCENE = scenario.Scenario(observers=1, language='swift')


@pytest.fixture(scope='module')
def run(
  tmp_path_factory: pytest.TempPathFactory,
) -> tuple[pathlib.Path, rollout_lib.Rollout]:
  """A broadcast in swift, filmed as one observer's camera would."""
  folder = tmp_path_factory.mktemp('swift')
  with (
    film.Film(
      folder, SCENE, view='observer_1', fps=25.0, marks=False
    ) as camera,
    capture.Recorder(folder) as recorder,
  ):
    flown = rollout_lib.run(SCENE, 'joint', [camera, recorder])
  verdict = evaluator.evaluate(SCENE, flown)
  origin = provenance.Start.now('waggle x').end(flown.renderer)
  writer.write_run(folder, SCENE, 'joint', flown, verdict, origin)
  run_page.write(folder)
  return folder, flown


@pytest.fixture(scope='module')
def page(run: tuple[pathlib.Path, object]) -> str:
  return (run[0] / document.NAME).read_text(encoding='utf-8')


@pytest.mark.slow
def test_a_page_tells_each_level_that_was_sent_and_read(page: str) -> None:
  for number, level in enumerate('0276'):
    assert f'sent level {level}, ' in page, number
    assert f'read level {level}, ' in page, number
  assert '"level 7"' in page  # For the line that follows the cursor.
  assert 'LEVEL' not in page
  assert 'first null' not in page


@pytest.mark.slow
def test_a_page_has_the_word_and_how_clear_it_is(
  page: str, run: tuple[pathlib.Path, rollout_lib.Rollout]
) -> None:
  (end,) = [
    event
    for event in run[1].events['observer_1']
    if isinstance(event, receiver.Event) and event.word is not None
  ]
  row = page.split('Frames of observer_1')[1].split('</tbody>')[0]
  assert f'<td>{end.clear:.2f}</td>' in row
  assert 'payload 000010' in row
  assert row.count('class="symbol"') == 6
  assert '\u2713' in row
  assert 'no track' not in page


@pytest.mark.slow
def test_a_page_draws_heights_over_the_levels(page: str) -> None:
  assert 'dashed: levels 0 to 7, from below' in page
  assert 'gesture 1 from the front' not in page


@pytest.mark.slow
@pytest.mark.parametrize('width', [1280, 820])
def test_no_words_overlap(
  browser: chromium.Browser,
  run: tuple[pathlib.Path, object],
  width: int,
) -> None:
  browser.open(run[0] / document.NAME)
  browser.resize(width, 800)
  assert browser.eval(chromium.OVERLAPS) == []
  assert browser.eval(chromium.CLIPPED) == []
  browser.eval('show(4.3)')
  now = browser.eval("document.getElementById('now').textContent")
  assert 'sent level 2' in now


@pytest.mark.slow
def test_a_strip_shows_what_was_read_below_what_was_sent(
  run: tuple[pathlib.Path, rollout_lib.Rollout],
) -> None:
  names, events = ('observer_1',), run[1].events['observer_1']
  (composite,) = [film.composite(SCENE, names)]
  plan = layout.plan(1)
  drawn = composite.draw(
    moment.Instant(
      8.0, None,
      (moment.View('observer_1', np.zeros((48, 64, 3), np.uint8), None,
                   np.empty((0, 2)), story.Reading(SCENE.agreement), events),),
      {name: np.zeros((48, 64, 3), np.uint8) for name in layout.SHARED},
      {name: {} for name in layout.SHARED},
    )
  )[plan.strip.slices]  # fmt: skip
  green = (drawn == palette.rgb(palette.SYMBOLS[Symbol.LEVEL])).all(axis=2)
  rows = np.flatnonzero(green.any(axis=1))
  first, second = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
  spans = [np.flatnonzero(green[each].any(axis=0)) for each in (first, second)]
  a_frame = SCENE.agreement.frame_s / SCENE.episode_s * plan.strip.width
  assert spans[0][0] == pytest.approx(spans[1][0], abs=2 * a_frame)
  assert spans[0][-1] == pytest.approx(spans[1][-1], abs=2 * a_frame)


@pytest.mark.slow
def test_a_film_is_read_in_the_language_of_its_run(
  run: tuple[pathlib.Path, object], waggle: Waggle
) -> None:
  folder, _ = run
  asked = f'--config={folder / "config.json"}'
  child = waggle('decode', str(folder / 'observer_1.webm'), asked)
  assert child.returncode == 0, child.stderr
  assert 'joint: message 000010' in child.stdout
  assert ': 0 2 7 6, payload 000010, clear ' in child.stdout
