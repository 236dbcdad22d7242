"""Where layouts place vehicles, and which placements they refuse."""

from collections.abc import Callable
import dataclasses
import itertools
import math
import subprocess
import sys

import numpy as np
import pytest

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import crazyflie

DEG = math.pi / 180


@dataclasses.dataclass(frozen=True)
class Ring:
  """Observers all around the performer: a layout of a user's own."""

  radius_m: float = 1.3

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    return tuple(
      layouts.facing_performer(
        self.radius_m * math.sin(angle), -self.radius_m * math.cos(angle)
      )
      for angle in 2 * math.pi * np.arange(count) / count
    )


def positions_m(poses: tuple[layouts.Pose, ...]) -> np.ndarray:  # (N, 3)
  return np.array([pose.position_m for pose in poses])


# The bearings follow from the count and the half-span of the paper's table.
@pytest.mark.parametrize(
  ('count', 'radius_m', 'half_span_deg', 'bearings_deg'),
  [
    (1, 1.3, 30, [0]),
    (2, 1.3, 30, [-30, 30]),
    (3, 1.3, 30, [-30, 0, 30]),
    (4, 1.3, 35, [-35, -35 / 3, 35 / 3, 35]),
    (5, 1.3, 40, [-40, -20, 0, 20, 40]),
    (3, 1.0, 30, [-30, 0, 30]),
    (3, 1.6, 30, [-30, 0, 30]),
    (3, 1.3, 15, [-15, 0, 15]),
    (3, 1.3, 45, [-45, 0, 45]),
  ],
)
def test_an_arc_stands_at_its_radius_from_minus_to_plus_half_span(
  count: int, radius_m: float, half_span_deg: float, bearings_deg: list[float]
) -> None:
  poses = layouts.Arc(radius_m, half_span_deg * DEG).poses(count)
  bearings = np.array(bearings_deg) * DEG
  expected = np.stack(
    [
      radius_m * np.sin(bearings),
      -radius_m * np.cos(bearings),
      np.full(count, 1.3),
    ],
    axis=1,
  )
  np.testing.assert_allclose(positions_m(poses), expected, atol=1e-12)


@pytest.mark.parametrize('count', [1, 2, 3, 4, 5])
@pytest.mark.parametrize('bearing_deg', [-180, -85, 15, 85, 180])
def test_a_bearing_turns_an_arc_about_the_performer(
  count: int, bearing_deg: float
) -> None:
  straight = layouts.Arc(1.3, 30 * DEG).poses(count)
  turned = layouts.Arc(1.3, 30 * DEG, bearing_deg * DEG).poses(count)
  x, y, z = positions_m(straight).T
  cos, sin = math.cos(bearing_deg * DEG), math.sin(bearing_deg * DEG)
  expected = np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=1)
  np.testing.assert_allclose(positions_m(turned), expected, atol=1e-12)
  for pose, (px, py, _) in zip(turned, expected, strict=True):
    facing = (math.cos(pose.yaw_rad), math.sin(pose.yaw_rad))
    assert facing == pytest.approx((-px / 1.3, -py / 1.3))


def test_one_observer_stands_at_the_bearing() -> None:
  (pose,) = layouts.Arc(2.0, 30 * DEG, 75 * DEG).poses(1)
  x_m, y_m, _ = pose.position_m
  assert math.degrees(math.atan2(x_m, -y_m)) == pytest.approx(75)
  assert math.hypot(x_m, y_m) == pytest.approx(2.0)


# Written before arcs could be turned; half a unit of the last place moves them.
@pytest.mark.parametrize('count', [1, 2, 3, 4, 5, 12])
@pytest.mark.parametrize('half_span_deg', [15.0, 30.0, 40.0, 45.0])
def test_an_arc_that_is_not_turned_is_what_it_was_to_the_last_bit(
  count: int, half_span_deg: float
) -> None:
  half_span_rad = math.radians(half_span_deg)
  poses = layouts.Arc(1.3, half_span_rad, 0.0).poses(count)
  assert poses == tuple(
    layouts.facing_performer(1.3 * math.sin(angle), -1.3 * math.cos(angle))
    for angle in half_span_rad * layouts.spread(count)
  )


