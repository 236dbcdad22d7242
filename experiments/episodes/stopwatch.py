"""How long a receiver takes for its images, by the clock of this machine."""

import time
from typing import Any

import numpy as np

from waggle_tasks.agents import klt, observer_agent, receiver, segmenter


class Timed:
  """A receiver that is watched while it works.

  Attributes:
    took_s: How long each image took.
  """

  def __init__(self, reader: receiver.Receiver) -> None:
    """Makes it.

    Args:
      reader: Who works.
    """
    self._reader = reader
    self.took_s: list[float] = []

  @property
  def track(self) -> klt.Track | None:
    """See `receiver.Receiver`."""
    return self._reader.track

  @property
  def segment(self) -> segmenter.Segment | None:
    """See `receiver.Receiver`."""
    return self._reader.segment

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    """See `receiver.Receiver`."""
    began_s = time.perf_counter()
    events = self._reader.step(image, time_s)
    self.took_s.append(time.perf_counter() - began_s)
    return events

  @property
  def median_ms(self) -> float:
    """The median of an image, in ms."""
    return round(1000 * float(np.median(self.took_s)), 4)


def watch(reader: receiver.Receiver) -> Any:  # noqa: ANN401
  """The receiver, watched; errors call it as they did."""
  return type(type(reader).__name__, (Timed,), {})(reader)


def put(team: observer_agent.Team) -> list[Timed]:
  """Watches the receivers of a team that has not begun."""
  watches = [watch(agent.receiver) for agent in team.agents]
  for agent, watched in zip(team.agents, watches, strict=True):
    agent.receiver = watched
  return watches
