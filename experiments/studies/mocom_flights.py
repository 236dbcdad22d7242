"""Flies MoCom's timelines, and counts which of their symbols are read."""

from collections.abc import Iterator, Sequence
import dataclasses
import itertools

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.protocol import frame, mocom, performance, reference, schedule
from waggle_tasks.protocol.symbols import Symbol

_AFTER_S = 4.0  # In which the last null is confirmed.


@dataclasses.dataclass(frozen=True)
class Timeline(scenario.Scenario):
  """A message in MoCom's motions, each with a length and a gap of its own.

  The scenario's seed draws them.

  Attributes:
    drawn: Whether they are drawn; else all are the agreed ones.
  """

  drawn: bool = True

  @property
  def performance(self) -> performance.Performance:
    """What the performer flies."""
    if not self.drawn:
      return super().performance
    rng = np.random.RandomState(self.seed)
    return performance.Performance(
      mocom.timeline(self.message, rng), says=self.message
    )


def scene(
  payload: str, distance_m: float, seed: int, drawn: bool = True
) -> Timeline:
  """A message before one observer in front.

  Args:
    payload: Its bits.
    distance_m: How far the observer is.
    seed: Draws the timeline.
    drawn: See `Timeline`.
  """
  agreed = mocom.AGREEMENT
  return Timeline(
    observers=1, payload=payload, distance_m=distance_m, seed=seed,
    codebook=agreed.codebook, pauses=agreed.pauses, tolerance=agreed.tolerance,
    drawn=drawn,
  )  # fmt: skip


def images(flown: scenario.Scenario) -> Iterator[tuple[np.ndarray, float]]:
  """What its one observer sees, which stays where it is.

  Yields:
    Images, (H, W, 3) uint8, which the next one overwrites, and their times.
  """
  # Imported here: what counts needs no simulator.
  from waggle_tasks import registry

  environment = registry.environment(flown)
  end_s = flown.performance.end_s + _AFTER_S
  try:
    timestep = environment.reset()
    while not timestep.last():
      (seen,) = timestep.observation
      if seen['time_s'] > end_s:
        return
      yield seen['camera'], float(seen['time_s'])
      hover = reference.Reference.hover(seen['position_m']).to_array()
      timestep = environment.step([hover])
  finally:
    environment.close()


@dataclasses.dataclass(frozen=True)
class Count:
  """How much of what was flown was read.

  Attributes:
    motions: How many motions were flown...
    motions_read: ...and how many of them were named rightly, at their time.
    nulls: How many rests were flown...
    nulls_read: ...and confirmed, once each.
    messages: How many messages were flown...
    messages_read: ...and read.
    wrong: How many messages were read that were not flown.
  """

  motions: int = 0
  motions_read: int = 0
  nulls: int = 0
  nulls_read: int = 0
  messages: int = 0
  messages_read: int = 0
  wrong: int = 0

  def __add__(self, other: 'Count') -> 'Count':
    pairs = zip(
      dataclasses.astuple(self), dataclasses.astuple(other), strict=True
    )
    return Count(*map(sum, pairs))


def read(
  flown: scenario.Scenario, names: Sequence[str]
) -> dict[str, tuple[receiver.Event, ...]]:
  """What receivers confirm, all of the same images, by their names."""
  readers = {name: receivers.make(name, mocom.AGREEMENT) for name in names}
  found: dict[str, list[receiver.Event]] = {name: [] for name in names}
  for image, time_s in images(flown):
    for name, each in readers.items():
      found[name] += receiver.step(each, image, time_s)
  return {name: tuple(events) for name, events in found.items()}


def count(flown: scenario.Scenario, events: Sequence[receiver.Event]) -> Count:
  """Compares events with what was flown.

  A motion counts as read where its name is the only one between its middle and
  that of the next; so does a rest. A receiver that reads frames as a whole
  names all motions of a frame at its end, and no rests.
  """
  slots = flown.performance.schedule.slots
  said = [each.message.bits for each in events if each.message]
  rests, motions = _between(slots, events)
  wanted = frame.motions(flown.message)
  words = [each.word for each in events if each.word]
  if words:
    whole = said[:1] == [flown.payload]
    named, nulls = len(wanted) * whole, 0
  else:
    named = sum(a == [b] for a, b in zip(motions, wanted, strict=True))
    nulls = sum(each == [Symbol.NULL] for each in rests)
  wrong = sum(bits != flown.payload for bits in said)
  return Count(
    len(wanted), named, len(rests), nulls, 1, int(flown.payload in said), wrong
  )


def _between(
  slots: Sequence[schedule.Slot], events: Sequence[receiver.Event]
) -> tuple[list[list[Symbol]], list[list[Symbol]]]:
  """Nulls, and motions, from middle to middle of what was flown."""
  middles_s = [(each.begin_s + each.end_s) / 2 for each in slots]
  edges_s = [-np.inf, *middles_s, np.inf]
  parts = [
    [e.symbol for e in events if begin_s <= e.time_s < end_s]
    for begin_s, end_s in itertools.pairwise(edges_s)
  ]
  null = Symbol.NULL
  rests = [[s for s in part if s == null] for part in parts]
  motions = [[s for s in part if s != null] for part in parts[1:]]
  return rests, motions
