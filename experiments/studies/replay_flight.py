"""Flies a scenario once and shows its images again, spoilt in many ways.

A flight costs more than reading its images. So it is flown once, before
observers who only watch, and then each of many receivers reads those images,
spoilt in another way, which the scenario's seed and a number draw. A receiver
that reads a message would fly it: what it read is all that counts here.
"""

from collections.abc import Callable
import hashlib

from waggle_tasks import scenario
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import tape as tape_lib
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.experiments.studies import case_rows, spoilers


def fly(
  scene: scenario.Scenario,
  receiver_name: str,
  replays: int,
  report: Callable[[float], None],
) -> tuple[str, float, list[case_rows.Exposure]]:
  """Flies a scenario once, and shows it again and again.

  Args:
    scene: The scenario.
    receiver_name: The receiver.
    replays: How many exposures each observer has.
    report: Told now and then how many seconds are done.

  Returns:
    The GL renderer, how long the flight was, and the exposures.
  """
  tapes = tape_lib.record(scene, report)
  poses, exposures = scene.poses(), []
  named = zip(layouts.names(scene.observers), tapes, strict=True)
  for number, (name, tape) in enumerate(named, 1):
    expected = evaluator.expected_bits(scene, number)
    for replay in range(replays):
      text = f'{scene.seed} {number} {replay}'
      seed = int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], 'big')
      spoiling = spoilers.draw(seed, scene.agreement, tape.times_s[-1])
      reader = receivers.make(receiver_name, scene.agreement)
      message, events = _read(reader, spoiling(tape.play()))
      failures = () if message == expected else (
        f'decoding: read {message or "nothing"}; {spoiling.name}',
      )  # fmt: skip
      outcome = verdicts.Outcome(
        f'{name}, replay {replay}', expected, message, failures=failures
      )
      exposures.append(
        case_rows.Exposure.of(
          outcome, poses[name], unauthorised=outcome.wrong, events=events,
          spoilt=spoiling.name,
        )
      )  # fmt: skip
      # All observers of one replay are as much as the flight.
      report((1 + len(exposures) / len(tapes)) * tape.times_s[-1])
  return tapes[0].renderer, tapes[0].times_s[-1], exposures


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
