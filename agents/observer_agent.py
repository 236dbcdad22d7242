"""A receiver and a navigator together: what one observer runs."""

from collections.abc import Mapping, Sequence
import dataclasses
import enum
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.agents import image_chain, receiver, receivers
from waggle_tasks.agents import navigator as navigator_lib
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import payload

SIGHTS = ('camera', 'time_s', 'position_m')


class ObservationError(errors.WaggleError):
  """Observations that are not one for each agent, or lack what it needs."""


class Deed(enum.StrEnum):
  """What a navigator did."""

  START = 'navigation start'
  ARRIVAL = 'arrival'


@dataclasses.dataclass(frozen=True)
class Navigation:
  """Something that an observer did with its own message.

  Attributes:
    time_s: When.
    deed: What.
    target_m: Where its message leads to, world metres.
    payload: The message.
    images: How many images the receiver had seen.
    provenance: Hash of those images and their times.
  """

  time_s: float
  deed: Deed
  target_m: tuple[float, float, float]
  payload: payload.Payload
  images: int
  provenance: str


class ObserverAgent:
  """Reads its own images until it has a message, then flies it.

  Attributes:
    events: What it saw and did in this episode, in order.
    read_s: Time of the last image that its receiver took; NaN before one.
  """

  def __init__(
    self, reader: receiver.Receiver, navigator: navigator_lib.Navigator
  ) -> None:
    """Makes an agent at the beginning of an episode.

    Args:
      reader: Its receiver.
      navigator: Its navigator.
    """
    self.receiver = reader
    self._navigator = navigator
    self._chain = image_chain.Chain()
    self._command: navigator_lib.Command | None = None
    self.events: list[receiver.Event | Navigation] = []
    self.read_s = math.nan
    self._time_s = -math.inf
    self._action: np.ndarray | None = None

  def step(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
    """Takes an observation and returns an action.

    One that is not newer than the last holds an image that was read already:
    it is passed over, and the last action stands.

    Args:
      observation: `camera` (H, W, 3) uint8, `time_s` () and `position_m`
        (3,).

    Returns:
      (13,) see `reference.Reference`.

    Raises:
      ObservationError: if one of them is missing, or no number.
    """
    _check(observation, 'this agent')
    time_s = float(observation['time_s'])
    if self._action is not None and time_s <= self._time_s:
      return self._action
    position_m = np.asarray(observation['position_m'])
    if self._navigator.target_m is None:  # Navigating, it reads no more.
      self._read(observation['camera'], position_m, time_s)
    self._time_s = time_s
    wanted = self._navigator.step(position_m, time_s)
    if self._navigator.arrival_s == time_s:
      self._note(Deed.ARRIVAL, time_s)
    self._action = wanted.to_array()
    return self._action

  def _read(
    self, image: np.ndarray, position_m: np.ndarray, time_s: float
  ) -> None:
    events = receiver.step(self.receiver, image, time_s)  # It may refuse.
    self.read_s = time_s
    self._chain.add(image, time_s)
    self.read_s = time_s
    for event in events:
      self.events.append(event)
      if isinstance(event.message, payload.Payload):
        command = navigator_lib.Command(event.message, self._chain.digest)
        self._navigator.accept(command, position_m, time_s)
        self._command = command
        self._note(Deed.START, time_s)

  def _note(self, deed: Deed, time_s: float) -> None:
    target_m, command = self._navigator.target_m, self._command
    if target_m is None or command is None:
      return  # Nothing is done without a command.
    x_m, y_m, z_m = map(float, target_m)
    self.events.append(
      Navigation(
        time_s,
        deed,
        (x_m, y_m, z_m),
        command.payload,
        self._chain.images,
        command.provenance,
      )
    )


class Team:
  """One agent for each observer; none of them sees another's images.

  Attributes:
    agents: In the order of observations and actions.
  """

  def __init__(
    self,
    count: int,
    receiver_name: str = 'klt',
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
  ) -> None:
    """Makes the agents at the beginning of an episode.

    Args:
      count: How many.
      receiver_name: One of `receivers.RECEIVERS`.
      agreement: What both sides know.

    Raises:
      ReceiverError: if the receiver is not known.
    """
    self.agents = tuple(
      ObserverAgent(
        receivers.make(receiver_name, agreement),
        navigator_lib.Navigator(agreement),
      )
      for _ in range(count)
    )

  def step(
    self, observations: Sequence[Mapping[str, np.ndarray]]
  ) -> list[np.ndarray]:
    """Takes one observation for each agent and returns their actions.

    Raises:
      ObservationError: if there is not one for each agent, or one lacks what
        an agent needs; no agent has taken anything then.
    """
    if len(observations) != len(self.agents):
      raise ObservationError(
        f'`observations` must be one for each of {len(self.agents)} agents:'
        f' got {len(observations)}'
      )
    for number, observation in enumerate(observations, 1):
      _check(observation, f'agent {number}')
    return [
      agent.step(observation)
      for agent, observation in zip(self.agents, observations, strict=True)
    ]


def _check(observation: Mapping[str, np.ndarray], whose: str) -> None:
  """Refuses what is no observation, or lacks something.

  Args:
    observation: What an agent is to take.
    whose: The agent, as the error names it.

  Raises:
    ObservationError: naming the agent, and what it needs and lacks.
  """
  is_one = isinstance(observation, Mapping)
  missing = [name for name in SIGHTS if not is_one or name not in observation]
  if missing:
    raise ObservationError(
      f'an observation must hold {", ".join(SIGHTS)}: that of {whose} lacks'
      f' {", ".join(missing)}'
    )
  for name, size in (('time_s', 1), ('position_m', 3)):
    value = np.asarray(observation[name])
    is_number = value.size == size and value.dtype.kind in 'iuf'
    if not is_number or not np.isfinite(value).all():
      word = 'a finite number' if size == 1 else f'{size} finite numbers'
      raise ObservationError(
        f'`{name}` of {whose} must be {word}: got {observation[name]!r}'
      )
