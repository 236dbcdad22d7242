"""The page of a run shows how vehicles hovered, as hovers are measured."""

import math
import pathlib
from unittest import mock

import numpy as np

from waggle_tasks import plain, scenario
from waggle_tasks.experiments.pages import hover_part
from waggle_tasks.experiments.record import archive
from waggle_tasks.tasks import drift

END_S = 96.0
TIMES_S = np.arange(0.0, END_S, 0.04)


def run(scene: scenario.Scenario, ways_m: dict[str, np.ndarray]) -> archive.Run:
  """A run whose vehicles went these ways."""
  config = archive.Flown('klt', plain.to_plain(scene), scene.agreement)
  return archive.Run(
    pathlib.Path(), config, mock.Mock(), {}, {'observer_1': ()}, {}, TIMES_S,
    ways_m,
  )  # fmt: skip


def hovering(**changes: object) -> scenario.Scenario:
  return scenario.Scenario(observers=1, drift=drift.Drift(**changes))


def wave(amplitude_mm: float, hz: float) -> np.ndarray:
  way_m = np.zeros((len(TIMES_S), 3))
  way_m[:, 0] = amplitude_mm / 1000 * np.sin(2 * math.pi * hz * TIMES_S)
  return way_m


def cells(page: str, row: str) -> list[str]:
  """What a row of the table says."""
  _, _, rest = page.partition(f'<th scope="row">{row}</th>')
  line, _, _ = rest.partition('</tr>')
  return [each.partition('</td>')[0] for each in line.split('<td>')[1:]]


def test_a_hover_is_shown_by_band_beside_what_was_asked_for() -> None:
  ways_m = {'performer': wave(3.0, 1.5), 'observer_1': np.zeros((2400, 3))}
  scene = hovering(performer_hover='mocap', hover_amplitude=0.5)
  page = str(hover_part.draw(run(scene, ways_m)))
  told, rms, speed, *bands = cells(page, 'performer, x')
  assert told.endswith(' windows')
  assert abs(float(rms) - 3 / math.sqrt(2)) < 0.05
  assert abs(float(speed) - float(rms) * 2 * math.pi * 1.5) < 0.5
  assert abs(float(bands[2]) - float(rms)) < 0.05  # From 1 to 2 Hz.
  assert [*map(float, bands[:1] + bands[3:])] == [0.0, 0.0, 0.0]
  # Half of what motion capture shows along x.
  assert '<td>asked for</td><td>2.80</td><td>6.00</td><td>1.65</td>' in page
  assert 'observer_1' not in page  # Who stays in its place has no hover.


def test_a_dance_is_no_part_of_a_hover() -> None:
  scene = hovering(performer_hover='lighthouse')
  made = run(scene, {'performer': wave(0.5, 1.5)})
  way_m = made.positions_m['performer']
  for each in made.sent:
    moving = (each.begin_s < TIMES_S) & (each.end_s > TIMES_S)
    way_m[moving] += 0.3
  page = str(hover_part.draw(made))
  assert float(cells(page, 'performer, x')[1]) < 0.4


def test_who_dances_all_the_time_has_nothing_to_show() -> None:
  scene = scenario.Scenario(
    observers=1, language='swift', drift=drift.Drift(performer_hover='mocap')
  )
  made = run(scene, {'performer': wave(1.0, 1.0)})
  short = archive.Run(**{**vars(made), 'times_s': TIMES_S[:160]})
  short.positions_m['performer'] = wave(1.0, 1.0)[:160]
  page = str(hover_part.draw(short))
  assert cells(page, 'performer') == ['never long enough at its place']


def test_without_anything_that_takes_vehicles_away_there_is_no_such_part() -> (
  None
):
  assert hover_part.draw(run(scenario.Scenario(observers=1), {})) is None
