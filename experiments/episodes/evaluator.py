"""Scores an episode by truth and event logs, never by a navigator's word.

The rules are those of the paper's section 'Metrics and provenance checks'.
The expected displacement is calculated here from the bits that were sent, on
purpose without the code that the navigators use.
"""

from collections.abc import Sequence
import math
from typing import Any

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import diagnosis, reasons
from waggle_tasks.experiments.record import episode, verdicts
from waggle_tasks.protocol import flight
from waggle_tasks.tasks import progress, safety

# A message is eight motions between nine nulls (paper, section 'Motion
# alphabet and message framing').


def expected_bits(scene: scenario.Scenario, number: int) -> str | None:
  """What observer `number`, from 1, should read; None for nothing."""
  if scene.performance.message is None:
    return None
  if scene.control == 'black_input' and number == scene.black_observer:
    return None
  return scene.bits or scene.payload


def expected_displacement_m(scene: scenario.Scenario) -> np.ndarray:
  """Where the sent bits lead, (3,) metres: equations 1 and 2, from the text."""
  bits, units = scene.payload, scene.units
  split = 1 + units.heading_bits
  turn_rad = int(bits[1:split], 2) * units.heading_step_rad
  reach_m = int(bits[split:], 2) * units.distance_unit_m
  forward = reach_m if bits[0] == '0' else -reach_m
  # Heading zero is +Y, and a counterclockwise turn leads towards -X.
  return forward * np.array([-math.sin(turn_rad), math.cos(turn_rad), 0.0])


def evaluate(
  scene: scenario.Scenario, rollout: episode.Rollout
) -> verdicts.Verdict:
  """Scores every observer of an episode."""
  outcomes = []
  for number, name in enumerate(layouts.names(scene.observers), 1):
    expected = expected_bits(scene, number)
    if expected is None:
      outcomes.append(_judge_waiting(rollout, name))
    else:
      outcomes.append(_judge_reading(scene, rollout, name, expected))
  return verdicts.Verdict(tuple(outcomes))


def _judge_waiting(rollout: episode.Rollout, name: str) -> verdicts.Outcome:
  """An observer that must neither read a message nor move."""
  failures = _contact(rollout, name)
  _, decoded = _message(rollout.events[name])
  if decoded is not None:
    failures.append(f'message: read {decoded}, nothing was sent')
  start_s = _start_s(rollout.events[name])
  if start_s is not None:
    failures.append(f'navigation: started at {start_s:.2f} s')
  failures += _early_motion(rollout, name, math.inf)
  return verdicts.Outcome(
    name, None, decoded, start_s=start_s, failures=tuple(failures)
  )


def _judge_reading(
  scene: scenario.Scenario,
  rollout: episode.Rollout,
  name: str,
  expected: str,
) -> verdicts.Outcome:
  """An observer that must read the message and fly it."""
  events = rollout.events[name]
  message, decoded = _message(events)
  start_s = _start_s(events)
  failures = _contact(rollout, name)
  flies = not scene.bits  # Data command nothing.
  until_s = start_s if flies and start_s is not None else math.inf
  failures += _early_motion(rollout, name, until_s)
  if message is None or decoded is None:
    why = diagnosis.diagnose(scene, events)
    found = [f'message: none, {why}', *reasons.find(scene, rollout, name)]
    return verdicts.Outcome(
      name, expected, start_s=start_s,
      failures=(*found, *failures), diagnosis=why,
    )  # fmt: skip
  seen = [e for e in events if isinstance(e, receiver.Event)]
  seen = seen[: seen.index(message) + 1]
  failures += _frame(scene, seen, decoded)
  if decoded != expected:
    failures.append(f'message: read {decoded}, sent {expected}')
    failures += reasons.find(scene, rollout, name)
  final_null_s = message.time_s if message.symbol == 'NULL' else None
  if start_s != (final_null_s if flies else None):
    null = 'no final null'
    if final_null_s is not None:
      null = f'final null at {final_null_s} s'
    failures.append(f'release: navigation at {start_s} s, {null}')
  failures += [
    f'safety: {event.reason}'
    for event in events
    if isinstance(event, safety.Refusal)
  ]
  flown: dict[str, Any] = {}
  if flies:
    flown = _fly(scene, rollout, name, message.time_s)
    failures += flown.pop('failures')
  return verdicts.Outcome(
    name, expected, decoded,
    end_s=_end_s(seen),
    final_null_s=final_null_s, start_s=start_s,
    failures=tuple(failures), **flown,
  )  # fmt: skip


def _targets_m(
  scene: scenario.Scenario, rollout: episode.Rollout, name: str, frame: int
) -> tuple[np.ndarray, np.ndarray]:
  """Where what was sent leads a reader, (3,) as it takes it and in truth.

  It counts from where it takes itself to be. A place is the same for all.
  """
  begin_m = rollout.positions_m[name][frame]
  error_m = rollout.believed_m(name)[frame] - rollout.steady_m(name)[frame]
  error_m[2] = 0.0  # All fly to one height.
  goal_m, is_place = begin_m + error_m, scene.units.meaning == 'place'
  if is_place:  # Its slot is twice as far aside of the front as it is itself.
    aside_rad = 2 * math.atan2(goal_m[0], -goal_m[1])
    slot = np.array([math.sin(aside_rad), -math.cos(aside_rad), 0.0])
    goal_m = scene.units.slot_m * slot
  goal_m = goal_m + expected_displacement_m(scene)
  goal_m[2] = scene.hover_height_m
  if scene.safety == 'avoid':
    goal_m = safety.settled_m(
      goal_m,
      rollout.positions_m[name][0],
      [rollout.positions_m['performer'][0]],
      scene.kept_m,
    )
  return goal_m, goal_m if is_place else goal_m - error_m


