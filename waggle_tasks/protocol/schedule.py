"""A message laid out in time, and where the dance is at any moment."""

from collections.abc import Iterable
import dataclasses
import math
from typing import Protocol

import numpy as np

from waggle_tasks.protocol import gestures, timing
from waggle_tasks.protocol.symbols import Symbol


class Path(Protocol):
  """A smooth way from rest to rest: a gesture, or any other flight.

  Attributes:
    symbol: The symbol it stands for; UNKNOWN when it is none.
    duration_s: How long it takes.
    end_m: Where it comes to rest: the offset from the hover point, (2,) or
      (3,) as in `motion`.
  """

  @property
  def symbol(self) -> Symbol:
    """See above."""
    ...

  @property
  def duration_s(self) -> float:
    """See above."""
    ...

  @property
  def end_m(self) -> np.ndarray:
    """See above."""
    ...

  def motion(
    self, elapsed_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offset in m, velocity and acceleration, `elapsed_s` after its begin.

    Each is (2,), x right and z up in the frontal plane, or (3,) with the way
    out of the plane, away from the audience.
    """
    ...


def axes(yaw_rad: float) -> np.ndarray:  # (3, 3)
  """World axes of a dance, as rows: right, up, and away from the audience.

  Args:
    yaw_rad: The performer's heading: it faces its audience, so that their
      right is its left.
  """
  right = [-math.sin(yaw_rad), math.cos(yaw_rad), 0.0]
  away = [-math.cos(yaw_rad), -math.sin(yaw_rad), 0.0]
  return np.array([right, [0.0, 0.0, 1.0], away])


@dataclasses.dataclass(frozen=True)
class Slot:
  """One gesture's place in time.

  Attributes:
    gesture: What is flown; any smooth path will do.
    begin_s: When it begins, in seconds of simulation time.
  """

  gesture: Path
  begin_s: float

  @property
  def end_s(self) -> float:
    """When it ends, in seconds of simulation time."""
    return self.begin_s + self.gesture.duration_s


@dataclasses.dataclass(frozen=True)
class Schedule:
  """A sequence of gestures with its pauses.

  Attributes:
    slots: The gestures in time order; none for a performer that only hovers.
  """

  slots: tuple[Slot, ...]

  @property
  def end_s(self) -> float:
    """When the last gesture ends; zero without gestures."""
    return self.slots[-1].end_s if self.slots else 0.0

  def symbol_at(self, time_s: float) -> Symbol:
    """The symbol being flown, NULL while hovering."""
    for slot in self.slots:
      if slot.begin_s <= time_s < slot.end_s:
        return slot.gesture.symbol
    return Symbol.NULL

  def motion(self, time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where the dance is.

    Args:
      time_s: Simulation time in seconds.

    Returns:
      Offset from the hover point in m, velocity in m/s and acceleration in
      m/s^2, each of the shape of the path under way: see `Path.motion`.
      Between two paths it rests where the last one ended.
    """
    place = np.zeros(2)
    for slot in self.slots:
      if time_s < slot.begin_s:
        break
      if time_s < slot.end_s:
        return slot.gesture.motion(time_s - slot.begin_s)
      place = slot.gesture.end_m
    return place, np.zeros(len(place)), np.zeros(len(place))


def broadcast(
  symbols: tuple[Symbol, ...],
  codebook: gestures.Codebook,
  pauses: timing.Timing,
) -> Schedule:
  """Lays motion symbols out in time.

  Args:
    symbols: Motion symbols, in the order in which they are flown.
    codebook: The agreed gestures.
    pauses: The agreed pauses.

  Returns:
    The schedule; hovering follows its last slot.
  """
  return lay_out([codebook[symbol] for symbol in symbols], pauses)


def lay_out(paths: Iterable[Path], pauses: timing.Timing) -> Schedule:
  """Lays paths out in time, one after another, with the agreed pauses."""
  slots: list[Slot] = []
  begin_s = pauses.initial_hover_s
  for path in paths:
    slots.append(Slot(path, begin_s))
    begin_s = slots[-1].end_s + pauses.pause_s
  return Schedule(tuple(slots))
