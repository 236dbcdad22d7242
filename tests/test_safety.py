"""Unsafe flights are refused, and who is refused holds its place."""

from collections.abc import Callable, Sequence
import dataclasses

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import flight, reference
from waggle_tasks.tasks import safety

Load = Callable[..., composer.Environment]
MINIMUM_M = safety.MINIMUM_SPACING_M
HOME_M = np.array([0.0, -1.3, 1.3])


def from_home(x_m: float, y_m: float, z_m: float) -> np.ndarray:  # (3,)
  return HOME_M + np.array([x_m, y_m, z_m])


@dataclasses.dataclass(frozen=True)
class Places:
  """A layout that puts observers on given places."""

  places_m: tuple[tuple[float, float], ...]

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    return tuple(
      layouts.facing_performer(*place) for place in self.places_m[:count]
    )


def along_y(x_m: float, begin_y_m: float, end_y_m: float) -> flight.Flight:
  return flight.Flight(
    np.array([x_m, begin_y_m, 1.3]), np.array([x_m, end_y_m, 1.3]), 10.0
  )


@pytest.mark.parametrize(
  ('aside_m', 'refused'), [(MINIMUM_M - 1e-3, True), (MINIMUM_M + 1e-3, False)]
)
def test_a_way_past_a_resting_vehicle_keeps_its_distance(
  aside_m: float, refused: bool
) -> None:
  other = {'observer_2': np.array([aside_m, -1.0, 1.3])}
  reason = safety.conflict(along_y(0.0, -1.3, -0.7), other, MINIMUM_M)
  expected = 'the way would pass observer_2 at 0.159 m, under 0.160 m'
  assert reason == (expected if refused else None)


def test_parallel_flights_of_one_broadcast_are_safe() -> None:
  others = {'observer_2': along_y(0.2, -1.3, -0.9)}
  # Without its plan the neighbour ahead would be in the way.
  ahead = {'observer_2': along_y(0.0, -1.1, -0.7)}
  stays = {'observer_2': np.array([0.0, -1.1, 1.3])}
  plan = along_y(0.0, -1.3, -0.9)
  assert safety.conflict(plan, others, MINIMUM_M) is None
  assert safety.conflict(plan, ahead, MINIMUM_M) is None
  assert 'observer_2' in safety.conflict(plan, stays, MINIMUM_M)


def test_flights_that_meet_are_not() -> None:
  others = {'observer_2': along_y(0.05, -0.7, -1.3)}
  reason = safety.conflict(along_y(0.0, -1.3, -0.7), others, MINIMUM_M)
  assert reason == 'the way would pass observer_2 at 0.050 m, under 0.160 m'


def test_flights_that_cross_one_after_the_other_are_safe() -> None:
  crossed_before = flight.Flight(
    np.array([-0.5, -1.0, 1.3]), np.array([0.5, -1.0, 1.3]), 5.0
  )
  others = {'observer_2': crossed_before}
  assert safety.conflict(along_y(0.0, -1.3, -0.7), others, MINIMUM_M) is None


def towards(goal_m: np.ndarray, position_m: np.ndarray) -> reference.Reference:
  rest = np.zeros(3)
  return reference.Reference(position_m, rest, rest, 0.0, goal_m)


@pytest.fixture
def gate() -> safety.Gate:
  return safety.Gate('observer_1', reference.Reference.hover(HOME_M))


def test_a_gate_holds_until_a_command_is_accepted(gate: safety.Gate) -> None:
  goal_m = from_home(0, 0.4, 0)
  wanted = towards(goal_m, from_home(0, 0.1, 0))
  np.testing.assert_array_equal(gate.follow(wanted, 1.0).position_m, HOME_M)
  plan = gate.request(wanted, HOME_M, 1.0)
  np.testing.assert_array_equal(plan.goal_m, goal_m)
  gate.judge(plan, None)
  assert gate.follow(wanted, 1.0) is wanted
  assert gate.refusal is None


@pytest.mark.parametrize('offset_m', [0.0, 0.009])
def test_a_hover_is_no_command(gate: safety.Gate, offset_m: float) -> None:
  hover = reference.Reference.hover(from_home(0, offset_m, 0))
  assert gate.request(hover, HOME_M, 1.0) is None


def test_a_command_to_where_it_is_lets_it_go_nowhere_else(
  gate: safety.Gate,
) -> None:
  aside_m = from_home(0, 0.02, 0)  # Where the wind has blown it.
  plan = gate.request(towards(aside_m, aside_m), aside_m, 1.0)
  gate.judge(plan, None)
  gate.follow(towards(aside_m, aside_m), 1.1)
  assert gate.refusal is None
  gate.follow(towards(aside_m, from_home(0, 0.2, 0)), 1.2)
  assert 'from its way' in gate.refusal.reason


