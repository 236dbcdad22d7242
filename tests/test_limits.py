"""A dance is one that the vehicle can fly, or it is refused before."""

from collections.abc import Callable
import dataclasses

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.entities import controller, crazyflie, performer
from waggle_tasks.protocol import (
  decoys,
  gestures,
  limits,
  minimum_jerk,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import Symbol

Load = Callable[..., composer.Environment]


@dataclasses.dataclass(frozen=True, eq=False)
class Leg:
  """A straight way, flown minimum jerk."""

  begin_m: np.ndarray
  end_m: np.ndarray
  duration_s: float
  symbol: Symbol = Symbol.UNKNOWN

  def motion(self, elapsed_s: float) -> tuple[np.ndarray, ...]:
    return minimum_jerk.between(
      self.begin_m, self.end_m, elapsed_s, self.duration_s
    )


def leg(*end_m: float, duration_s: float, begin_m: tuple = ()) -> Leg:
  begin = np.array(begin_m or np.zeros(len(end_m)))
  return Leg(begin, np.array(end_m), duration_s)


def test_the_limits_are_the_controllers() -> None:
  mass_kg, weight_n = crazyflie.MASS_KG, crazyflie.MASS_KG * 9.81
  low_n, high_n = controller.THRUST_N
  up = (high_n - weight_n) / mass_kg
  assert up == pytest.approx(limits.MAX_UP_MPS2, rel=2e-3)
  down = (weight_n - low_n) / mass_kg
  assert down == pytest.approx(limits.MAX_DOWN_MPS2)
  sideways = np.array(controller.SIDEWAYS_N) / mass_kg
  most = limits.MAX_SIDEWAYS_MPS2
  np.testing.assert_allclose(sideways, [-most, most], rtol=2e-3)


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    (
      {'duration_s': 2.0},
      r'`gesture START` must accelerate upwards by at most 3.15 m/s\^2, which'
      r' the vehicle has: got 3.58 m/s\^2 in 2 s; in 2.33 s it can be flown',
    ),
    ({'start_height_m': 0.3, 'duration_s': 2.0}, r'`gesture 0` .*got 6.58 m/s'),
    (
      {'half_width_m': 0.25, 'start_height_m': 0.3, 'duration_s': 2.6},
      r'`gesture 0` must accelerate upwards .* got 3.42',
    ),
    (
      {'duration_s': 3.0},
      '`gesture END` must fly along an axis at no more than 1 m/s.* got 1.07',
    ),
  ],
)
def test_a_codebook_that_cannot_be_flown_is_refused(
  changes: dict[str, float], error: str
) -> None:
  codebook = gestures.v_codebook(**changes)  # A receiver may know it.
  with pytest.raises(limits.LimitError, match=error):
    scenario.Scenario(codebook=codebook)


@pytest.mark.parametrize(
  ('paths', 'error'),
  [
    ([leg(0.0, 1.0, duration_s=1.0)], 'path 1 .UNKNOWN.` must accelerate up'),
    ([leg(1.0, 0.0, duration_s=1.0)], 'must accelerate sideways'),
    ([leg(0.0, 0.0, 1.0, duration_s=1.0)], 'must accelerate sideways'),
    ([leg(0.0, -1.0, duration_s=0.7)], 'upwards'),  # To brake.
    ([leg(2.0, 0.0, duration_s=3.0)], 'no more than 1 m/s.*1.25 m/s in 3 s'),
    (
      [leg(0.1, 0.0, duration_s=2.0), leg(0.1, 0.0, duration_s=2.0)],
      r'`path 2 \(UNKNOWN\)` must begin where .* ended: got 0.100 m',
    ),
    (
      [leg(0.1, 0.0, duration_s=2.0, begin_m=(0.1, 0.1))],
      r'`path 1 \(UNKNOWN\)` must begin where',
    ),
    ([leg(np.nan, 0.0, duration_s=2.0)], 'must begin and end at rest'),
  ],
)
def test_a_schedule_that_cannot_be_flown_is_refused_by_the_performer(
  paths: list[Leg], error: str
) -> None:
  dancer = performer.Performer()
  before = dancer.schedule
  with pytest.raises(limits.LimitError, match=error):
    dancer.perform(schedule.lay_out(paths, timing.Timing()))
  assert dancer.schedule is before


def test_a_path_that_jumps_or_does_not_rest_is_refused() -> None:
  @dataclasses.dataclass(frozen=True, eq=False)
  class Odd(Leg):
    rate_mps: float = 0.0
    jump_m: float = 0.0

    def motion(self, elapsed_s: float) -> tuple[np.ndarray, ...]:
      at_m = self.jump_m if elapsed_s > 1.0 else 0.0
      return np.array([at_m, 0.0]), np.array([self.rate_mps, 0]), np.zeros(2)

  for changes, error in (
    ({'jump_m': 0.1}, 'no more than 1 m/s'),
    ({'rate_mps': 0.3}, 'begin and end at rest: got 0.30 m/s'),
  ):
    odd = Odd(np.zeros(2), np.zeros(2), 2.0, **changes)
    with pytest.raises(limits.LimitError, match=error):
      limits.check_schedule(schedule.lay_out([odd], timing.Timing()))


def test_paths_that_overlap_are_refused() -> None:
  slots = [schedule.Slot(leg(0.0, 0.0, duration_s=2.0), t) for t in (1.0, 2.5)]
  with pytest.raises(limits.LimitError, match=r'over, at 3 s: got 2.5 s'):
    limits.check_schedule(schedule.Schedule(tuple(slots)))


@pytest.mark.slow
@pytest.mark.parametrize('name', decoys.DECOYS)
def test_decoys_can_be_flown(name: str) -> None:
  for seed in range(5):
    book = gestures.v_codebook()
    limits.check_schedule(decoys.perform(name, seed, book, timing.Timing()))


@pytest.mark.slow
@pytest.mark.parametrize(
  ('sizes', 'duration_s'), [((0.285, 0.62), 3.3), ((0.12, 0.25), 2.0)]
)
def test_what_is_accepted_is_flown_within_millimetres(
  sizes: tuple[float, float],
  duration_s: float,
  load: Load,
  hover: Callable[..., object],
) -> None:
  environment = load(
    cameras=False,
    observers=1,
    payload='011010',
    codebook=gestures.v_codebook(*sizes, duration_s=duration_s),
    pauses=timing.Timing(0.2, 0.0, 0.2, 0.0),
  )
  timestep, task = environment.reset(), environment.task
  home_m, worst_m = np.array([0.0, 0.0, 1.3]), 0.0
  while (time_s := environment.physics.time()) < task.performer.end_s:
    timestep = environment.step(hover(timestep.observation))
    wanted_m, _, _ = task.performer.motion(home_m, -np.pi / 2, time_s + 0.04)
    flown_m = task.positions_m(environment.physics)['performer']
    worst_m = max(worst_m, np.linalg.norm(wanted_m - flown_m))
  assert worst_m < 0.004
