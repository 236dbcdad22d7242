"""The law of avoidance: points that keep it come near nobody, and arrive."""

from collections.abc import Sequence
import dataclasses
import itertools
import math

import numpy as np
import pytest

from waggle_tasks.tasks import avoidance, cells, detours

LAW = avoidance.Law(0.18)
FRAME_S = 0.04


def level(places: Sequence[Sequence[float]]) -> np.ndarray:  # (N, 3)
  flat = np.reshape(np.array(places, float), (-1, 2))
  return np.column_stack([flat, np.full(len(flat), 1.3)])


@dataclasses.dataclass
class Flown:
  """How N vehicles flew."""

  places_m: np.ndarray  # (T, N, 3)
  velocities_mps: np.ndarray
  stayers_m: np.ndarray

  def least_m(self) -> float:
    """The least distance of two, those who stay included."""
    count = len(self.stayers_m)
    shape = len(self.places_m), count, 3
    stay = np.broadcast_to(self.stayers_m, shape)
    every = np.concatenate([self.places_m, stay], axis=1)
    pairs = itertools.combinations(range(self.places_m.shape[1] + count), 2)
    return min(
      np.linalg.norm(every[:, a] - every[:, b], axis=1).min()
      for a, b in pairs
      if a < self.places_m.shape[1]
    )


def fly(
  begins_m: np.ndarray,
  goals_m: np.ndarray,
  stayers_m: np.ndarray = np.zeros((0, 3)),
  limit_s: float = 30.0,
  frame_s: float = FRAME_S,
) -> Flown:
  """Flies points that do exactly what the law says, until all are there."""
  count, places, speeds = len(begins_m), begins_m, np.zeros_like(begins_m)
  others = [[j for j in range(count) if j != i] for i in range(count)]
  index = np.array(others, int).reshape(count, count - 1)
  stay = np.broadcast_to(stayers_m, (count, *stayers_m.shape))
  yields = np.ones((count, count - 1 + len(stayers_m)), bool)
  yields[:, count - 1 :] = False
  all_places, all_speeds = [places], [speeds]
  for _ in range(round(limit_s / frame_s)):
    known = avoidance.Known(
      places,
      speeds,
      goals_m,
      np.concatenate([places[index], stay], axis=1),
      np.concatenate([speeds[index], 0 * stay], axis=1),
      yields,
    )
    after = avoidance.step(LAW, known, frame_s)
    places, speeds = places + (speeds + after) * frame_s / 2, after
    all_places.append(places)
    all_speeds.append(speeds)
    if np.linalg.norm(places - goals_m, axis=1).max() < 2e-3:
      break
  return Flown(np.array(all_places), np.array(all_speeds), stayers_m)


def circle(count: int, radius_m: float) -> np.ndarray:
  angles = 2 * math.pi * np.arange(count) / count
  return level(radius_m * np.stack([np.cos(angles), np.sin(angles)], axis=1))