def test_the_default_arc_is_the_papers() -> None:
  assert layouts.Arc() == layouts.Arc(1.3, 30 * DEG)


@pytest.mark.parametrize(
  ('count', 'x_m'),
  [
    (1, [0]),
    (2, [-0.3, 0.3]),
    (3, [-0.6, 0, 0.6]),
    (4, [-0.9, -0.3, 0.3, 0.9]),
  ],
)
def test_a_line_lies_at_its_separation_and_is_centred(
  count: int, x_m: list[float]
) -> None:
  got = positions_m(layouts.Line(1.3, 0.6).poses(count))
  expected = [(x, -1.3, 1.3) for x in x_m]
  np.testing.assert_allclose(got, expected, atol=1e-12)


@pytest.mark.parametrize(
  'layout', [layouts.Arc(2.0, 90 * DEG), layouts.Line(1.0, 0.6), Ring()]
)
@pytest.mark.parametrize('count', [1, 3, 20])
def test_every_observer_looks_at_the_performance_area(
  layout: layouts.Layout, count: int
) -> None:
  poses = layout.poses(count)
  assert len(poses) == count
  for pose in poses:
    x, y, z = pose.position_m
    ahead = np.array([math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)])
    np.testing.assert_allclose(
      ahead, (-x / math.hypot(x, y), -y / math.hypot(x, y)), atol=1e-12
    )
    assert z == 1.3


def test_a_single_observer_is_straight_in_front_whatever_the_spread() -> None:
  front = layouts.Arc(1.3, 5 * DEG).poses(1)
  assert front == layouts.Arc(1.3, math.pi).poses(1)
  assert front == layouts.Line(1.3, 2.0).poses(1)
  np.testing.assert_allclose(front[0].position_m, (0, -1.3, 1.3))
  assert front[0].yaw_rad == pytest.approx(90 * DEG)


def test_the_performer_hovers_at_the_middle_and_faces_the_front() -> None:
  pose = layouts.performer_pose()
  assert pose.position_m == (0, 0, 1.3)
  assert pose.yaw_rad == pytest.approx(-90 * DEG)


def test_jitter_moves_x_and_y_within_its_bound_and_nothing_else() -> None:
  before = layouts.Arc(3.0, 120 * DEG).poses(200)
  after = layouts.jittered(before, 0.01, np.random.RandomState(0))
  offsets_m = positions_m(after) - positions_m(before)
  assert np.abs(offsets_m).max() <= 0.01
  # 400 uniform draws nearly fill their range, on both sides and both axes.
  assert (offsets_m[:, :2].min(0) < -0.0095).all()
  assert (offsets_m[:, :2].max(0) > 0.0095).all()
  assert abs(np.corrcoef(offsets_m[:, 0], offsets_m[:, 1])[0, 1]) < 0.2
  np.testing.assert_array_equal(offsets_m[:, 2], 0)
  assert [a.yaw_rad for a in after] == [b.yaw_rad for b in before]


def test_jitter_follows_from_its_seed() -> None:
  poses = layouts.Arc().poses(5)
  first, again, other = (
    layouts.jittered(poses, 0.01, np.random.RandomState(seed))
    for seed in (0, 0, 1)
  )
  assert first == again
  assert first != other


def test_no_jitter_leaves_poses_as_they_are() -> None:
  poses = layouts.Line().poses(3)
  assert layouts.jittered(poses, 0.0, np.random.RandomState(0)) == poses