def test_a_refused_gate_holds_and_is_not_judged_again(
  gate: safety.Gate,
) -> None:
  wanted = towards(from_home(0, 0.4, 0), from_home(0, 0.1, 0))
  gate.judge(gate.request(wanted, HOME_M, 2.0), 'too near')
  assert gate.refusal == safety.Refusal(2.0, 'observer_1', 'too near')
  assert gate.request(wanted, HOME_M, 2.04) is None
  np.testing.assert_array_equal(gate.follow(wanted, 2.04).position_m, HOME_M)


@pytest.mark.parametrize(
  ('goal_offset_m', 'position_offset_m', 'reason'),
  [
    ((0, 0.4, 0), (0.049, 0.2, 0), None),
    (
      (0, 0.4, 0),
      (0.06, 0.2, 0),
      'the reference is 0.060 m from its way, over 0.050 m',
    ),
    (
      (0, 0.4, 0),
      (0, 0.2, 0.1),
      'the reference is 0.100 m from its way, over 0.050 m',
    ),
    (
      (0, 0.4, 0),
      (0, 0.5, 0),
      'the reference is 0.100 m from its way, over 0.050 m',
    ),
    (
      (0, 0.8, 0),
      (0, 0.2, 0),
      'one command was already accepted in this episode',
    ),
  ],
)
def test_a_reference_stays_on_its_accepted_way(
  gate: safety.Gate,
  goal_offset_m: tuple[float, ...],
  position_offset_m: tuple[float, ...],
  reason: str | None,
) -> None:
  first = towards(from_home(0, 0.4, 0), from_home(0, 0.1, 0))
  gate.judge(gate.request(first, HOME_M, 1.0), None)
  gate.follow(first, 1.0)
  wanted = towards(from_home(*goal_offset_m), from_home(*position_offset_m))
  followed = gate.follow(wanted, 1.04)
  if reason is None:
    assert gate.refusal is None
    assert followed is wanted
  else:
    assert gate.refusal == safety.Refusal(1.04, 'observer_1', reason)
    np.testing.assert_array_equal(followed.position_m, first.position_m)
    np.testing.assert_array_equal(followed.velocity_mps, 0)
    # Coming back to the way does not undo it.
    again = gate.follow(first, 1.08)
    np.testing.assert_array_equal(again.velocity_mps, 0)
    assert again is not first


def fly(
  environment: composer.Environment,
  offsets_m: Sequence[tuple[float, float, float] | None],
  steps: int,
) -> list[np.ndarray]:
  """Every observer flies its offset at once; returns how far each came."""
  begins_m = [o['position_m'] for o in environment.reset().observation]
  flights = [
    flight.Flight(begin_m, begin_m + (offset or (0, 0, 0)), 0.0)
    for begin_m, offset in zip(begins_m, offsets_m, strict=True)
  ]
  for step in range(steps):
    action = [
      reference.Reference(
        *each.motion((step + 0.5) * 0.04), 0.0, each.goal_m
      ).to_array()
      for each in flights
    ]
    timestep = environment.step(action)
    assert timestep.discount == 1
  return [
    each['position_m'] - begin_m
    for each, begin_m in zip(timestep.observation, begins_m, strict=True)
  ]


LINE = [
  Places(((0, -1.0), (0, -1.25), (0, -1.5))),
  Places(((-0.2, -1.3), (0, -1.3), (0.2, -1.3))),
]


@pytest.mark.parametrize('layout', LINE, ids=['behind', 'beside'])
def test_all_fly_one_message_at_once(
  layout: layouts.Layout, load: Load
) -> None:
  environment = load('broadcast', cameras=False, layout=layout)
  moved_m = fly(environment, [(0, 0.4, 0)] * 3, 80)
  np.testing.assert_allclose(moved_m, [(0, 0.4, 0)] * 3, atol=1e-3)
  assert environment.task.refusals == ()


def test_neighbours_whose_nulls_are_a_few_frames_apart_all_fly(
  load: Load,
) -> None:
  """As five at the default geometry are, when a message leads sideways."""
  layout = Places(((-0.34, -1.3), (0.0, -1.3)))
  environment = load('broadcast', cameras=False, observers=2, layout=layout)
  begins_m = [o['position_m'] for o in environment.reset().observation]
  way_m = np.array([-0.4, 0.0, 0.0])
  flights = [
    flight.Flight(begin_m, begin_m + way_m, begin_s)
    for begin_m, begin_s in zip(begins_m, (0.12, 0.0), strict=True)
  ]
  for step in range(90):
    time_s = step * 0.04
    action = [
      reference.Reference.hover(each.begin_m).to_array()
      if time_s < each.begin_s - 1e-6
      else reference.Reference(
        *each.motion(time_s + 0.02), 0.0, each.goal_m
      ).to_array()
      for each in flights
    ]
    timestep = environment.step(action)
    assert timestep.discount == 1
  assert environment.task.refusals == ()
  for each, begin_m in zip(timestep.observation, begins_m, strict=True):
    np.testing.assert_allclose(each['position_m'] - begin_m, way_m, atol=1e-3)


