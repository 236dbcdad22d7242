"""The dance is flown through MuJoCo's dynamics, and stops when it is told."""

from collections.abc import Callable
import math

from dm_control import composer
import hypothesis
from hypothesis import strategies as st
import mujoco
import numpy as np
import pytest

from waggle_tasks.arenas import layouts
from waggle_tasks.entities import crazyflie, performer
from waggle_tasks.protocol import (
  agreement,
  frame,
  gestures,
  payload,
  schedule,
  timing,
)

AGREED = agreement.Agreement()

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]

HOME_M = np.array([0.0, 0.0, 1.3])
YAW_RAD = layouts.performer_pose().yaw_rad
DANCE = schedule.broadcast(
  frame.motions(payload.Payload.from_bits('010010')),
  gestures.v_codebook(),
  timing.Timing(),
)


DANCER = performer.Performer()


@pytest.fixture
def dancer() -> performer.Performer:
  return DANCER


def motion(each: performer.Performer, time_s: float) -> np.ndarray:  # (3, 3)
  return np.stack(each.motion(HOME_M, YAW_RAD, time_s))


def test_the_front_observer_sees_the_dance_the_right_way_round(
  dancer: performer.Performer,
) -> None:
  """It looks along +y, so that its right is +x."""
  dancer.perform(DANCE)
  zero = DANCE.slots[1]
  for leg, (right_m, up_m) in enumerate(zero.gesture.corners_m):
    position_m = motion(dancer, zero.begin_s + leg * zero.gesture.leg_s)[0]
    np.testing.assert_allclose(
      position_m, HOME_M + np.array([right_m, 0.0, up_m]), atol=1e-9
    )


def test_the_dance_turns_with_the_dancer(dancer: performer.Performer) -> None:
  dancer.perform(DANCE)
  peak_s = DANCE.slots[-1].begin_s + 2.5  # END's left corner.
  position_m, _, _ = dancer.motion(np.zeros(3), 0.0, peak_s)
  np.testing.assert_allclose(position_m, (0, -0.285, 0), atol=1e-9)


@pytest.mark.slow
@hypothesis.settings(max_examples=60)
@hypothesis.given(st.floats(0.0, DANCE.end_s + 5.0))
def test_stopped_at_any_time_it_brakes_smoothly_and_hovers(
  stop_s: float,
) -> None:
  dancer = DANCER  # Not the fixture: every example would share it.
  dancer.perform(DANCE)
  dancer.stop(stop_s)
  before, at_stop = motion(dancer, stop_s - 1e-6), motion(dancer, stop_s)
  after = motion(dancer, stop_s + 1e-6)
  np.testing.assert_allclose(before, at_stop, atol=1e-4)
  np.testing.assert_allclose(after, at_stop, atol=1e-4)
  braking = np.stack(
    [motion(dancer, stop_s + t) for t in np.linspace(0, 0.8, 81)]
  )
  slope = (braking[2:, :2] - braking[:-2, :2]) / 0.02
  np.testing.assert_allclose(slope, braking[1:-1, 1:], atol=0.02)
  assert np.linalg.norm(braking[:, 1], axis=1).max() < 0.5
  assert np.linalg.norm(braking[:, 2], axis=1).max() < 2.0
  rest = motion(dancer, stop_s + 0.8)
  np.testing.assert_allclose(rest[1:], 0, atol=1e-9)
  for later_s in (1.0, 10.0, 1000.0):
    later = motion(dancer, stop_s + later_s)
    np.testing.assert_allclose(later, rest, atol=1e-9)


@pytest.mark.parametrize(
  ('stop_s', 'whole', 'end_s'),
  [(None, True, 92.0), (26.0, False, 26.0), (92.5, True, 92.0)],
)
def test_only_a_dance_that_nothing_cuts_short_is_whole(
  dancer: performer.Performer, stop_s: float | None, whole: bool, end_s: float
) -> None:
  dancer.perform(DANCE)
  if stop_s is not None:
    dancer.stop(stop_s)
  assert dancer.is_whole is whole
  assert dancer.end_s == pytest.approx(end_s)


def test_nothing_to_dance_is_a_hover(dancer: performer.Performer) -> None:
  dancer.perform(schedule.Schedule(()))
  assert not dancer.is_whole
  expected = [HOME_M, np.zeros(3), np.zeros(3)]
  np.testing.assert_array_equal(motion(dancer, 10.0), expected)


def test_the_first_stop_counts_and_a_new_dance_forgets_it(
  dancer: performer.Performer,
) -> None:
  dancer.perform(DANCE)
  dancer.stop(20.0)
  dancer.stop(50.0)
  assert dancer.end_s == 20.0
  dancer.perform(DANCE)
  assert dancer.is_whole


@pytest.mark.slow
def test_the_dance_is_followed_within_2_mm_from_its_begin_to_its_end(
  load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(cameras=False, observers=1, payload='010010')
  task, errors_m = environment.task, []
  for index, _ in enumerate(episode(environment, hover)):
    wanted_m = motion(task.performer, index * AGREED.frame_s)[0]
    position_m = task.positions_m(environment.physics)['performer']
    errors_m.append(np.linalg.norm(position_m - wanted_m))
  assert len(errors_m) > 2300
  assert max(errors_m) < 2e-3


@pytest.mark.slow
def test_the_vehicle_is_moved_by_forces_alone(
  load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(cameras=False, observers=1, duration_s=20.0)
  rows = []

  def look(physics: composer.Environment, *_: object) -> None:
    data = physics.data
    rows.append((physics.time(), *data.qpos[:3], *data.qvel[:3]))

  environment.add_extra_hook('after_substep', look)
  for _ in episode(environment, hover):
    pass
  time_s, position_m, velocity = np.split(np.array(rows), [1, 4], axis=1)
  step_s = np.diff(time_s, axis=0)
  assert len(rows) == round(20.0 / step_s[0, 0])
  # Each place follows from the velocity there, and that from finite forces.
  mean = (velocity[1:] + velocity[:-1]) / 2
  np.testing.assert_allclose(
    np.diff(position_m, axis=0), step_s * mean, atol=1e-3
  )
  force_n = crazyflie.MASS_KG * np.diff(velocity, axis=0) / step_s
  assert np.abs(force_n).max() < 0.05  # A fifth of the weight.
  assert np.ptp(position_m[:, 2]) > 0.6  # It did dance.


def test_gravity_pulls_and_thrust_carries(load: Load, hover: Fixture) -> None:
  environment = load(cameras=False, observers=1)
  observations = environment.reset().observation
  physics = environment.physics
  np.testing.assert_array_equal(physics.model.opt.gravity, (0, 0, -9.81))
  assert not physics.model.body_gravcomp.any()
  for _ in range(10):
    observations = environment.step(hover(observations)).observation
  lift_n = physics.data.qfrc_actuator[2]
  weight_n = crazyflie.MASS_KG * 9.81
  assert lift_n == pytest.approx(weight_n, rel=1e-3)
  physics.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
  for _ in range(10):
    environment.step(hover(observations))
  fallen_m = 1.3 - environment.task.positions_m(physics)['performer'][2]
  assert fallen_m == pytest.approx(9.81 * 0.4**2 / 2, rel=0.05)


@pytest.mark.slow
def test_the_dancer_stays_level_and_keeps_its_heading(
  load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(cameras=False, observers=1, duration_s=20.0)
  half_rad = YAW_RAD / 2
  level = (math.cos(half_rad), 0, 0, math.sin(half_rad))
  for _ in episode(environment, hover):
    np.testing.assert_allclose(
      environment.physics.data.qpos[3:7], level, atol=1e-3
    )
