"""Episodes without pictures, and what they are scored by: what was read.

Nobody flies there, so what a vehicle does with a message is not judged. A wrong
message would be flown.
"""

from collections.abc import Sequence

from waggle_tasks import fidelity, scenario
from waggle_tasks.agents import receiver
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import (
  evaluator,
  ladder_table,
  track_level,
  word_level,
)
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.protocol.symbols import Symbol

RENDERER = 'none'


def check(
  scenes: Sequence[scenario.Scenario],
  receiver_name: str,
  replays: bool = False,
) -> None:
  """Refuses what levels without pictures cannot tell of.

  Args:
    scenes: What is asked for.
    receiver_name: Who reads.
    replays: Whether pictures are to be shown again.

  Raises:
    LadderError: naming the field, the rule and the value.
  """
  for scene in scenes:
    if scene.fidelity == fidelity.PIXELS:
      continue
    if replays:
      raise ladder_table.LadderError(
        f'`replays` must be 0 at fidelity {scene.fidelity!r}, which has no'
        ' pictures to show again'
      )
    track_level.check_receiver(receiver_name, scene)
    table = ladder_table.read()
    if scene.fidelity == fidelity.SYMBOLS:
      word_level.read(scene, table)
    else:
      track_level.check(scene, table)


def run(
  scene: scenario.Scenario, receiver_name: str
) -> tuple[verdicts.Verdict, list[list[receiver.Event]]]:
  """What is read of a scenario of fidelity 'tracks' or 'symbols'.

  Args:
    scene: The scenario.
    receiver_name: Who reads.

  Returns:
    The verdict, and the events of each observer; words alone have none.

  Raises:
    LadderError: if it cannot be told.
  """
  if scene.fidelity == fidelity.SYMBOLS:
    track_level.check_receiver(receiver_name, scene)
    outcomes = word_level.read(scene)
    return verdicts.Verdict(tuple(outcomes)), [[] for _ in outcomes]
  events = track_level.read(scene, receiver_name)
  names = layouts.names(scene.observers)
  outcomes = [
    _outcome(scene, number, name, each)
    for number, (name, each) in enumerate(zip(names, events, strict=True), 1)
  ]
  return verdicts.Verdict(tuple(outcomes)), events


def _outcome(
  scene: scenario.Scenario,
  number: int,
  name: str,
  events: Sequence[receiver.Event],
) -> verdicts.Outcome:
  expected = evaluator.expected_bits(scene, number)
  read = next((each for each in events if each.message is not None), None)
  if read is None or read.message is None:
    reasons = [each.rejection for each in events if each.rejection]
    why = reasons[-1] if reasons else 'no frame was found'
    failures = () if expected is None else (f'message: none, {why}',)
    return verdicts.Outcome(name, expected, failures=failures)
  ends = [each.time_s for each in events if each.symbol == Symbol.END]
  bits = read.message.bits
  failures = ()
  if bits != expected:
    failures = (f'message: read {bits}, sent {expected or "nothing"}',)
  return verdicts.Outcome(
    name, expected, bits,
    end_s=ends[-1] if ends else None,
    final_null_s=read.time_s,
    start_s=None if bits == expected else read.time_s,
    failures=failures,
  )  # fmt: skip
