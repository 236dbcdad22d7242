"""Reads frames of any language as a whole: the receiver of the link."""

from collections import deque
from collections.abc import Sequence
import dataclasses
import math
from typing import ClassVar

import numpy as np

from waggle_tasks.agents import (
  absolute,
  group,
  history,
  inputs,
  joint,
  joint_config,
  klt,
  lock,
  receiver,
  shapes,
  soft,
)
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import frame, packets, payload
from waggle_tasks.protocol.symbols import Symbol

_USUAL_M = 1.3  # A distance before any is known.
_REFINED_S = (0.02, 0.01, 0.005)  # Steps in which the begin of START is told.
_BEST_S = 0.12  # For how long no better START may come.
_LATE_S = 0.2  # What a frame may be late.
_ROUNDS = 3  # Of deciding a word and looking again.


@dataclasses.dataclass(frozen=True)
class _Read:
  """What came of a frame: its bits, or a reason."""

  reason: str
  bits: str | None = None
  word: tuple[int, ...] = ()
  clear: float = 0.0
  angle_deg: float = 0.0
  distance_m: float = 0.0


@dataclasses.dataclass(frozen=True, eq=False)
class _Open:
  """A frame that has begun: its START, and when it can be read."""

  start: lock.Lock
  due_s: float


class JointReceiver:
  """Finds START and reads the whole frame by its clock, as soon as it is over.

  Whatever looks like a START opens a frame, so that one that was none hides no
  other; what is not flown as its language says to the end is dropped.
  """

  DEFAULT: ClassVar[joint_config.Config] = joint_config.Config()

  def __init__(
    self,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    config: joint_config.Config | None = None,
  ) -> None:
    """Makes a receiver at the beginning of an episode.

    Args:
      agreement: What both sides know.
      config: The receiver's numbers, for the paper's camera; None for its own.
    """
    config = group.zoomed(config or self.DEFAULT, agreement.camera.zoom)
    self._limits = config.reading
    self._agreement = agreement
    self._focal_px = agreement.camera.focal_px
    self._language = agreement.spoken
    self._alphabet = self._language.alphabet
    self._blocks = agreement.coding.blocks(
      agreement.frame_bits, self._alphabet.size
    )
    self._count = sum(len(block.places) for block in self._blocks)
    self._angles_rad = np.radians(
      np.linspace(
        -config.reading.max_angle_deg,
        config.reading.max_angle_deg,
        config.reading.angles,
      )
    )
    self._usual = shapes.seen(self._alphabet, self._angles_rad, _USUAL_M)
    self._length_s = (
      self._usual.start_s
      + self._count * self._usual.slot_s
      + self._usual.end_s
      + self._language.confirm_s
    )
    # A clock may be slow, and an image late.
    self._late_s = agreement.tolerance.clock_rate * self._length_s + _LATE_S
    self._collected = packets.Collector(agreement.packets or packets.Packets())
    self._tracker = absolute.AbsoluteTracker(config.tracking)
    self._images = inputs.Images()
    self._forget()
    self.track: klt.Track | None = None
    self.segment: None = None

  def _forget(self) -> None:
    """Begins anew, with another target or another place of it."""
    self._history = history.History()
    self._rests: deque[float] = deque()  # Times before its first motion.
    self._open: list[_Open] = []
    self._best: lock.Lock | None = None  # The best START of late.
    self._after_s = -math.inf  # When the next one may begin.

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    """Takes one image, which is all that the receiver ever gets.

    Args:
      image: (H, W, 3) uint8 RGB, of one size in an episode.
      time_s: Its time in seconds, later than that of the image before.

    Returns:
      The events that this image confirms; mostly none.

    Raises:
      ReceiverError: if the image or its time is of another kind; then nothing
        has changed.
    """
    self._images.check(image, time_s)
    tracks = self._tracker.step(image, time_s)
    self.track = tracks[-1]
    ghost = self._tracker.ghost
    if ghost is None:
      if self._history:
        self._forget()
      if self.track.valid:
        self._rests.append(time_s)
      while self._rests and time_s - self._rests[0] > self._limits.start_rest_s:
        self._rests.popleft()
      return ()
    if not self._history:
      before = [at for at in self._rests if at < tracks[0].time_s]
      self._history.rest(before, ghost.anchor_px)
    for track in tracks:
      self._history.add(track)
    self._history.forget(time_s, 2 * (self._length_s + self._late_s))
    events = [self._begun(found, time_s) for found in self._search(tracks)]
    return (*events, *self._read(time_s))

  def _search(self, tracks: Sequence[klt.Track]) -> list[lock.Lock]:
    """Every START that is over, and was seen best a moment ago."""
    found, shape = [], self._usual
    length_s = shape.alphabet.start.duration_s
    for track in tracks:
      begin_s = track.time_s - length_s
      fitted = self._fit(begin_s)
      if fitted is not None and begin_s > self._after_s:
        best = self._best
        if best is None or fitted.error < best.error:
          self._best = fitted
      if self._best and begin_s - self._best.begin_s > _BEST_S:
        start = self._refined(self._best)
        self._after_s = self._best.begin_s + length_s / 4
        self._best = None
        found.append(start)
    return found

  def _fit(self, begin_s: float) -> lock.Lock | None:
    """A START that began then, if it may have been one."""
    rest_s = self._limits.start_rest_s
    samples = self._history.samples(begin_s - rest_s)
    fitted = lock.fit(samples, self._usual, begin_s, rest_s)
    if fitted is None or fitted.seen < self._limits.min_seen:
      return None
    if fitted.scale_px * self._limits.max_distance_m < self._focal_px:
      return None  # Whoever hovers does not dance in the distance.
    return fitted if fitted.error <= self._limits.max_start else None

  def _refined(self, start: lock.Lock) -> lock.Lock:
    """The same, as exactly as it can be told when it began."""
    for step_s in _REFINED_S:
      moved = [self._fit(start.begin_s + step_s * k) for k in (-2, -1, 1, 2)]
      start = min([start, *filter(None, moved)], key=lambda each: each.error)
    return start

  def _begun(self, start: lock.Lock, time_s: float) -> receiver.Event:
    due_s = start.begin_s + self._length_s
    self._open.append(_Open(start, due_s))
    return receiver.Event(time_s, Symbol.START, frame.State.BIT)

  def _read(self, time_s: float) -> list[receiver.Event]:
    """What comes of the frames that are over."""
    events: list[receiver.Event] = []
    for each in [*self._open]:
      if time_s < each.due_s:
        continue
      read = self._attempt(each.start)
      if read.bits is not None:  # None that began meanwhile is one.
        self._open = [o for o in self._open if o.start.begin_s > time_s]
        return [*events, *self._accept(read, read.bits, time_s)]
      if time_s >= each.due_s + self._late_s:
        self._open.remove(each)
        events.append(_rejected(read.reason, time_s))
    return events

  def _attempt(self, start: lock.Lock) -> _Read:
    """The bits of a frame that began there, or why there are none."""
    distance_m = self._focal_px / start.scale_px
    shape = shapes.seen(self._alphabet, self._angles_rad, distance_m)
    samples = self._history.samples(start.begin_s - self._limits.start_rest_s)
    rest_s = self._language.confirm_s
    reader = joint.Reader(samples, shape, start, self._count, rest_s)
    found, limits = reader.read(), self._limits
    if found.end_seen < limits.min_seen:
      return _Read(f'END was seen for {found.end_seen:.0%} of its time')
    word, clear = soft.decide(found, self._blocks, self._alphabet.size)
    for _ in range(_ROUNDS):
      if (word == found.word).all():
        break
      found = reader.again(word.tolist())
      word, clear = soft.decide(found, self._blocks, self._alphabet.size)
    if found.end > limits.max_end:
      return _Read(
        f'what came for END was none: error {found.end:.2f} > {limits.max_end}'
      )
    # Gestures all end at the hover point: only END tells their end.
    if self._alphabet.states > 1 and found.rest_m > limits.max_rest_m:
      return _Read(
        f'after END it rested {found.rest_m * 1e3:.0f} mm from where it hovers'
      )
    if found.astray > limits.max_astray:
      return _Read(
        f'{found.astray:.0%} of what was seen is where no symbol is flown'
      )
    misfit = found.misfit(word)
    if misfit > limits.max_misfit:
      return _Read(
        f'what came for symbols were none: error {misfit:.2f} >'
        f' {limits.max_misfit}'
      )
    if clear < limits.min_clear:
      return _Read(
        f'two words are as likely: clear {clear:.2f} < {limits.min_clear}'
      )
    symbols = tuple(map(int, word))
    reason, bits = self._agreement.coding.judge(
      symbols, self._agreement.frame_bits, self._alphabet.size
    )
    if bits is None:
      return _Read(reason)
    angle_deg = math.degrees(found.angle_rad)
    return _Read('', bits, symbols, clear, angle_deg, distance_m)

  def _accept(
    self, read: _Read, bits: str, time_s: float
  ) -> list[receiver.Event]:
    """END, and the message when it is whole."""
    end = receiver.Event(
      time_s, Symbol.END, frame.State.FINAL_NULL,
      view_angle_deg=read.angle_deg, distance_m=read.distance_m,
      word=read.word, clear=read.clear,
    )  # fmt: skip
    message = self._whole(bits)
    state = frame.State.START
    return [end, receiver.Event(time_s, Symbol.NULL, state, message=message)]

  def _whole(self, bits: str) -> payload.Payload | payload.Data | None:
    """What a frame says, or with those before it; None for a part."""
    agreed = self._agreement
    if agreed.packets is None:
      return payload.Payload.from_bits(bits, agreed.units)
    self._collected = self._collected.add(bits)
    whole = self._collected.bits
    return None if whole is None else payload.Data(whole)


def _rejected(reason: str, time_s: float) -> receiver.Event:
  return receiver.Event(
    time_s, Symbol.UNKNOWN, frame.State.LEAD_NULL, rejection=reason
  )
