"""Schemes of a link: what is spoken, who reads it, how often it is said."""

from collections.abc import Sequence
import dataclasses
import re
from typing import Any

from waggle_tasks import errors, scenario
from waggle_tasks.protocol import language_names, languages

_MOST_ROUNDS = 100
# The paper's language, and the receivers that lack what it asks to ablate.
_PAPER = {
  scenario.PAPER: 'view_bank',
  'paper without nulls': 'view_bank:separators=off',
  'paper without final confirmation': 'view_bank:final_null=off',
}
FORM = (
  f'a language ({", ".join([*_PAPER, *languages.LANGUAGES])}), with its code'
  " changed or not ('swift:check=crc4,parity=0'), and with a number of rounds"
  " or not ('swift x3')"
)


class SchemeError(errors.WaggleError):
  """A scheme that nobody can fly."""


@dataclasses.dataclass(frozen=True)
class Scheme:
  """A way to send a message.

  Attributes:
    name: What it is called, see `FORM`.
    language: What is spoken, as a scenario names it.
    receiver: Who reads it.
    rounds: How often all of it is said.
  """

  name: str
  language: str
  receiver: str
  rounds: int = 1

  @property
  def sendings(self) -> int:
    """How many broadcasts a message takes.

    The paper says a message once in a dance; again is another dance, and what
    is read first counts. Other languages say all rounds in one dance.
    """
    return self.rounds if self.language == scenario.PAPER else 1

  @property
  def values(self) -> dict[str, Any]:
    """What it changes in a scenario, see `scenario_fields`."""
    repeat = 1 if self.language == scenario.PAPER else self.rounds
    return {'language': self.language, 'repeat': repeat}

  @classmethod
  def of(cls, text: str) -> 'Scheme':
    """The scheme of a name.

    Raises:
      SchemeError: naming what is wrong with it.
    """
    found = re.fullmatch(r'(.*?)(?: +x(\d+))?', text)
    stem, rounds = (found[1], int(found[2] or 1)) if found else (text, 1)
    if not 1 <= rounds <= _MOST_ROUNDS:
      raise SchemeError(
        f'`schemes` must have 1 to {_MOST_ROUNDS} rounds: got {text!r}'
      )
    if stem in _PAPER:
      return cls(text, scenario.PAPER, _PAPER[stem], rounds)
    known = [*_PAPER, *languages.LANGUAGES]
    if stem.partition(':')[0] not in languages.LANGUAGES:
      hint = errors.did_you_mean(stem, known)
      raise SchemeError(f'`schemes` must each be {FORM}: got {text!r}.{hint}')
    try:
      language_names.find(stem)
    except errors.WaggleError as error:
      raise SchemeError(f'`schemes` {text!r}: {error}') from None
    return cls(text, stem, 'joint', rounds)


def parse(text: str) -> tuple[Scheme, ...]:
  """The schemes of a list.

  Args:
    text: Such as 'paper,swift:check=crc4,parity=0 x3,swift': what follows a
      comma and is a change of a code belongs to the scheme before.

  Raises:
    SchemeError: if there is none, one comes twice, or is wrong.
  """
  names = [each.strip() for each in re.split(r',(?!\s*\w*=)', text)]
  return tuple(map(Scheme.of, once('schemes', names)))


def once(field: str, values: Sequence[Any]) -> Sequence[Any]:
  """Refuses a list that is empty or names something twice."""
  if not values or len({*values}) < len(values):
    raise SchemeError(
      f'`{field}` must name each once, and one the least: got {[*values]}'
    )
  return values
