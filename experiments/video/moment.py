"""What a picture of the video shows: an instant of the episode, copied."""

from collections.abc import Sequence
import dataclasses
from typing import Protocol

import numpy as np

from waggle_tasks.agents import klt
from waggle_tasks.agents import receiver as receiver_lib
from waggle_tasks.experiments.record import episode, moves, story
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import safety


@dataclasses.dataclass(frozen=True, eq=False)
class View:
  """One observer: what it sees, and what it makes of that.

  Attributes:
    name: The observer's name.
    image: (H, W, 3) uint8 RGB, exactly what its receiver got.
    track: What its receiver last found, or None.
    trail_px: (K, 2) the track since the last null.
    reading: How far it is.
    events: All its events so far.
  """

  name: str
  image: np.ndarray
  track: klt.Track | None
  trail_px: np.ndarray
  reading: story.Reading
  events: tuple[episode.Event, ...]


@dataclasses.dataclass(frozen=True, eq=False)
class Instant:
  """Everyone at one time.

  Attributes:
    time_s: Simulation time.
    sent: What the performer flies; None while it hovers.
    sights: Every observer on the page.
    shared: Images of the shared views by name, (H, W, 3) uint8 RGB each.
    places: In each of them, columns and rows of the vehicles by name.
  """

  time_s: float
  sent: moves.Sent | None
  sights: tuple[View, ...]
  shared: dict[str, np.ndarray]
  places: dict[str, dict[str, tuple[float, float]]]


class Watched(Protocol):
  """Who reads images: an agent, or a reader of a recording."""

  @property
  def receiver(self) -> receiver_lib.Receiver:
    """What reads them."""
    ...

  @property
  def events(self) -> Sequence[episode.Event]:
    """What it saw and did."""
    ...


class Watch:
  """Follows one agent, frame by frame, to tell its sight at any moment."""

  def __init__(
    self, name: str, agent: Watched, agreement: agreement_lib.Agreement
  ) -> None:
    """Follows an agent from the beginning of its episode.

    Args:
      name: The observer's.
      agent: The observer.
      agreement: What both sides know.
    """
    self._name, self._agent = name, agent
    self._events: list[episode.Event] = []
    self._reading = story.Reading(agreement)
    self._trail_px: list[np.ndarray] = []

  def note(self, refusals: Sequence[safety.Refusal]) -> None:
    """Takes what the agent did in this frame, and what it was refused."""
    track = self._agent.receiver.track
    if track is not None and track.valid:
      self._trail_px.append(track.centre_px)
    own = [r for r in refusals if r.vehicle == self._name]
    for event in [*self._agent.events, *own]:
      if event not in self._events:
        self._events.append(event)
        self._reading = self._reading.after(event)
        if getattr(event, 'symbol', None) is Symbol.NULL:
          self._trail_px = self._trail_px[-1:]

  def sight(self, image: np.ndarray) -> View:
    """What it sees now; the image is copied."""
    return View(
      self._name,
      image.copy(),
      self._agent.receiver.track,
      np.array(self._trail_px).reshape(-1, 2),
      self._reading,
      tuple(self._events),
    )