ANTIPODES = np.array([-1.0, -1.0, 1.0])
ROW = level([(0.25 * k, 0.0) for k in range(-3, 4)])
CUP = level([
  (0.6 * math.sin(0.35 * k), 0.6 * math.cos(0.35 * k)) for k in range(-6, 7)
])  # fmt: skip
CASES = {
  'head on': (level([(0, -1), (0, 1)]), level([(0, 1), (0, -1)]), level([])),
  'crossing': (level([(0, -1), (-1, 0)]), level([(0, 1), (1, 0)]), level([])),
  'through': (level([(0, -0.6)]), level([(0, 0.6)]), level([(0, 0)])),
  'through a row': (level([(0, -1)]), level([(0, 1)]), ROW),
  'out of a cup': (level([(0, 0)]), level([(0, 1.5)]), CUP),
  'swap beside one that stays': (
    level([(0, -0.5), (0, 0.5)]), level([(0, 0.5), (0, -0.5)]),
    level([(0.2, 0)]),
  ),
  'five': (circle(5, 0.8), circle(5, 0.8) * ANTIPODES, level([])),
  'twenty': (circle(20, 1.2), circle(20, 1.2) * ANTIPODES, level([])),
  'twenty, close': (circle(20, 0.8), circle(20, 0.8) * ANTIPODES, level([])),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize('name', CASES)
def test_all_arrive_and_nobody_comes_too_near(name: str) -> None:
  begins_m, goals_m, stayers_m = CASES[name]
  flown = fly(begins_m, goals_m, stayers_m)
  np.testing.assert_allclose(flown.places_m[-1], goals_m, atol=2e-3)
  assert flown.least_m() > LAW.spacing_m - 1e-3
  assert cells.length(flown.velocities_mps).max() < LAW.speed_mps + 1e-6
  change = cells.length(np.diff(flown.velocities_mps, axis=0)) / FRAME_S
  assert change.max() < LAW.acceleration_mps2 + 1e-6


@pytest.mark.parametrize('rate_hz', [10.0, 50.0])
@pytest.mark.parametrize('name', ['head on', 'through', 'five'])
def test_at_any_rate(name: str, rate_hz: float) -> None:
  begins_m, goals_m, stayers_m = CASES[name]
  flown = fly(begins_m, goals_m, stayers_m, 10.0, 1 / rate_hz)
  np.testing.assert_allclose(flown.places_m[-1], goals_m, atol=3e-3)
  assert flown.least_m() > LAW.spacing_m - 2e-3


def test_two_that_meet_pass_on_the_right() -> None:
  begins_m, goals_m, _ = CASES['head on']
  flown = fly(begins_m, goals_m)
  middle = np.abs(flown.places_m[:, 0, 1]).argmin()
  assert flown.places_m[middle, 0, 0] > 0.05  # It flies to +y: right is +x.
  assert flown.places_m[middle, 1, 0] < -0.05


def test_a_goal_that_is_anothers_place_is_come_near_to_and_held() -> None:
  flown = fly(level([(0, -1)]), level([(0, 0)]), level([(0, 0)]), 8.0)
  at_m = flown.places_m[-1, 0]
  assert np.linalg.norm(at_m - (0, 0, 1.3)) == pytest.approx(0.18, abs=0.01)
  np.testing.assert_allclose(flown.velocities_mps[-1], 0, atol=1e-3)


def test_a_vehicle_keeps_to_the_room() -> None:
  flown = fly(level([(8.0, 0)]), level([(9.5, 0)]), limit_s=6.0)
  assert flown.places_m[:, 0, 0].max() <= LAW.high_m[0] + 1e-3


def test_others_at_another_height_are_no_obstacle() -> None:
  above = np.array([[0.0, 0.0, 1.8]])
  flown = fly(level([(0, -0.6)]), level([(0, 0.6)]), above)
  np.testing.assert_allclose(flown.places_m[:, 0, 0], 0, atol=1e-9)


@pytest.mark.parametrize('gap_m', [0.0, 0.05, 0.1])
def test_those_too_near_already_part(gap_m: float) -> None:
  begins_m = level([(0, 0), (gap_m, 0)])
  flown = fly(begins_m, level([(-1, 0), (1, 0)]))
  np.testing.assert_allclose(np.abs(flown.places_m[-1, :, 0]), 1, atol=2e-3)


def test_the_same_is_flown_again() -> None:
  begins_m, goals_m, _ = CASES['five']
  one, other = (fly(begins_m, goals_m).places_m for _ in range(2))
  np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize('bad', [math.nan, math.inf])
@pytest.mark.parametrize(
  'field', ['places_m', 'velocities_mps', 'goals_m', 'others_m', 'others_mps']
)
def test_what_is_no_place_is_refused(field: str, bad: float) -> None:
  values = {
    'places_m': np.zeros((1, 3)), 'velocities_mps': np.zeros((1, 3)),
    'goals_m': np.zeros((1, 3)), 'others_m': np.zeros((1, 2, 3)),
    'others_mps': np.zeros((1, 2, 3)),
  }  # fmt: skip
  values[field] = values[field] + bad
  with pytest.raises(avoidance.AvoidanceError, match=f'`{field}` must be'):
    avoidance.Known(**values, yields=np.zeros((1, 2), bool))


@pytest.mark.parametrize(
  ('field', 'bad'),
  [
    ('spacing_m', 0.0), ('spacing_m', math.nan), ('speed_mps', -1.0),
    ('acceleration_mps2', 0.0), ('low_m', (9.0, 9.0, 9.0)),
  ],
)  # fmt: skip
def test_a_law_that_nobody_can_keep_is_refused(field: str, bad: object) -> None:
  with pytest.raises(avoidance.AvoidanceError, match=f'`{field}` must be'):
    dataclasses.replace(LAW, **{field: bad})


def test_a_free_place_is_the_nearest_one() -> None:
  goal_m, begin_m = level([(0, 0), (0, -1)])
  found = detours.free_m(goal_m, begin_m, level([(0, 0)]), 0.2)
  np.testing.assert_allclose(found, (0, -0.2, 1.3), atol=1e-9)
  for aside_m in (-0.02, 0.0, 0.02):  # It is not a matter of millimetres.
    (about_m,) = level([(aside_m, 0.02)])
    near_m = detours.free_m(about_m, begin_m, level([(0, 0)]), 0.2)
    np.testing.assert_allclose(near_m, (0, -0.2, 1.3), atol=1e-9)
  found = detours.free_m(goal_m, begin_m, level([(0, 0.1)]), 0.2)
  np.testing.assert_allclose(found, (0, -0.1, 1.3), atol=1e-9)
  assert detours.free_m(goal_m, begin_m, level([(1, 0)]), 0.2) is goal_m
