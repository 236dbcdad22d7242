"""A member of a conversation: eye, readers, dancer, navigator, and a part.

It sees its own images, their times, where it takes itself to be, and knows the
accord. By its own clock it counts control steps: a dance goes on while images
do not come. While it dances or flies it is deaf, as its camera moves with it.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from waggle_tasks.agents import (
  image_chain,
  inputs,
  navigator,
  observer_agent,
  speaker,
  strips,
)
from waggle_tasks.agents import part as part_lib
from waggle_tasks.protocol import accord as accord_lib
from waggle_tasks.protocol import payload


class Member:
  """One vehicle's agent.

  Attributes:
    part: What it does.
    order_s: When it began to fly a message; None before that.
  """

  def __init__(
    self, accord: accord_lib.Accord, number: int, part: part_lib.Part
  ) -> None:
    """Makes an agent at the beginning of an episode.

    Args:
      accord: What all know.
      number: Its own number.
      part: What it does.
    """
    self._accord, self._agreement = accord, accord.agreement
    self.part = part
    self._views = accord.views(number)
    self._navigator = navigator.Navigator(self._agreement)
    self._chain, self._images = image_chain.Chain(), inputs.Images()
    self._strips: strips.Strips | None = None
    self._speaker: speaker.Speaker | None = None
    self._frames, self._seen_s = 0, -np.inf
    self.order_s: float | None = None

  @property
  def saying(self) -> bool:
    """Whether it dances, or has to let its camera come to rest."""
    if self._speaker is None:
      return False
    return self._frames * self._agreement.frame_s < self._speaker.end_s

  @property
  def done(self) -> bool:
    """Whether it has played its part, and is where that led it."""
    flies = self.part.order is not None and self._navigator.arrival_s is None
    return self.part.done and not self.saying and not flies

  def step(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
    """Takes an observation and returns an action.

    Args:
      observation: `camera` (H, W, 3) uint8, `time_s` () and `position_m`
        (3,).

    Returns:
      (13,) see `reference.Reference`.
    """
    now_s = self._frames * self._agreement.frame_s
    middle_s = now_s + self._agreement.frame_s / 2
    place_m = np.asarray(observation['position_m'])
    if self._speaker is None:
      alphabet = self._agreement.spoken.alphabet
      self._speaker = speaker.Speaker(alphabet, place_m.copy())
    if self.order_s is None and not self.saying:
      self._attend(observation, place_m, now_s)
    self._frames += 1
    if self.order_s is not None:
      return self._navigator.step(place_m, now_s).to_array()
    return self._speaker.reference(middle_s).to_array()

  def _attend(
    self,
    observation: Mapping[str, np.ndarray],
    place_m: np.ndarray,
    now_s: float,
  ) -> None:
    """Looks, and lets its part decide."""
    heard: Sequence[strips.Heard] = ()
    time_s = float(observation['time_s'])
    if self._strips is None:
      agreed = self._accord.letter_agreement
      if self.part.hears == part_lib.REPLIES:
        agreed = self._accord.reply_agreement
      self._strips = strips.Strips(agreed, self._views)
    if time_s > self._seen_s:
      image = observation['camera']
      self._images.check(image, time_s)
      self._chain.add(image, time_s)
      self._seen_s = time_s
      heard = self._strips.step(image, time_s)
    said = self.part.step(now_s, heard, self._strips.busy)
    if said is not None:
      self._say(said, now_s)
    elif self.part.order is not None:
      units = self._agreement.units
      told = payload.Payload.from_bits(self.part.order, units)
      command = navigator.Command(told, self._chain.digest)
      self._navigator.accept(command, place_m, now_s)
      self.order_s = now_s

  def _say(self, said: part_lib.Say, now_s: float) -> None:
    agreed = self._accord.letter_agreement
    if said.kind == part_lib.REPLIES:
      agreed = self._accord.reply_agreement
    if self._speaker is None:
      return
    self._speaker.say(accord_lib.frame(agreed, said.bits), now_s)
    self._strips = None


class Party:
  """All members; none of them sees another's images.

  Attributes:
    members: In the order of observations and actions.
  """

  def __init__(
    self, accord: accord_lib.Accord, parts: Sequence[part_lib.Part]
  ) -> None:
    """Makes the agents at the beginning of an episode.

    Args:
      accord: What all know.
      parts: What each of them does, by number.
    """
    self.members = tuple(
      Member(accord, number, part) for number, part in enumerate(parts)
    )

  def step(
    self, observations: Sequence[Mapping[str, np.ndarray]]
  ) -> list[np.ndarray]:
    """Takes one observation for each member and returns their actions.

    Raises:
      ObservationError: if there is not one for each.
    """
    if len(observations) != len(self.members):
      raise observer_agent.ObservationError(
        f'`observations` must be one for each of {len(self.members)} members:'
        f' got {len(observations)}'
      )
    return [
      member.step(each)
      for member, each in zip(self.members, observations, strict=True)
    ]

  @property
  def done(self) -> bool:
    """Whether nobody has anything to do any more."""
    return all(member.done for member in self.members)
