"""Whether the pauses of a dance hold what a receiver takes for a null."""

from collections.abc import Sequence

from waggle_tasks import errors, scenario
from waggle_tasks.agents import description, receivers
from waggle_tasks.protocol import agreement as agreement_lib

# A rest is seen from one image to another, and a gesture at either end of it
# is seen a little later than it begins.
_EDGES = 2  # Times from one image to the next.


class PauseError(errors.WaggleError):
  """A pause that is too short for a receiver to see that it is one."""


def needed_s(
  receiver_name: str,
  agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
) -> float | None:
  """The shortest stillness between two motions that a receiver can confirm.

  That is what it asks a null to last, and what it takes before to see that the
  motion is over.

  Args:
    receiver_name: As `receivers.make` takes it.
    agreement: What both sides know.

  Returns:
    Seconds; None for a receiver that does not tell.
  """
  null = receivers.describe(receiver_name, agreement).null
  return None if null is None else _needed_s(null, agreement)


def _needed_s(
  null: description.Null, agreement: agreement_lib.Agreement
) -> float:
  return round(null.hold_s + null.end_s + _EDGES * agreement.frame_s, 6)


def flaw(
  scene: scenario.Scenario, receiver_name: str, spare_s: float = 0.0
) -> str | None:
  """Why a dance has too little stillness for a receiver, or None.

  Args:
    scene: The scenario.
    receiver_name: As `receivers.make` takes it.
    spare_s: How much more there must be than the least.
  """
  null = receivers.describe(receiver_name, scene.agreement).null
  if null is None:
    return None
  hold_s, pauses = null.hold_s, scene.pauses
  least_s = _needed_s(null, scene.agreement)
  if pauses.initial_hover_s < hold_s - 1e-6:
    return (
      f'{pauses.initial_hover_s:.2f} s before START, of which a null of'
      f' {receiver_name} takes {hold_s:.2f} s'
    )
  if null.separators and pauses.pause_s < least_s + spare_s - 1e-6:
    return (
      f'{pauses.pause_s:.2f} s between gestures, of which a null of'
      f' {receiver_name} takes {least_s:.2f} s'
    )
  return None


def check(scenes: Sequence[scenario.Scenario], receiver_name: str) -> str:
  """Refuses to fly what a receiver has no time to read anywhere.

  Args:
    scenes: What is to be flown.
    receiver_name: As `receivers.make` takes it.

  Returns:
    A note for people where only some messages cannot be read; else nothing.

  Raises:
    PauseError: naming the pause, what is needed, and both numbers.
  """
  sent = [scene for scene in scenes if scene.performance.message is not None]
  flaws = [why for scene in sent if (why := flaw(scene, receiver_name))]
  if not flaws:
    return ''
  rule = (
    '`initial_hover_s`, and `settle_s` + `gap_s` + `lead_in_s`, must hold what'
    f' the receiver takes for a null: got {flaws[0]}'
  )
  if len(flaws) == len(sent):
    raise PauseError(rule)
  return f'{len(flaws)} of {len(scenes)} scenarios cannot be read: {rule}'
