"""Rooms with things in them: by seeds, lit by windows, and solid."""

from collections.abc import Callable
import dataclasses

import numpy as np
import pytest

from waggle_tasks import appearance
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import reference

Seen = Callable[[int], np.ndarray]


@pytest.fixture
def seen(load: Callable) -> Seen:
  """What an observer sees of a room at the beginning."""

  def look(seed: int) -> np.ndarray:
    environment = load(
      observers=1, appearance=appearance.Appearance(furniture=seed)
    )
    (begin,) = environment.reset().observation
    return begin['camera'].copy()

  return look


@pytest.mark.slow
def test_a_number_makes_a_room_and_another_one_another(seen: Seen) -> None:
  bare, one, again, other = map(seen, (0, 1, 1, 2))
  np.testing.assert_array_equal(one, again)
  for room in (one, other):
    assert np.count_nonzero((room != bare).any(axis=2)) > 10_000
  assert np.count_nonzero((one != other).any(axis=2)) > 10_000


@pytest.mark.slow
def test_windows_are_as_bright_as_white(seen: Seen) -> None:
  # In the first room they are before the observer; the bare one has none.
  assert np.count_nonzero(seen(1).min(axis=2) > 215) > 1_000
  assert np.count_nonzero(seen(0).min(axis=2) > 215) < 100


def boxes_m(load: Callable, seed: int) -> dict[str, np.ndarray]:
  """Where the boxes of things are that stand in a room."""
  environment = load(
    observers=1, cameras=False,
    appearance=appearance.Appearance(furniture=seed),
  )  # fmt: skip
  environment.reset()
  data, model = environment.physics.data, environment.physics.model
  names = [model.id2name(geom, 'geom') for geom in range(model.ngeom)]
  return {
    name: data.geom_xpos[geom].copy()
    for geom, name in enumerate(names)
    if name.startswith('thing')
  }


@pytest.mark.parametrize('seed', [1, 2])
def test_nothing_stands_where_vehicles_of_the_usual_layouts_fly(
  load: Callable, seed: int
) -> None:
  places = boxes_m(load, seed)
  assert len(places) > 20
  assert min(np.hypot(x_m, y_m) for x_m, y_m, _ in places.values()) > 4.0


@dataclasses.dataclass(frozen=True)
class At:
  """One observer at a place."""

  place_m: tuple[float, float, float]

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    """See the class."""
    return (layouts.Pose(self.place_m, 0.0),) * count


@pytest.mark.slow
def test_who_touches_a_thing_touches_the_room(load: Callable) -> None:
  inside_m = boxes_m(load, 1)['thing_0_0']
  environment = load(
    observers=1, cameras=False, layout=At(tuple(inside_m)),
    appearance=appearance.Appearance(furniture=1),
  )  # fmt: skip
  (begin,) = environment.reset().observation
  hold = reference.Reference.hover(begin['position_m']).to_array()
  environment.step([hold])
  assert ('observer_1', 'room') in environment.task.contacts


@pytest.mark.parametrize('seed', [-1, 2**32, 0.5])
def test_other_numbers_are_refused(seed: float) -> None:
  with pytest.raises(appearance.AppearanceError, match='`furniture` must be'):
    appearance.Appearance(furniture=seed)
