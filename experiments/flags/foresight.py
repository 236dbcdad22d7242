"""What commands tell before a flight of what cannot be read in it."""

from collections.abc import Sequence
import sys

from waggle_tasks import scenario
from waggle_tasks.experiments.record import nulls, reach


def tell(scenes: Sequence[scenario.Scenario], receiver_name: str) -> None:
  """Prints what cannot be read, to standard error; mostly nothing.

  Args:
    scenes: What is to be flown.
    receiver_name: As `receivers.make` takes it.

  Raises:
    PauseError: if the receiver has no time to read any of them.
  """
  for look in (nulls.check, reach.note):
    if note := look(scenes, receiver_name):
      print(note, file=sys.stderr)
