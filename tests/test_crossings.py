"""`waggle crossings`: how random crossings are flown, counted and asked for."""

from collections.abc import Callable, Sequence
import math
import pathlib

import numpy as np
import pytest

from waggle_tasks.experiments.episodes import crossing, crossing_rows
from waggle_tasks.experiments.machine import table
from waggle_tasks.tasks import safety

Ask = Callable[[Sequence[Sequence[str]], pathlib.Path], list]


@pytest.fixture(scope='module')
def flown() -> list[crossing.Crossing]:
  return crossing.several(4, range(2))


def test_vehicles_cross_in_mujoco_without_contact(
  flown: list[crossing.Crossing],
) -> None:
  for each in flown:
    assert (each.vehicles, each.arrived, each.contacts) == (4, 4, 0)
    assert each.least_m > safety.MINIMUM_SPACING_M
    assert each.slower > 0.99  # Nobody is sooner than alone.
    assert 1.0 < each.last_s < crossing.LIMIT_S


@pytest.mark.slow
def test_a_crossing_is_that_of_its_seed_whatever_was_flown_before(
  flown: list[crossing.Crossing],
) -> None:
  assert crossing.several(4, range(1, 2)) == flown[1:]
  assert flown[0] != flown[1]


def test_who_touches_is_counted_as_a_pair(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  """Without the law they fly straight at each other."""
  ends_m = np.array([[0.0, -0.4, 1.3], [0.0, 0.4, 1.3]])
  drawn = iter([ends_m, ends_m[::-1]])
  monkeypatch.setattr(crossing, '_draw', lambda *_: next(drawn))
  monkeypatch.setattr(crossing, 'LIMIT_S', 3.0)
  monkeypatch.setattr(
    crossing.avoidance, 'step', lambda law, known, _: np.clip(
      known.goals_m - known.places_m, -0.3, 0.3
    ),
  )  # fmt: skip
  assert crossing.Airspace(2).fly(0).contacts == 1


@pytest.mark.slow
def test_a_table_has_a_line_for_each_number_of_vehicles(
  ask: Ask, tmp_path: pathlib.Path, flown: list[crossing.Crossing]
) -> None:
  line = ['crossings', '--vehicles=2,4', '--count=4', '--workers=1']
  ((status, said, files),) = ask([line], tmp_path)
  rows = [
    crossing_rows.row(each) for each in (crossing.several(2, range(2)), flown)
  ]
  assert said.strip() == table.render(crossing_rows.HEADER, rows).strip()
  assert (status, files) == (0, [])


def test_who_is_caught_is_told() -> None:
  caught = crossing.Crossing(3, 2, 0, 0.2, 1.5, math.nan)
  row = dict(
    zip(crossing_rows.HEADER, crossing_rows.row([caught]), strict=True)
  )
  assert (row['deadlocks'], row['arrived'], row['last s']) == ('1', '2/3', '-')


BAD = {
  '--vehicles=': '`vehicles` must be one number at least',
  '--vehicles=5,': '`vehicles` must be an integer',
  '--vehicles=1': '`vehicles` must be between 2 and 64: got 1',
  '--vehicles=65': '`vehicles` must be between 2 and 64: got 65',
  '--vehicles=-3': '`vehicles` must be between 2 and 64: got -3',
  '--vehicles=2.5': "`vehicles` must be an integer: got '2.5'",
  '--vehicles=many': "`vehicles` must be an integer: got 'many'",
  '--count=2': '`count` must be between 5 and',
  '--count=0': '`count` must be between 5 and',
  '--count=x': 'count',
  '--seed=-1': '`seed` must be between 0 and',
  '--workers=0': '`workers` must be',
}


@pytest.mark.slow
def test_bad_input_is_refused_in_one_line(
  ask: Ask, tmp_path: pathlib.Path
) -> None:
  answers = ask([['crossings', flag] for flag in BAD], tmp_path)
  for (flag, part), (status, said, files) in zip(
    BAD.items(), answers, strict=True
  ):
    assert (status, files) == (2, []), (flag, status, said)
    assert part in said, flag
    assert 'Traceback' not in said
