"""A message laid out in time, and where the dance is at any moment."""

import dataclasses

import numpy as np

from waggle_tasks.protocol import gestures, minimum_jerk, timing
from waggle_tasks.protocol.symbols import Symbol


@dataclasses.dataclass(frozen=True)
class Slot:
  """One gesture's place in time.

  Attributes:
    gesture: What is flown.
    begin_s: When it begins, in seconds of simulation time.
  """

  gesture: gestures.Gesture
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
    """Where the dance is: minimum jerk from corner to corner.

    Args:
      time_s: Simulation time in seconds.

    Returns:
      Offset from the hover point in m, velocity in m/s and acceleration in
      m/s^2, each (2,): x right and z up in the frontal plane.
    """
    for slot in self.slots:
      if slot.begin_s <= time_s < slot.end_s:
        gesture = slot.gesture
        leg = int((time_s - slot.begin_s) / gesture.leg_s)
        leg = min(leg, len(gesture) - 2)  # Rounding at the very end.
        corners = np.array(gesture.corners_m[leg : leg + 2])
        elapsed_s = time_s - slot.begin_s - leg * gesture.leg_s
        return minimum_jerk.between(*corners, elapsed_s, gesture.leg_s)
    rest = np.zeros(2)
    return rest, rest, rest


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
  slots = []
  begin_s = pauses.initial_hover_s
  for symbol in symbols:
    slots.append(Slot(codebook[symbol], begin_s))
    begin_s = slots[-1].end_s + pauses.pause_s
  return Schedule(tuple(slots))
