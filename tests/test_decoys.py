"""Performances that are no message: other motions, and frames that are none."""

from collections.abc import Callable, Sequence
import itertools
import math

import numpy as np
import pytest

from waggle_tasks import registry, scenario, suites
from waggle_tasks.entities import performer
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.experiments.record import moves
from waggle_tasks.protocol import (
  agreement,
  clock,
  decoy_figures,
  decoys,
  frame,
  gestures,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import safety

AGREED = agreement.Agreement()

FIGURES = ('circles', 'diagonals', 'random_walk', 'navigation')
FRAMES = (
  'swapped', 'repeated', 'half_frame', 'five_bits', 'seven_bits', 'begun_anew',
  'run_together', 'start_repeated', 'end_first',
)  # fmt: skip
# With these parts hidden, a frame is left.
HIDDEN = {'seven_bits': 1, 'begun_anew': 1, 'run_together': 2}
SEEDS = range(12)


def dance(name: str, seed: int = 0) -> schedule.Schedule:
  return scenario.Scenario(control=name, seed=seed).performance.schedule


def sampled(
  plan: schedule.Schedule, step_s: float = 0.01
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
  """Offset, velocity and acceleration, (T, 3) each, at even times."""
  times_s = np.arange(0, plan.end_s + 1, step_s)
  moments = np.zeros((3, len(times_s), 3))
  for index, time_s in enumerate(times_s):
    for column, each in zip(moments, plan.motion(time_s), strict=True):
      column[index, : len(each)] = each
  return tuple(moments)


def test_all_decoys_are_tested() -> None:
  assert (*FIGURES, *FRAMES) == decoys.DECOYS


@pytest.mark.parametrize('name', decoys.DECOYS)
def test_a_decoy_lasts_about_as_long_as_a_message(name: str) -> None:
  for seed in SEEDS:
    assert dance(name, seed).end_s == pytest.approx(85, abs=30)


@pytest.mark.parametrize('name', decoys.DECOYS)
def test_each_seed_is_another_performance(name: str) -> None:
  def look(seed: int) -> bytes:
    return sampled(dance(name, seed), 0.5)[0].tobytes()

  assert look(3) == look(3)
  assert len({look(seed) for seed in SEEDS}) >= 6


@pytest.mark.parametrize(
  'name',
  [
    'random_walk',
    *(
      pytest.param(name, marks=pytest.mark.long)
      for name in FIGURES
      if name != 'random_walk'
    ),
  ],
)
def test_figures_are_smooth_and_can_be_flown(name: str) -> None:
  """Velocity and acceleration are slopes, within the vehicle's limits."""
  for seed in SEEDS[:4]:
    plan = dance(name, seed)
    place, velocity, acceleration = sampled(plan)
    np.testing.assert_allclose(
      np.gradient(place, 0.01, axis=0)[1:-1], velocity[1:-1], atol=0.012
    )
    np.testing.assert_allclose(
      np.gradient(velocity, 0.01, axis=0)[1:-1], acceleration[1:-1], atol=0.4
    )
    assert np.linalg.norm(velocity, axis=1).max() < 1.0
    assert np.abs(acceleration).max() < 3.0


@pytest.mark.slow
@pytest.mark.parametrize('name', decoys.DECOYS)
def test_decoys_stay_in_the_air_and_away_from_the_audience(name: str) -> None:
  """Observers may stand 0.6 m away in any direction."""
  for seed in SEEDS:
    place, _, _ = sampled(dance(name, seed), 0.05)
    right, up, away = place.T
    assert np.abs(right).max() <= 0.31
    assert up.min() >= -0.31
    assert up.max() <= 0.63
    assert away.min() >= -1e-9
    assert np.hypot(right, away).max() <= 0.6 - safety.MINIMUM_SPACING_M


@pytest.mark.parametrize('name', FIGURES)
def test_figures_are_of_the_size_of_gestures(name: str) -> None:
  spans_m = []
  for slot in dance(name).slots:
    times_s = np.linspace(0, slot.gesture.duration_s, 200)
    path = np.stack([slot.gesture.motion(t)[0] for t in times_s])
    spans_m.append(np.linalg.norm(np.ptp(path, axis=0)))
    assert slot.gesture.symbol is Symbol.UNKNOWN
    assert 3.0 <= slot.gesture.duration_s <= 9.0
  assert min(spans_m) > 0.15
  assert max(spans_m) < 0.9


def test_a_navigation_flight_rests_where_it_came_to() -> None:
  plan = dance('navigation')
  ends = [slot.gesture.end_m for slot in plan.slots]
  assert len({tuple(end) for end in ends}) == len(ends)
  for slot, following in itertools.pairwise(plan.slots):
    for time_s in (slot.end_s, following.begin_s - 0.01):
      place, velocity, _ = plan.motion(time_s)
      np.testing.assert_array_equal(place, slot.gesture.end_m)
      np.testing.assert_array_equal(velocity, 0)
  depths_m = [end[2] for end in ends]
  assert np.ptp(depths_m) > 0.1


def test_the_way_out_of_the_plane_leads_away_from_the_audience() -> None:
  dancer = performer.Performer()
  figure = decoy_figures.Figure(np.array([(0, 0, 0), (0.1, 0.2, 0.3)]), 3.0)
  dancer.perform(schedule.Schedule((schedule.Slot(figure, 0.0),)))
  place, velocity, _ = dancer.motion(np.zeros(3), -math.pi / 2, 5.0)
  np.testing.assert_allclose(place, (0.1, 0.3, 0.2), atol=1e-12)
  np.testing.assert_array_equal(velocity, 0)


@pytest.mark.parametrize('name', FRAMES)
def test_read_without_a_fault_a_broken_frame_is_no_message(name: str) -> None:
  for seed in range(60):
    parser = frame.Parser()
    parser, _ = parser.step(Symbol.NULL)
    for slot in dance(name, seed).slots:
      for symbol in (slot.gesture.symbol, Symbol.NULL):
        parser, outcome = parser.step(symbol)
        assert not isinstance(outcome, frame.Message)


def test_broken_frames_are_those_that_their_names_say() -> None:
  def symbols(name: str, seed: int) -> list[str]:
    return [str(slot.gesture.symbol) for slot in dance(name, seed).slots]

  for seed in SEEDS:
    swapped = symbols('swapped', seed)
    assert len(swapped) == 8
    assert {'START', 'END'} <= {*swapped}
    half = symbols('half_frame', seed)
    assert half[0] == half[4] == 'START'
    assert 'END' not in half
  repeated = [symbols('repeated', seed) for seed in range(20)]
  assert {len(each) for each in repeated} == {8, 9}
  for each in repeated:
    assert any(a == b for a, b in itertools.pairwise(each))


@pytest.mark.parametrize('name', HIDDEN)
def test_with_a_part_hidden_order_alone_makes_a_message_and_time_none(
  name: str,
) -> None:
  agreed = scenario.Scenario().agreement.clock
  for seed in range(20):
    slots, found = dance(name, seed).slots, 0
    for first in range(1, len(slots) - 1):
      left = slots[:first] + slots[first + HIDDEN[name] :]
      found += _message(frame.Parser(), left) is not None
      assert _message(frame.Parser(clock=agreed), left) is None
    assert found


def _message(
  parser: frame.Parser, slots: Sequence[schedule.Slot]
) -> frame.Message | None:
  """What a parser makes of motions that are seen at their times."""
  out = None
  parser, _ = parser.step(Symbol.NULL, clock.Moment(0.0, slots[0].begin_s))
  for slot in slots:
    moment = clock.Moment(slot.begin_s, slot.end_s)
    parser, _ = parser.step(slot.gesture.symbol, moment)
    rest = clock.Moment(slot.end_s, slot.end_s + 3.0)
    parser, outcome = parser.step(Symbol.NULL, rest)
    out = outcome if isinstance(outcome, frame.Message) else out
  return out


@pytest.mark.parametrize('name', decoys.DECOYS)
def test_nothing_is_to_be_decoded_and_nobody_may_move(name: str) -> None:
  scene = registry.find(name)
  assert evaluator.expected_bits(scene, 1) is None
  frames = 50
  moved_m = np.zeros((frames, 3))
  moved_m[30:, 1] = 0.4
  flown = rollout.Rollout(
    np.arange(frames) * AGREED.frame_s,
    {f'observer_{k}': moved_m * (k == 2) for k in (1, 2, 3)},
    (),
    {f'observer_{k}': () for k in (1, 2, 3)},
    '',
  )
  verdict = evaluator.evaluate(scene, flown)
  assert [bool(each.failures) for each in verdict.outcomes] == [0, 1, 0]
  assert 'premature motion' in verdict.outcomes[1].failures[0]


def test_a_suite_may_hold_decoys() -> None:
  rows = [{'name': name, 'task': name, 'seed': 4} for name in decoys.DECOYS]
  cases = suites.from_rows(rows)
  assert [case.scene.control for case in cases] == [*decoys.DECOYS]
  assert cases[0].scene.performance.schedule.end_s == dance('circles', 4).end_s


def test_the_timeline_shows_a_figure_as_no_symbol() -> None:
  scene = scenario.Scenario(control='circles')
  sent = moves.sent(scene.performance, scene.agreement, scene.episode_s)
  assert {each.symbol for each in sent} == {Symbol.UNKNOWN}
  assert len(sent) == 7


def test_a_decoy_is_flown_and_earns_nothing(
  load: Callable, episode: Callable, flyer: Callable
) -> None:
  pauses = timing.Timing(0.4, 0.1, 0.2, 0.1)
  environment = load('navigation', cameras=False, observers=1, pauses=pauses)
  task, rewards, worst_m = environment.task, [], 0.0
  assert not task.sends_message
  home_m = None
  for timestep in episode(environment, flyer((0.0, 0.4, 0.0), 1e9)):
    place_m = task.positions_m(environment.physics)['performer']
    home_m = place_m if home_m is None else home_m
    offset = task.performer.schedule.motion(environment.physics.time())[0]
    wanted_m = home_m + np.pad(offset, (0, 3 - len(offset)))[[0, 2, 1]]
    worst_m = max(worst_m, np.abs(place_m - wanted_m).max())
    rewards.append(timestep.reward[0] if timestep.reward else 0.0)
    if environment.physics.time() > 20:
      break
  assert worst_m < 0.02
  assert not any(rewards)


def test_a_gesture_is_flown_as_before() -> None:
  """From corner to corner; and it rests at the hover point after it."""
  gesture = gestures.v_codebook()[Symbol.ZERO]
  plan = schedule.Schedule((schedule.Slot(gesture, 1.0),))
  for leg, corner in enumerate(gesture.corners_m[:-1]):
    place, velocity, _ = plan.motion(1.0 + leg * gesture.leg_s)
    np.testing.assert_allclose(place, corner, atol=1e-9)
    np.testing.assert_allclose(velocity, 0, atol=1e-9)
  np.testing.assert_array_equal(plan.motion(1.0 + gesture.duration_s)[0], 0)
