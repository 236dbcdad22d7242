"""The rows of a suite's results."""

import dataclasses
from typing import Any

from waggle_tasks import suites
from waggle_tasks.experiments.record import verdicts

RESULTS = 'results.jsonl'


@dataclasses.dataclass(frozen=True, kw_only=True)
class Row:
  """A line of results.jsonl.

  Attributes:
    format: See `encoding`.
    case: The case's name.
    group: What it is counted with.
    label: Its configuration, for tables.
    identity: What decides its result, as a hash.
    receiver: How observers read.
    observers: How many.
    expecting: How many of them a message was sent to.
    correct: How many read what was sent to them.
    passed: Whether no check of any observer failed.
    simulated_s: How long the episode was.
    published: What the paper gives for it.
    outcomes: One for each observer.
    scenario: Every field of the scenario.
  """

  format: int = 1
  case: str
  group: str
  label: str
  identity: str
  receiver: str
  observers: int
  expecting: int
  correct: int
  passed: bool
  simulated_s: float
  published: suites.Published | None
  outcomes: tuple[verdicts.Outcome, ...]
  scenario: dict[str, Any]
