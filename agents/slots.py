"""What was seen in each slot of a frame: START, its symbols, and END."""

import dataclasses

import numpy as np

from waggle_tasks.agents import lock as lock_lib
from waggle_tasks.agents import shapes as shapes_lib
from waggle_tasks.agents import wander_chain

START = -1  # The number of its slot; symbols count from 0, and END is last.
# Farther from all that it can fly, it is something else that is seen.
_FAR_M = 0.04
_ASTRAY = 0.2  # Of a slot.
_IDEAL_S = 0.04  # From image to image of a dance that is seen as it should be.


@dataclasses.dataclass(frozen=True, eq=False)
class Pose:
  """How a frame lies in the picture during a slot.

  Attributes:
    home_px: (2,) where the dancer would hover.
    late_s: How much later than by the clock of START.
    scale_px: Pixels of a metre at the dancer.
  """

  home_px: np.ndarray
  late_s: float
  scale_px: float

  def moved(self, by: np.ndarray) -> 'Pose':
    """Another one, by (4,) as in `wander_chain`."""
    home_px = self.home_px + self.scale_px * by[:2]
    scale_px = self.scale_px * (1 + float(by[3]))
    return Pose(home_px, self.late_s + float(by[2]), scale_px)

  def step(self, before: 'Pose') -> np.ndarray:
    """(4,) how far this one is from another, in its metres."""
    home_m = (self.home_px - before.home_px) / self.scale_px
    return np.array([*home_m, self.late_s - before.late_s, 0.0])


@dataclasses.dataclass(frozen=True, eq=False)
class Part:
  """What was seen in a slot.

  Attributes:
    times_s: (T,) since its begin.
    places_m: (T, 2) right and down from where the dancer would hover.
    weights_s: (T,) for how long each stands.
  """

  times_s: np.ndarray
  places_m: np.ndarray
  weights_s: np.ndarray


@dataclasses.dataclass(frozen=True, eq=False)
class Slots:
  """The slots of one frame.

  Attributes:
    samples: Where the target was seen, to the end of the frame.
    shapes: What the alphabet looks like at the dancer's distance.
    begin_s: When START began.
    count: How many symbols there are.
    before_s: How much of the rest before START belongs to it.
    after_s: The same of the rest after END.
  """

  samples: lock_lib.Samples
  shapes: shapes_lib.Shapes
  begin_s: float
  count: int
  before_s: float
  after_s: float

  def starts_s(self, number: int, pose: Pose) -> float:
    """When a slot begins."""
    begin_s = self.begin_s + pose.late_s
    if number == START:
      return begin_s
    return begin_s + self.shapes.start_s + number * self.shapes.slot_s

  def length_s(self, number: int) -> float:
    """How long a slot is."""
    if number == START:
      return self.shapes.start_s
    if number == self.count:
      return self.shapes.end_s + self.after_s
    return self.shapes.slot_s

  def paths(self, number: int) -> tuple[np.ndarray, float]:
    """All that may be flown in a slot, (V, ..., P, 2), and how long it takes.

    By view; in a symbol's slot by state and symbol, in that of END by state.
    """
    shapes = self.shapes
    if number == START:
      return shapes.start, shapes.alphabet.start.duration_s
    if number == self.count:
      return shapes.ends, shapes.end_s
    return shapes.strokes, shapes.stroke_s

  def part(self, number: int, pose: Pose) -> Part:
    """What was seen in a slot, by a pose."""
    begin_s = self.starts_s(number, pose)
    early_s = self.before_s if number == START else 0.0
    seen = self.samples.between(
      begin_s - early_s, begin_s + self.length_s(number)
    )
    places_m = (seen.places_px - pose.home_px) / pose.scale_px
    times_s = seen.times_s - begin_s
    weights_s = seen.weights_s
    if 0 <= number < self.count:
      weights_s = weights_s * self._is_dancer(times_s, places_m)
    return Part(times_s, places_m, weights_s)

  def _is_dancer(self, times_s: np.ndarray, places_m: np.ndarray) -> np.ndarray:
    """(T,) whether the dancer can be there; else it is something else.

    A slot of which much is something else tells nothing. What comes for END is
    all there is to tell it from another symbol, so all of it counts.
    """
    shapes = self.shapes
    paths = shapes_lib.at(shapes.strokes, times_s / shapes.stroke_s)
    squares = ((paths - places_m) ** 2).sum(axis=-1)
    near = squares.min(axis=tuple(range(squares.ndim - 1))) <= _FAR_M**2
    whole = near.mean() >= 1 - _ASTRAY if len(near) else False
    return near & whole

  def costs(self, number: int, part: Part) -> np.ndarray:
    """How far what was seen is from all that may be flown, (V, ...), m^2 s.

    Only where symbols differ, see `shapes.Shapes`.
    """
    paths, stroke_s = self.paths(number)
    off_m = shapes_lib.at(paths, part.times_s / stroke_s) - part.places_m
    return off_m**2 @ self.shapes.tell @ part.weights_s

  def evidence(self, number: int, pose: Pose) -> wander_chain.Evidence:
    """What was seen in a slot tells of its pose, (V, ...)."""
    part = self.part(number, pose)
    return self._evidence(number, part.times_s, part.places_m, part.weights_s)

  def ideal(self, number: int, index: tuple[int, ...]) -> wander_chain.Evidence:
    """The same if all is seen, and flown as one of `paths` by its index."""
    length_s = self.length_s(number)
    images = max(round(length_s / _IDEAL_S), 2)
    times_s = (np.arange(images) + 0.5) * length_s / images
    paths, stroke_s = self.paths(number)
    places_m = shapes_lib.at(paths[index], times_s / stroke_s)
    weights_s = np.full(images, length_s / images)
    return self._evidence(number, times_s, places_m, weights_s)

  def _evidence(
    self,
    number: int,
    times_s: np.ndarray,
    places_m: np.ndarray,
    weights_s: np.ndarray,
  ) -> wander_chain.Evidence:
    paths, stroke_s = self.paths(number)
    shares, step = times_s / stroke_s, 0.25 / (paths.shape[-2] - 1)
    later = shapes_lib.at(paths, shares + step)
    earlier = shapes_lib.at(paths, shares - step)
    return wander_chain.Evidence.of(
      places_m, weights_s, shapes_lib.at(paths, shares),
      (later - earlier) / (2 * step * stroke_s),
    )  # fmt: skip
