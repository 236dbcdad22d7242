"""The broadcasts of a board: receivers by tiers, languages and scenes."""

from collections.abc import Mapping, Sequence
import dataclasses
import hashlib
import json
from typing import Any

from waggle_tasks.agents import receivers
from waggle_tasks.experiments.record import nulls, scenario_fields
from waggle_tasks.experiments.studies import board_tiers, sweep_cases
from waggle_tasks.protocol import checks

RECEIVER, TIER, LANGUAGE, SCENE = 'receiver', 'tier', 'language', 'scene'
CELL = RECEIVER, TIER, LANGUAGE, SCENE
_MOST = 2**63 - 1  # Of a referee's number.


@dataclasses.dataclass(frozen=True)
class Plan:
  """What is to be flown.

  Attributes:
    tiers: Names of `board_tiers.TIERS`.
    receivers: Who reads, as `receivers.make` takes them.
    referee: The number from which private seeds follow; None for public ones.
    languages: Those of `board_tiers.LANGUAGES` that are danced.
  """

  tiers: Sequence[str]
  receivers: Sequence[str]
  referee: int | None = None
  languages: Sequence[str] = board_tiers.LANGUAGES

  def __post_init__(self) -> None:
    error = board_tiers.BoardError
    for field in ('tiers', 'receivers', 'languages'):
      values = getattr(self, field)
      if not values or len({*values}) < len(values):
        raise error(
          f'`{field}` must name each once, and one the least: got {[*values]}'
        )
    for name in self.tiers:
      checks.choice('tiers', name, [*board_tiers.TIERS], error)
    for name in self.languages:
      checks.choice('languages', name, board_tiers.LANGUAGES, error)
    if self.referee is not None:
      checks.integer('referee', self.referee, 1, _MOST, error)


@dataclasses.dataclass(frozen=True)
class Unread:
  """A part of the board that a receiver cannot read.

  Attributes:
    receiver: The receiver.
    tier: The tier.
    language: The language.
    reason: Why.
  """

  receiver: str
  tier: str
  language: str
  reason: str


def scenes(
  tier: str, referee: int | None
) -> list[tuple[str, sweep_cases.Sample]]:
  """The broadcasts of a tier, whoever reads them, each with its language.

  Every one has a seed and a payload of its own, drawn from its values, its
  number and the referee's.

  Args:
    tier: Its name.
    referee: See `Plan`.

  Raises:
    WaggleError: if a scene breaks a rule of the scenario.
  """
  out = []
  for scene in board_tiers.TIERS[tier].scenes:
    for language in scene.languages:
      base = {
        **scenario_fields.defaults(), 'observers': 1,
        'payload': sweep_cases.RANDOM, 'language': language,
        'jitter_m': board_tiers.TIERS[tier].jitter_m, **scene.values,
        'seed': _drawn(tier, scene.name, referee),
      }  # fmt: skip
      for number in range(board_tiers.BROADCASTS[language]):
        if language == board_tiers.PAPER:
          base['initial_hover_s'] = _hover_s(tier, scene.name, number, referee)
        sample = sweep_cases.draw({}, base, number)
        cell = {TIER: tier, LANGUAGE: language, SCENE: scene.name}
        out.append((language, dataclasses.replace(sample, cell=cell)))
  return out


def _drawn(*of: object) -> int:
  """32 bits that follow from some words; nobody guesses a referee's."""
  text = ' '.join(map(str, ('board', board_tiers.VERSION, *of)))
  return int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], 'big')


def _hover_s(*of: object) -> float:
  """The first hover of a dance in the paper's language."""
  least_s, most_s = board_tiers.HOVER_S
  share = _drawn('hover', *of) / 2**32
  return round(least_s + share * (most_s - least_s), 2)


def cases(
  plan: Plan,
) -> tuple[list[sweep_cases.Sample], list[Unread]]:
  """Every case of a plan, and what of it is not read, with the reason.

  Raises:
    WaggleError: if a receiver is not known, or can read nothing at all.
  """
  for name in plan.receivers:
    receivers.configured(name)
  out: list[sweep_cases.Sample] = []
  unread: dict[tuple[str, str, str], Unread] = {}
  flaws: dict[tuple[str, str], str] = {}
  for tier in plan.tiers:
    samples = [
      each for each in scenes(tier, plan.referee) if each[0] in plan.languages
    ]
    for name in plan.receivers:
      for language, sample in samples:
        if (name, language) not in flaws:
          flaws[name, language] = _flaw(name, sample)
        if why := flaws[name, language]:
          unread[name, tier, language] = Unread(name, tier, language, why)
        else:
          cell = {RECEIVER: name, **sample.cell}
          out.append(dataclasses.replace(sample, cell=cell, receiver=name))
  if not out:
    reasons = [*(each.reason for each in unread.values()), 'none is so danced']
    raise board_tiers.BoardError(f'nothing can be read: {reasons[0]}')
  return out, [*unread.values()]


def _flaw(name: str, sample: sweep_cases.Sample) -> str:
  """Why a receiver cannot read what is danced; empty where it can."""
  try:
    receivers.make(name, sample.scene.agreement)
  except receivers.ReceiverError as error:
    return str(error)
  return nulls.flaw(sample.scene, name) or ''


def digest(tiers: Sequence[str], referee: int | None) -> dict[str, str]:
  """By tier, a SHA-256 of what is danced in it.

  It does not know of what scenarios may have beside: two boards with the same
  digest are of the same broadcasts.

  Args:
    tiers: Names of tiers.
    referee: See `Plan`.
  """
  usual = scenario_fields.defaults()
  out = {}
  for tier in tiers:
    told = [
      [dict(sample.cell), sample.repeat, _unusual(sample.values, usual)]
      for _, sample in scenes(tier, referee)
    ]
    text = json.dumps(told, sort_keys=True)
    out[tier] = hashlib.sha256(text.encode()).hexdigest()
  return out


def _unusual(
  values: Mapping[str, Any], usual: Mapping[str, Any]
) -> dict[str, Any]:
  return {name: x for name, x in values.items() if x != usual[name]}


def is_board(cell: Mapping[str, Any]) -> bool:
  """Whether a row's cell is one of a board."""
  return cell.keys() == {*CELL}
