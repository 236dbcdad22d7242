"""Reads frames by a network that has learned what symbols look like.

The target is tracked and START is found as by `joint`. What was seen in each
slot of the frame is named by the network, see `network`, one after another.
It is told the symbol before, and by what it tells of the dancer's wander it is
shown the next slot. A word is believed if the network took END for END and took
nothing for none, and if the code fits; what it could not tell is missing.
"""

import dataclasses
from typing import ClassVar

import numpy as np

from waggle_tasks.agents import (
  description,
  group,
  joint_config,
  joint_description,
  joint_receiver,
  learned_weights,
  lock,
  network,
  slots,
  windows,
)
from waggle_tasks.protocol import agreement as agreement_lib

# How much of what is told of a pose is believed: right, down, late and size.
_BELIEVED = np.array([0.6, 0.6, 0.3, 0.0])
# Of `joint`, and of no use here.
_OTHERS = (
  'min_clear', 'max_misfit', 'max_worst', 'max_mended', 'max_end', 'max_astray'
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Judging(group.Group):
  """When what a network says is believed.

  Attributes:
    min_probability: How sure it must be of a symbol; less is missing.
    min_window: What share of a slot must be seen; less is missing.
    max_left: What may be left of it, as a share of the most that is left of
      symbols in training, see `network.Network`.
    max_distance: The same of its distance from its class.
  """

  min_probability: float = group.number(0.9, 0.5, 1)
  min_window: float = group.number(0.6, 0.1, 1)
  max_left: float = group.number(1.2, 0, 10)
  max_distance: float = group.number(1.0, 0, 10)


@dataclasses.dataclass(frozen=True)
class Config(joint_config.Config):
  """The receiver's numbers.

  Attributes:
    judging: When what the network says is believed.
  """

  judging: Judging = Judging()

  def __post_init__(self) -> None:
    super().__post_init__()
    usual = joint_config.Reading()
    for name in _OTHERS:
      value = getattr(self.reading, name)
      if value != getattr(usual, name):
        raise group.ReceiverError(
          f"`{name}` must not be given with 'learned', which judges by its"
          f' network: got {value!r}'
        )


class LearnedReceiver(joint_receiver.JointReceiver):
  """Names every slot of a frame by a network."""

  DEFAULT: ClassVar[Config] = Config()

  def __init__(
    self,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    config: Config | None = None,
  ) -> None:
    """Makes a receiver at the beginning of an episode.

    Args:
      agreement: What both sides know.
      config: The receiver's numbers, for the paper's camera; None for its own.

    Raises:
      ReceiverError: if there is no network for what is spoken.
    """
    config = config or self.DEFAULT
    self._judging = config.judging
    self._network = learned_weights.of(agreement)
    super().__init__(agreement, config)
    self._window_s = windows.slot_s(self._alphabet, self._language.confirm_s)

  @classmethod
  def describe(
    cls,
    agreement: agreement_lib.Agreement,
    config: joint_config.Config,
    width_px: float | None = None,
  ) -> description.Description:
    """See `receivers.describe`."""
    del width_px
    start, *_ = (told := joint_description.of(agreement, config)).frames
    judging = config.judging if isinstance(config, Config) else Judging()
    return dataclasses.replace(
      told,
      frames=(
        start,
        f'of a slot {judging.min_window:.0%} are seen, and its network is'
        f' {judging.min_probability:.0%} sure of a symbol: else it is missing',
        'nothing is seen that it takes for none, that is farther from symbols'
        f' than {judging.max_distance:g} times those it learned, or of which'
        f' they leave {judging.max_left:g} times as much',
        'it takes END and the rest after it for END',
        'what the code and the check of the language ask for holds',
      ),
    )

  def _attempt(self, start: lock.Lock) -> joint_receiver.Read:
    """The bits of a frame that began there, or why there are none."""
    samples = self._history.samples(start.begin_s)
    pose = slots.Pose(start.home_px, 0.0, start.scale_px)
    states = self._alphabet.states
    state: int | None = 0
    symbols: list[int | None] = []
    likely: list[int | None] = []  # What was seen, sure or not.
    sure = 1.0
    for number in range(self._count + 1):
      begin_s = (
        start.begin_s + self._usual.start_s + number * self._usual.slot_s
      )
      window = windows.of(samples, begin_s, self._window_s, pose)
      told = np.zeros(states if states > 1 else 0)
      if len(told) and state is not None:
        told[state] = 1.0
      answer = self._network.read(window, told)
      is_end = number == self._count
      if reason := self._doubtful(window, answer, number, is_end):
        return joint_receiver.Read(reason)
      symbol = self._symbol(window, answer)
      if is_end:
        break
      symbols.append(symbol)
      is_seen = window.share >= self._judging.min_window
      likely.append(answer.kind if is_seen else None)
      state = None if symbol is None else self._alphabet.after(symbol)
      if symbol is not None:
        sure = min(sure, answer.probability)
        pose = pose.moved(_BELIEVED * [*answer.move, 0.0])
    found = self._agreement.coding.read(
      symbols, self._agreement.frame_bits, self._alphabet.size
    )
    if found.bits is None:
      return joint_receiver.Read(found.reason)
    word = self._agreement.word(found.bits)
    if any(k not in (None, own) for k, own in zip(likely, word, strict=True)):
      return joint_receiver.Read('what the code asks for is not what was seen')
    distance_m = self._focal_px / start.scale_px
    return joint_receiver.Read(
      '', word, sure, found.bits, distance_m=distance_m
    )

  def _symbol(
    self, window: windows.Window, answer: network.Answer
  ) -> int | None:
    """The symbol, None where it is missing."""
    judging = self._judging
    missing = (
      window.share < judging.min_window
      or answer.probability < judging.min_probability
    )
    return None if missing else answer.kind

  def _doubtful(
    self,
    window: windows.Window,
    answer: network.Answer,
    number: int,
    is_end: bool,
  ) -> str:
    """Why what was seen in a slot is no part of a frame; empty if it may be."""
    judging, size = self._judging, self._alphabet.size
    where = 'END' if is_end else f'symbol {number + 1}'
    if is_end and (reason := self._end_unseen(window)):
      return reason
    if window.share < judging.min_window:
      return ''  # It says nothing.
    if answer.left > judging.max_left:
      return (
        f'what came for {where} is like no symbol: {answer.left:.2f} of what'
        f' may be left > {judging.max_left:g}'
      )
    kinds = (size,) if is_end else range(size)
    if answer.kind not in kinds:
      if answer.probability < judging.min_probability and not is_end:
        return ''
      return f'what came for {where} was none'
    if answer.distance > judging.max_distance:
      return (
        f'what came for {where} is far from all that was learned:'
        f' {answer.distance:.2f} > {judging.max_distance:g}'
      )
    if is_end and answer.probability < judging.min_probability:
      return (
        f'END is not sure: {answer.probability:.2f} <'
        f' {judging.min_probability:g}'
      )
    return ''

  def _end_unseen(self, window: windows.Window) -> str:
    """Why END and the rest after it were not seen; empty if they were."""
    resting = windows.times_s(self._window_s) >= self._usual.end_s
    for seen, what in (
      (window.seen, 'END'), (window.seen[resting], 'the rest after END'),
    ):  # fmt: skip
      if seen.mean() < self._judging.min_window:
        return f'{what} was seen for {seen.mean():.0%} of its time'
    return ''
