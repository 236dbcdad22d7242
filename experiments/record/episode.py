"""What happened in an episode, as values that need no simulator."""

from collections.abc import Callable
import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import flown as flown_lib
from waggle_tasks.experiments.record import traces as traces_lib
from waggle_tasks.tasks import safety

if TYPE_CHECKING:
  from dm_control import composer
  import dm_env

Event = receiver.Event | observer_agent.Navigation | safety.Refusal


@dataclasses.dataclass(frozen=True, eq=False)
class Rollout:
  """What happened in an episode.

  Attributes:
    times_s: (T,) one time for each frame, from zero.
    positions_m: By vehicle name, (T, 3) true positions.
    contacts: Time and names of every pair that touched.
    events: By observer name, what its agent saw and did, and what the safety
      checks refused, in order of time.
    renderer: The GL renderer that drew the images.
    traces: By observer name, what its receiver saw in each image.
    drifts_m: By vehicle name, (T, 3) how far it was taken from its reference;
      nobody when empty.
    targets_px: By observer name, (T, 2) where the performer truly was in its
      picture, x right and y down; NaN behind the camera.
    receiver: How observers read.
    flights: By vehicle name, how it flew, where it has rotors.
  """

  times_s: np.ndarray
  positions_m: dict[str, np.ndarray]
  contacts: tuple[tuple[float, tuple[str, str]], ...]
  events: dict[str, tuple[Event, ...]]
  renderer: str
  traces: dict[str, traces_lib.Trace] = dataclasses.field(default_factory=dict)
  drifts_m: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
  targets_px: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
  receiver: str = ''
  flights: dict[str, flown_lib.Flown] = dataclasses.field(default_factory=dict)

  def steady_m(self, name: str) -> np.ndarray:
    """(T, 3) true positions of a vehicle, less its drift: nobody's command."""
    return self.positions_m[name] - self.drifts_m.get(name, 0.0)

  def told_m(self, name: str) -> np.ndarray:
    """(T, 3) where a vehicle was told to be; without rotors it was there."""
    flown = self.flights.get(name)
    return self.steady_m(name) if flown is None else flown.told_m

  def believed_m(self, name: str) -> np.ndarray:
    """(T, 3) where a vehicle took itself to be, less its drift."""
    flown = self.flights.get(name)
    return self.steady_m(name) + (0.0 if flown is None else flown.error_m)


@dataclasses.dataclass(frozen=True, eq=False)
class Step:
  """A step of an episode, after the team has acted on it.

  Attributes:
    environment: Where it happens.
    timestep: What came of it.
    team: Who acts.
  """

  environment: 'composer.Environment'
  timestep: 'dm_env.TimeStep'
  team: observer_agent.Team


# What looks on: it may look at everything and change nothing.
Onlooker = Callable[[Step], None]
