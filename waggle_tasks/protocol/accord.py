"""What all members of a conversation know before it begins, as one value."""

import dataclasses
import functools

from waggle_tasks import errors
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import (
  alphabets,
  checks,
  coding,
  letters,
  levels,
  payload,
)
from waggle_tasks.protocol import parts as parts_lib
from waggle_tasks.protocol import seats as seats_lib
from waggle_tasks.protocol.symbols import Symbol

# Replies about parts have a check; a number alone is checked by its strip.
_REPLY_CHECK = 'crc4'
# How much later than by the clock a frame may be confirmed, or a dance begin.
_LATE_S = 0.6


class AccordError(errors.WaggleError):
  """A conversation that nobody can hold."""


@dataclasses.dataclass(frozen=True)
class Accord:
  """The rules of a conversation.

  Attributes:
    agreement: The language of levels, camera, rate, height and units.
    seats: Where each member hovers, by its number.
    form: The fields of letters.
    parts: How a longer message is cut; None where a letter is a whole one.
    tries: How often a letter is said at most, 1 to 20.
    ready_s: For how long a dancer must rest before it is answered, 0.5 to 5 s:
      it has to learn how its audience looks at rest.
    quiet_s: The least rest before a letter is said again, 0.5 to 10 s...
    spread_s: ...and how much longer it may be, by what is drawn, 0 to 10 s:
      what hides a dancer again and again does not hide it every time.
    gap_s: The rest between two parts, 0.3 to 5 s.
  """

  agreement: agreement_lib.Agreement
  seats: tuple[seats_lib.Seat, ...]
  form: letters.Form = letters.Form()
  parts: parts_lib.Parts | None = None
  tries: int = 3
  ready_s: float = 1.1
  quiet_s: float = 1.3
  spread_s: float = 2.5
  gap_s: float = 0.5

  def __post_init__(self) -> None:
    bounds = {
      'tries': (1, 20), 'ready_s': (0.5, 5.0), 'quiet_s': (0.5, 10.0),
      'spread_s': (0.0, 10.0), 'gap_s': (0.3, 5.0),
    }  # fmt: skip
    checks.settle_numbers(self, bounds, AccordError)
    if not isinstance(self.agreement.spoken.alphabet, levels.Levels):
      raise AccordError(
        '`language` of a conversation must be one of levels, which look the'
        " same from everywhere: choose 'swift' or 'rapid'"
      )
    if not 2 <= len(self.seats) <= letters.MOST_MEMBERS:
      raise AccordError(
        f'`seats` must be 2 to {letters.MOST_MEMBERS}, as a reply names its'
        f' member with 3 bits: got {len(self.seats)}'
      )

  @functools.cached_property
  def replies(self) -> letters.ReplyForm:
    """The fields of replies."""
    return letters.ReplyForm(
      self.form.addressed, self.parts.count if self.parts else 0
    )

  def views(self, member: int) -> tuple[seats_lib.View, ...]:
    """Whom a member sees, and where."""
    return seats_lib.views(self.seats, member, self.agreement.camera)

  @functools.cached_property
  def letter_agreement(self) -> agreement_lib.Agreement:
    """What a reader of letters knows."""
    return self._agreed(self.form.num_bits)

  @functools.cached_property
  def reply_agreement(self) -> agreement_lib.Agreement:
    """What a reader of replies knows."""
    agreed = self._agreed(self.replies.num_bits)
    code = coding.Coding(_REPLY_CHECK if self.parts else 'none')
    language = dataclasses.replace(agreed.spoken, coding=code)
    return dataclasses.replace(agreed, language=language)

  def _agreed(self, num_bits: int) -> agreement_lib.Agreement:
    """An agreement whose frames carry so many bits, as fields of a payload."""
    heading = (num_bits - 1) // 2
    units = payload.Units(
      heading_bits=heading, distance_bits=num_bits - 1 - heading
    )
    return dataclasses.replace(self.agreement, units=units, packets=None)

  @functools.cached_property
  def letter_s(self) -> float:
    """From the first stroke of a letter to the end of END."""
    return _length_s(self.letter_agreement)

  @functools.cached_property
  def reply_s(self) -> float:
    """The same of a reply."""
    return _length_s(self.reply_agreement)

  @property
  def confirm_s(self) -> float:
    """The rest after END that belongs to a frame."""
    return self.agreement.spoken.confirm_s

  @functools.cached_property
  def window_s(self) -> float:
    """How long after a letter all of its replies have been read."""
    begin_s = self.confirm_s + self.ready_s + _LATE_S
    return begin_s + self.reply_s + self.confirm_s + _LATE_S

  @property
  def late_s(self) -> float:
    """How long after a frame was read a reply to it may begin at the latest."""
    return self.ready_s + _LATE_S

  @functools.cached_property
  def echo_s(self) -> float:
    """How long after a letter one has seen that it was passed on."""
    begin_s = self.confirm_s + self.ready_s + _LATE_S
    return begin_s + self.letter_s + self.confirm_s + _LATE_S

  @functools.cached_property
  def over_s(self) -> float:
    """A dancer that rests for so long says no more."""
    wait_s = self.echo_s if self.form.hopping else self.window_s
    return wait_s + self.quiet_s + self.spread_s + _LATE_S

  @functools.cached_property
  def sense_s(self) -> float:
    """All rest for so long before another dances: no answer is waited for."""
    return self.confirm_s + self.late_s + _LATE_S / 2


def frame(
  agreement: agreement_lib.Agreement, bits: str
) -> tuple[alphabets.Token, ...]:
  """What is flown for some bits: START, their symbols, END."""
  return (Symbol.START, *agreement.word(bits), Symbol.END)


def _length_s(agreement: agreement_lib.Agreement) -> float:
  bits = '0' * agreement.frame_bits
  motions = frame(agreement, bits)
  return alphabets.lay_out(agreement.spoken.alphabet, motions, 0.0)[-1].end_s