def test_who_would_hit_one_that_stays_is_refused_and_holds(load: Load) -> None:
  environment = load('broadcast', cameras=False, layout=LINE[0])
  offsets_m = [None, (0, 0.4, 0), (0, -0.4, 0)]
  moved_m = fly(environment, offsets_m, 80)
  np.testing.assert_allclose(moved_m[:2], np.zeros((2, 3)), atol=1e-4)
  np.testing.assert_allclose(moved_m[2], (0, -0.4, 0), atol=1e-3)
  (refusal,) = environment.task.refusals
  assert (refusal.vehicle, refusal.time_s) == ('observer_2', 0.0)
  assert refusal.reason.startswith('the way would pass observer_1 at 0.')


def test_the_performer_is_kept_clear_of_too(load: Load) -> None:
  environment = load('broadcast', cameras=False, observers=1)
  (moved_m,) = fly(environment, [(0, 1.3, 0)], 80)
  np.testing.assert_allclose(moved_m, np.zeros(3), atol=1e-4)
  (refusal,) = environment.task.refusals
  assert 'the way would pass performer at 0.' in refusal.reason


@pytest.mark.parametrize(('language', 'refused'), [('swift', 1), ('paper', 0)])
def test_a_place_where_a_dance_will_be_is_not_free(
  load: Load, language: str, refused: int
) -> None:
  """START leads above the hover point, in the paper only after the flight."""
  environment = load(
    'broadcast', cameras=False, observers=1, language=language,
    layout=Places(((0, -0.6),)),
  )  # fmt: skip
  fly(environment, [(0, 0.6, 0.3)], 60)
  refusals = environment.task.refusals
  assert len(refusals) == refused
  assert all('would pass performer' in each.reason for each in refusals)


def test_who_counts_on_one_that_is_refused_is_refused_too(load: Load) -> None:
  """The first would hit the performer and stays, in the way of the others."""
  layout = Places(((0, -0.5), (0, -0.8), (0, -1.1)))
  environment = load('broadcast', cameras=False, layout=layout)
  moved_m = fly(environment, [(0, 0.4, 0)] * 3, 90)
  np.testing.assert_allclose(moved_m, np.zeros((3, 3)), atol=1e-4)
  refused = [each.vehicle for each in environment.task.refusals]
  assert refused == ['observer_1', 'observer_2', 'observer_3']


def test_two_that_would_meet_are_both_refused(load: Load) -> None:
  layout = Places(((-0.3, -1.3), (0.3, -1.3)))
  environment = load('broadcast', cameras=False, observers=2, layout=layout)
  moved_m = fly(environment, [(0.6, 0, 0), (-0.6, 0, 0)], 20)
  np.testing.assert_allclose(moved_m, np.zeros((2, 3)), atol=1e-4)
  assert len(environment.task.refusals) == 2


def test_a_second_command_is_refused_and_a_reset_forgets_it(load: Load) -> None:
  environment = load('broadcast', cameras=False, observers=1)
  for _ in range(2):
    fly(environment, [(0, 0.2, 0)], 80)
    assert environment.task.refusals == ()
    place_m = environment.task.positions_m(environment.physics)['observer_1']
    way_m = np.array([0, 0.2, 0])
    again = towards(place_m + way_m, place_m + way_m / 2).to_array()
    for _ in range(30):
      environment.step([again])
    (refusal,) = environment.task.refusals
    reason = 'one command was already accepted in this episode'
    assert refusal.reason == reason
    now_m = environment.task.positions_m(environment.physics)['observer_1']
    np.testing.assert_allclose(now_m, place_m, atol=1e-3)


def test_who_leaves_its_way_stops_and_holds(load: Load) -> None:
  environment = load('broadcast', cameras=False, observers=1)
  fly(environment, [(0, 0.4, 0)], 40)
  goal_m = from_home(0, 0.4, 0)
  astray = towards(goal_m, from_home(0.3, 0.2, 0)).to_array()
  for _ in range(50):
    environment.step([astray])
  (refusal,) = environment.task.refusals
  assert 'm from its way, over 0.050 m' in refusal.reason
  position_m = environment.task.positions_m(environment.physics)['observer_1']
  velocity = environment.task.fleet.velocities_mps(environment.physics)[
    'observer_1'
  ]
  assert abs(position_m[0]) < 0.01
  assert np.linalg.norm(velocity) < 1e-3
