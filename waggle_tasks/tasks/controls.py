"""Controls: episodes in which a message must not be read, or not by all.

Paper, section 'Controls and supplemental suite'.
"""

import dataclasses

from waggle_tasks import sensor
from waggle_tasks.protocol import schedule
from waggle_tasks.tasks import broadcast
from waggle_tasks.tasks import parts as parts_lib


class NoSend(broadcast.Broadcast):
  """Nobody dances: all vehicles stay where they are."""

  def _begin_dance(self) -> None:
    self.performer.perform(schedule.Schedule(()))


class Decoy(broadcast.Broadcast):
  """The performer flies, and it is no message."""

  @property
  def sends_message(self) -> bool:
    """Never."""
    return False


class BlackInput(broadcast.Broadcast):
  """One observer's camera delivers only black images."""

  def __init__(self, parts: parts_lib.Parts, number: int = 2) -> None:
    """Makes the task.

    Args:
      parts: What it is made of.
      number: Which observer sees nothing, counted from 1.
    """
    super().__init__(parts)
    blind = self.observers[number - 1]
    blind.sensor = dataclasses.replace(
      blind.sensor,
      blackout_s=0.0,
      blackout_length_s=sensor.ALWAYS_S,
      blackout_share=1.0,
    )


class Interrupted(broadcast.Broadcast):
  """The dance is cut short, and the performer hovers."""

  def __init__(self, parts: parts_lib.Parts, stop_s: float = 26.0) -> None:
    """Makes the task.

    Args:
      parts: What it is made of.
      stop_s: When transmission stops, in seconds of simulation time.
    """
    super().__init__(parts)
    self._stop_s = stop_s

  def _begin_dance(self) -> None:
    super()._begin_dance()
    self.performer.stop(self._stop_s)
