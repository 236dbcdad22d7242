"""Flies one case of a sweep and shows its images again, spoilt in many ways.

A flight costs more than reading its images. So a case is flown once, before
observers who only watch, and then each of many receivers reads those images,
spoilt in another way, which the case's seed and a number draw. A receiver that
reads a message would fly it: what it read is all that counts here.
"""

from collections.abc import Callable
import hashlib
from typing import Any

from waggle_tasks import plain
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import tape as tape_lib
from waggle_tasks.experiments.record import encoding, verdicts
from waggle_tasks.experiments.studies import spoilers, sweep_cases, sweep_flight


def fly(
  report: Callable[[float], None],
  case: sweep_cases.Case,
  receiver_name: str,
  identity: str,
  replays: int,
) -> dict[str, Any]:
  """Runs a case; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    receiver_name: The receiver.
    identity: See `identity.of`.
    replays: How many exposures each observer has.

  Returns:
    The case's line of results.jsonl.
  """
  scene, outcomes = case.scene, []
  tapes = tape_lib.record(scene, report)
  poses = scene.poses()
  for number, tape in enumerate(tapes, 1):
    expected = evaluator.expected_bits(scene, number)
    for replay in range(replays):
      text = f'{scene.seed} {number} {replay}'
      seed = int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], 'big')
      spoiling = spoilers.draw(seed, scene.agreement, tape.times_s[-1])
      reader = receivers.make(receiver_name, scene.agreement)
      message, events = _read(reader, spoiling(tape.play()))
      outcome = verdicts.Outcome(
        f'observer_{number}, replay {replay}', expected, message
      )
      place = sweep_flight.place(poses[f'observer_{number}'])
      outcomes.append({**_exposure(outcome, spoiling, events), **place})
      # All observers of one replay are as much as the flight.
      report((1 + len(outcomes) / len(tapes)) * tape.times_s[-1])
  whole = {
    **sweep_flight.head(case),
    'identity': identity,
    'receiver': receiver_name,
    'renderer': tapes[0].renderer,
    'simulated_s': round(tapes[0].times_s[-1], 3),
    'passed': all(each['right'] for each in outcomes),
    'outcomes': outcomes,
    'scenario': case.values,
  }
  return encoding.stamped(whole)


def _read(
  reader: receiver.Receiver, stream: tape_lib.Stream
) -> tuple[str | None, int]:
  """The first message that a receiver reads, and how many events it saw."""
  count = 0
  for image, time_s in stream:
    for event in receiver.step(reader, image, time_s):
      count += 1
      if event.message is not None:
        return event.message.bits, count
  return None, count


def _exposure(
  outcome: verdicts.Outcome, spoiling: spoilers.Spoiling, events: int
) -> dict[str, Any]:
  right = outcome.decoded == outcome.expected
  said = outcome.decoded or 'nothing'
  failures = () if right else (f'decoding: read {said}; {spoiling.name}',)
  return {
    **plain.to_plain(outcome),
    'failures': failures,
    'right': right,
    'wrong': outcome.wrong,
    'unauthorised': outcome.wrong,
    'stages': [each.partition(':')[0] for each in failures],
    'spoilt': spoiling.name,
    'events': events,
  }