@pytest.mark.parametrize(
  ('make', 'error'),
  [
    (lambda: layouts.Arc(-1.3), '`radius_m` must be between 0.001 and 100'),
    (lambda: layouts.Arc(0.0), '`radius_m` must be between'),
    (lambda: layouts.Arc(1e9), '`radius_m` must be between'),
    (lambda: layouts.Arc(math.nan), '`radius_m` must be a finite number: '),
    (lambda: layouts.Arc('1.3'), "`radius_m` must be a finite .* got '1.3'"),
    (lambda: layouts.Arc(1.3, -0.1), r'between 0 and 3.14159: got -0.1'),
    (lambda: layouts.Arc(1.3, 3.15), r'between 0 and 3.14159: got 3.15'),
    (lambda: layouts.Arc(1.3, math.nan), '`half_span_rad` must be a finite'),
    (lambda: layouts.Arc(1.3, 0.5, 3.2), '`bearing_rad` must be between'),
    (lambda: layouts.Arc(1.3, 0.5, math.nan), '`bearing_rad` must be a finite'),
    (lambda: layouts.Line(math.inf), '`separation_m` must be a finite number'),
    (lambda: layouts.Line(1.3, 0.0), '`spacing_m` must be between'),
    (lambda: layouts.Arc().poses(0), '`count` must be between 1 and .* got 0'),
    (lambda: layouts.Line().poses(2.0), '`count` must be an integer: got 2.0'),
    (
      lambda: layouts.Pose((0, math.nan, 1), 0),
      r'`position_m` must be 3 finite numbers: got \(0.0, nan, 1.0\)',
    ),
    (lambda: layouts.Pose((0, 1), 0), '`position_m` must be 3 finite'),
    (lambda: layouts.Pose((0, 0, 1), math.inf), '`yaw_rad` must be a finite'),
    (
      lambda: layouts.jittered((), -0.01, np.random.RandomState(0)),
      '`bound_m` must be between 0 and 100: got -0.01',
    ),
    (
      lambda: layouts.jittered((), math.nan, np.random.RandomState(0)),
      '`bound_m` must be a finite number: got nan',
    ),
  ],
)
def test_values_that_make_no_sense_are_refused(
  make: Callable[[], object], error: str
) -> None:
  with pytest.raises(layouts.LayoutError, match=error):
    make()


def named(poses: tuple[layouts.Pose, ...]) -> dict[str, layouts.Pose]:
  observers = {f'observer_{i}': pose for i, pose in enumerate(poses, 1)}
  return {'performer': layouts.performer_pose(), **observers}


@pytest.mark.parametrize(
  ('poses', 'error'),
  [
    (
      layouts.Arc(1.3, math.pi).poses(3),
      'observer_1 and observer_3 must start at least 0.160 m apart:'
      ' got 0.000 m',
    ),
    (
      layouts.Line(1.3, 0.1).poses(2),
      'observer_1 and observer_2 must start at least 0.160 m apart:'
      ' got 0.100 m',
    ),
    (
      layouts.Arc(0.15).poses(1),
      'performer and observer_1 must start at least 0.160 m apart: got 0.150 m',
    ),
  ],
)
def test_vehicles_that_overlap_are_named(
  poses: tuple[layouts.Pose, ...], error: str
) -> None:
  with pytest.raises(layouts.LayoutError) as caught:
    layouts.check_spacing(named(poses), 0.16)
  assert str(caught.value) == error


@pytest.mark.parametrize(
  'layout',
  [
    layouts.Arc(),
    layouts.Arc(1.0),
    layouts.Arc(1.3, 15 * DEG),
    layouts.Line(),
    layouts.Line(1.0),
  ],
)
@pytest.mark.parametrize('count', [1, 2, 3, 4, 5])
def test_the_papers_layouts_keep_vehicles_apart(
  layout: layouts.Layout, count: int
) -> None:
  placed = named(layout.poses(count))
  layouts.check_spacing(placed, 0.16)
  nearest_m = min(
    math.dist(a.position_m, b.position_m)
    for a, b in itertools.combinations(placed.values(), 2)
  )
  layouts.check_spacing(placed, nearest_m)
  with pytest.raises(layouts.LayoutError):
    layouts.check_spacing(placed, nearest_m + 1e-9)


def test_a_layout_of_ones_own_fills_a_room() -> None:
  room = flight_room.FlightRoom()
  placed = named(Ring(1.5).poses(8))
  layouts.check_spacing(placed, 0.16)
  for name, pose in placed.items():
    room.add_vehicle(crazyflie.Crazyflie(name), pose)
  names = [e.mjcf_model.model for e in room.iter_entities(exclude_self=True)]
  assert names == ['performer', *(f'observer_{i}' for i in range(1, 9))]


def test_layouts_need_no_simulator() -> None:
  code = (
    'import sys; from waggle_tasks.arenas import layouts;'
    " sys.exit('dm_control' in sys.modules or 'mujoco' in sys.modules)"
  )
  assert subprocess.run([sys.executable, '-c', code]).returncode == 0
