"""Controls: episodes in which a message must not be read, or not by all.

Paper, section 'Controls and supplemental suite'.
"""

from waggle_tasks.entities import eye
from waggle_tasks.protocol import schedule
from waggle_tasks.tasks import broadcast
from waggle_tasks.tasks import parts as parts_lib


class NoSend(broadcast.Broadcast):
  """Nobody dances: all vehicles stay where they are."""

  def _begin_dance(self) -> None:
    self.performer.perform(schedule.Schedule(()))


class BlackInput(broadcast.Broadcast):
  """One observer's camera delivers only black images."""

  def __init__(self, parts: parts_lib.Parts, number: int = 2) -> None:
    """Makes the task.

    Args:
      parts: What it is made of.
      number: Which observer sees nothing, counted from 1.
    """
    super().__init__(parts)
    self.observers[number - 1].corruptor = lambda: eye.black


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
