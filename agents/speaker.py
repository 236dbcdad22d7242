"""Dances frames about a place, by its own clock."""

from collections.abc import Sequence

import numpy as np

from waggle_tasks.protocol import alphabets, reference, schedule


class Speaker:
  """Dances one frame after another, and hovers between them."""

  def __init__(self, alphabet: alphabets.Alphabet, home_m: np.ndarray) -> None:
    """Hovers.

    Args:
      alphabet: What frames are flown with.
      home_m: (3,) where it hovers, in world metres.
    """
    self._alphabet, self._home_m = alphabet, home_m
    self._dance = schedule.Schedule(())

  @property
  def end_s(self) -> float:
    """When it has said all; zero before the first frame."""
    return self._dance.end_s

  def say(self, motions: Sequence[alphabets.Token], begin_s: float) -> None:
    """Begins a frame.

    Args:
      motions: START, its symbols, END.
      begin_s: When the first one begins.
    """
    slots = alphabets.lay_out(self._alphabet, motions, begin_s)
    self._dance = schedule.Schedule(slots)

  def reference(self, time_s: float) -> reference.Reference:
    """Where it is to be at a time; levels go up and down alone."""
    offset, velocity, acceleration = self._dance.motion(time_s)
    up = np.array([0.0, 0.0, 1.0])
    return reference.Reference(
      self._home_m + offset[1] * up, velocity[1] * up, acceleration[1] * up,
      0.0, self._home_m,
    )  # fmt: skip
