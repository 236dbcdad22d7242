"""What counts as moving too early, arriving and holding, frame by frame."""

import numpy as np
import pytest

from waggle_tasks.tasks import objectives, progress

HOME_M = np.array([0.0, -1.3, 1.3])
TARGET_M = HOME_M + np.array([0.0, 0.4, 0.0])
REST = np.zeros(3)


@pytest.fixture
def mover() -> progress.Progress:
  return progress.Progress(HOME_M, TARGET_M)


def reward(
  each: progress.Progress,
  place_m: np.ndarray,
  velocity_mps: np.ndarray,
  authorised: bool,
) -> float:
  """What a frame earns."""
  moment = each.update(place_m, velocity_mps, authorised)
  return objectives.Arrive().reward(moment)


def rewards(
  each: progress.Progress,
  offset_m: float,
  count: int,
  speed_mps: float = 0.0,
  authorised: bool = True,
) -> list[float]:
  """The rewards of frames at a distance from the target, along x."""
  place_m = TARGET_M + np.array([offset_m, 0.0, 0.0])
  velocity = np.array([0.0, speed_mps, 0.0])
  return [reward(each, place_m, velocity, authorised) for _ in range(count)]


def test_arrival_is_rewarded_once_after_standing_for_0_4_s(
  mover: progress.Progress,
) -> None:
  # 0.4 s pass between the first and the eleventh frame of 0.04 s.
  assert rewards(mover, 0.0, 100) == [0.0] * 10 + [1.0] + [0.0] * 89
  assert mover.arrived


@pytest.mark.parametrize(
  ('offset_m', 'speed_mps', 'arrives'),
  [
    (0.0149, 0.0249, True),
    (0.0151, 0.0, False),
    (0.0, 0.0251, False),
  ],
)
def test_arrival_is_near_and_slow(
  mover: progress.Progress, offset_m: float, speed_mps: float, arrives: bool
) -> None:
  got = rewards(mover, offset_m, 20, speed_mps)
  assert sum(got) == (1.0 if arrives else 0.0)
  assert mover.arrived is arrives


def test_leaving_begins_the_dwell_anew(mover: progress.Progress) -> None:
  for _ in range(5):
    assert rewards(mover, 0.0, 10) == [0.0] * 10
    assert rewards(mover, 0.02, 1) == [0.0]
  assert rewards(mover, 0.0, 11)[-1] == 1.0


# The episode goes on for 0.2 s after the 2 s of holding.
HOLD_FRAMES = 55


def test_it_is_done_after_a_hold_of_2_s(mover: progress.Progress) -> None:
  rewards(mover, 0.0, 11)
  rewards(mover, 0.0, HOLD_FRAMES - 1)
  assert not mover.done
  rewards(mover, 0.0, 1)
  assert mover.done


def test_a_hold_that_is_broken_begins_anew(mover: progress.Progress) -> None:
  rewards(mover, 0.0, 11 + HOLD_FRAMES - 1)
  rewards(mover, 0.02, 1)
  rewards(mover, 0.0, HOLD_FRAMES - 1)
  assert not mover.done
  rewards(mover, 0.0, 1)
  assert mover.done


def test_a_message_that_leads_nowhere_is_never_done() -> None:
  stays = progress.Progress(HOME_M, HOME_M)
  for _ in range(100):
    stays.update(HOME_M, REST, True)
  assert stays.arrived
  assert not stays.done


def test_moving_early_costs_one_once(mover: progress.Progress) -> None:
  got = rewards(mover, 0.0, 5, authorised=False)
  assert got == [-1.0, 0.0, 0.0, 0.0, 0.0]
  assert mover.trespassed


def test_who_moved_early_never_arrives(mover: progress.Progress) -> None:
  rewards(mover, 0.0, 1, authorised=False)
  assert rewards(mover, 0.0, 100) == [0.0] * 100
  assert not mover.done


@pytest.mark.parametrize('authorised', [False, True])
def test_without_a_message_every_motion_is_early(authorised: bool) -> None:
  waiting = progress.Progress(HOME_M, None)
  assert reward(waiting, HOME_M, REST, authorised) == 0
  near_m, far_m = HOME_M + 0.005, HOME_M + 0.006  # Times sqrt(3).
  assert reward(waiting, near_m, REST, authorised) == 0
  assert reward(waiting, far_m, REST, authorised) == -1
  assert not waiting.done


def test_staying_at_home_earns_nothing(mover: progress.Progress) -> None:
  for authorised in (False, True):
    got = [reward(mover, HOME_M, REST, authorised) for _ in range(50)]
    assert got == [0.0] * 50
  assert not mover.done
