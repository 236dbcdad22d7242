"""Flies an accepted message and says when it is there.

Paper, section 'Per-observer navigation'.
"""

import dataclasses

import numpy as np

from waggle_tasks import errors
from waggle_tasks.agents import elapsed
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import flight, payload, reference


class CommandError(errors.WaggleError):
  """A message that no images stand behind, or a second one."""


@dataclasses.dataclass(frozen=True)
class Command:
  """A message and the images that it was read from.

  Attributes:
    payload: What was read.
    provenance: `image_chain.Chain.digest` of the images; never empty.
  """

  payload: payload.Payload
  provenance: str


class Navigator:
  """Hovers, takes one command, flies it, and holds."""

  def __init__(
    self, agreement: agreement_lib.Agreement = agreement_lib.Agreement()
  ) -> None:
    """Makes a navigator at the beginning of an episode.

    Args:
      agreement: What both sides know.
    """
    self._agreement = agreement
    self._hold_m: np.ndarray | None = None
    self._flight: flight.Flight | None = None
    self._last: tuple[float, np.ndarray] | None = None
    self._there_since_s = np.nan
    self.arrival_s: float | None = None

  @property
  def target_m(self) -> np.ndarray | None:
    """(3,) where the command leads to, or None before one."""
    return None if self._flight is None else self._flight.goal_m

  def accept(
    self, command: Command, position_m: np.ndarray, time_s: float
  ) -> None:
    """Begins to fly a message from where the observer is, equation 2.

    Args:
      command: The message.
      position_m: (3,) the observer's own position.
      time_s: When its final null was confirmed.

    Raises:
      CommandError: if no images stand behind the message, or if one was
        accepted before.
    """
    if not command.provenance:
      raise CommandError(
        '`provenance` must name the images that a message was read from:'
        f' got {command.provenance!r}'
      )
    if self._flight is not None:
      raise CommandError(
        f'`payload` {command.payload.bits} must be the only one in an episode:'
        ' one was accepted before'
      )
    displacement_m = command.payload.displacement_m(self._agreement.units)
    goal_m = flight.goal_m(position_m, displacement_m, self._agreement)
    self._flight = flight.Flight(position_m.copy(), goal_m, time_s)

  def step(self, position_m: np.ndarray, time_s: float) -> reference.Reference:
    """The reference for the middle of the coming control step.

    Args:
      position_m: (3,) the observer's own position.
      time_s: Time of that position.
    """
    if self._hold_m is None:
      self._hold_m = position_m.copy()
    if self._flight is None:
      return reference.Reference.hover(self._hold_m)
    self._watch_arrival(self._flight, position_m, time_s)
    motion = self._flight.motion(time_s + self._agreement.frame_s / 2)
    return reference.Reference(*motion, 0.0, self._flight.goal_m)

  def _watch_arrival(
    self, way: flight.Flight, position_m: np.ndarray, time_s: float
  ) -> None:
    last, self._last = self._last, (time_s, position_m.copy())
    if last is None or self.arrival_s is not None:
      return
    speed_mps = np.linalg.norm(position_m - last[1]) / (time_s - last[0])
    error_m = np.linalg.norm(position_m - way.goal_m)
    if not flight.is_arrived(float(error_m), float(speed_mps)):
      self._there_since_s = np.nan
    elif np.isnan(self._there_since_s):
      self._there_since_s = time_s
    if elapsed.lasted(self._there_since_s, time_s, flight.ARRIVAL_DWELL_S):
      self.arrival_s = time_s