def _message(
  events: Sequence[episode.Event],
) -> tuple[receiver.Event | None, str | None]:
  """The event that completed a message, and its bits."""
  for event in events:
    if isinstance(event, receiver.Event) and event.message is not None:
      return event, event.message.bits
  return None, None


def _end_s(events: Sequence[receiver.Event]) -> float | None:
  times_s = [event.time_s for event in events if event.symbol == 'END']
  return times_s[-1] if times_s else None


def _start_s(events: Sequence[episode.Event]) -> float | None:
  for event in events:
    if (
      isinstance(event, observer_agent.Navigation)
      and event.deed is observer_agent.Deed.START
    ):
      return event.time_s
  return None


def _contact(rollout: episode.Rollout, name: str) -> list[str]:
  for time_s, pair in rollout.contacts:
    if name in pair:
      return [f'contact: {" and ".join(pair)} at {time_s:.2f} s']
  return []


def _early_motion(
  rollout: episode.Rollout, name: str, until_s: float
) -> list[str]:
  """Whether it left its place before `until_s`."""
  positions_m = rollout.told_m(name)  # Air and errors are no command.
  away_m = np.linalg.norm(positions_m - positions_m[0], axis=1)
  early = (away_m > progress.MOTION_M) & (rollout.times_s <= until_s)
  if not early.any():
    return []
  first_s = rollout.times_s[early.argmax()]
  return [f'{verdicts.EARLY}: {away_m[early].max():.3f} m from {first_s:.2f} s']


def _frame(
  scene: scenario.Scenario, events: Sequence[receiver.Event], bits: str
) -> list[str]:
  """Whether what was read is the whole frame of a message, all of it."""
  words = [event.word for event in events if event.word is not None]
  if words:
    return _words(scene, words, bits)
  motions = ['START', *bits, 'END']
  nulls = len(motions) + 1
  seen = [str(event.symbol) for event in events[-len(motions) - nulls :]]
  if seen[1::2] == motions and seen[::2] == ['NULL'] * nulls:
    return []
  return [
    f'frame: not the {len(motions) + nulls} events of {bits} with their {nulls}'
    f' nulls: {" ".join(seen)}'
  ]


def _words(
  scene: scenario.Scenario, words: Sequence[tuple[int, ...]], bits: str
) -> list[str]:
  """Whether frames that were read as a whole are those of a message."""
  agreed = scene.agreement
  cut = (bits,) if agreed.packets is None else agreed.packets.split(bits)
  sent = {agreed.word(each) for each in cut}
  read = {*words[-1:]} if agreed.packets is None else {*words}
  if read == sent:
    return []
  return [f'frame: the words of {bits} are {sorted(sent)}: got {sorted(read)}']


def _fly(
  scene: scenario.Scenario,
  rollout: episode.Rollout,
  name: str,
  message_s: float,
) -> dict[str, Any]:
  """Arrival and hold at the place that was sent, by true positions."""
  positions_m, times_s = rollout.steady_m(name), rollout.times_s
  agreement = scene.agreement
  frame_s = agreement.frame_s
  begin = int(np.searchsorted(times_s, message_s - frame_s / 2))
  # An observer flies from where it was, drift and all, to the agreed height.
  goal_m, target_m = _targets_m(scene, rollout, name, begin)
  error_m = np.linalg.norm(positions_m - target_m, axis=1)
  speed_mps = (
    np.linalg.norm(
      np.diff(positions_m, axis=0, prepend=positions_m[:1]), axis=1
    )
    / frame_s
  )
  there = (error_m < flight.ARRIVAL_ERROR_M) & (
    speed_mps < flight.ARRIVAL_SPEED_MPS
  )
  there[: begin + 1] = False
  dwell = agreement.frames(flight.ARRIVAL_DWELL_S)
  arrival = next(
    (k for k in range(begin + dwell, len(there)) if there[k - dwell : k].all()),
    None,
  )
  last_m = float(error_m[-1])
  found: dict[str, Any] = {'error_m': last_m}
  if scene.estimator != 'none':
    off_m = rollout.believed_m(name)[-1] - goal_m
    found['estimate_error_m'] = float(np.linalg.norm(off_m))
  if arrival is None:
    reason = f'arrival: never, {last_m * 1e3:.1f} mm away at the end'
    return {**found, 'failures': [reason]}
  left = np.flatnonzero(error_m[arrival:] >= flight.ARRIVAL_ERROR_M)
  stayed = int(left[0]) if left.size else len(there) - 1 - arrival
  hold_s = stayed * frame_s
  failures = []
  if hold_s < flight.HOLD_S - 1e-6:
    failures.append(f'hold: {hold_s:.2f} s, under {flight.HOLD_S:g} s')
  return {
    **found,
    'arrival_s': float(times_s[arrival]),
    'hold_s': hold_s,
    'failures': failures,
  }
