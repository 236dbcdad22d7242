"""Which receiver reads an agreement, with nulls that its pauses hold."""

from waggle_tasks.agents import receivers
from waggle_tasks.experiments.record import nulls
from waggle_tasks.protocol import agreement as agreement_lib

JOINT = 'joint'
# Of a pause: some of it passes until a motion is seen to be over, and it may be
# shorter than was agreed.
_SHARE = 0.4
# What a sum of events shows: nothing of a target at rest, and one that looks
# another way wherever it is.
_OF_EVENTS = {
  JOINT: (
    'min_contrast=0,lost_share=0.3,most_share=6,most_wider=0,most_higher=0'
  ),
  'view_bank': 'min_contrast=0',
}


def of_events(agreement: agreement_lib.Agreement) -> str:
  """The receiver for events, see `usual`."""
  name = usual(agreement, 'view_bank')
  stem = name.partition(':')[0]
  comma = ',' if '=' in name else ':'
  return f'{name}{comma}{_OF_EVENTS[stem]}'


def fitted(name: str, agreement: agreement_lib.Agreement) -> str:
  """A receiver whose null is no longer than the pauses hold.

  Args:
    name: As `receivers.make` takes it.
    agreement: What both sides know.

  Returns:
    The name as it is, where its null fits; else with a `hold_s` of two fifths
    of a pause.
  """
  null = receivers.describe(name, agreement).null
  if null is None or 'hold_s=' in name:
    return name
  pauses = agreement.pauses
  needed_s = nulls.needed_s(name, agreement)
  fits = needed_s is None or needed_s <= pauses.pause_s + 1e-6
  if fits and null.hold_s <= pauses.initial_hover_s + 1e-6:
    return name
  hold_s = round(_SHARE * min(pauses.pause_s, pauses.initial_hover_s), 3)
  comma = ',' if '=' in name else ':'
  return f'{name}{comma}hold_s={hold_s:g}'


def usual(
  agreement: agreement_lib.Agreement,
  plain: str = 'klt',
) -> str:
  """The receiver for those who name none.

  Args:
    agreement: What both sides know.
    plain: That for the paper's language with the paper's nulls.
  """
  if agreement.language is not None:
    return JOINT
  fits = fitted(plain, agreement) == plain
  return plain if fits else fitted('view_bank', agreement)
