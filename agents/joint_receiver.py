"""Reads frames of any language as a whole: the receiver of the link."""

from collections import deque
from collections.abc import Sequence
import dataclasses
import math
from typing import ClassVar

import numpy as np

from waggle_tasks.agents import (
  absolute,
  calibrated,
  description,
  group,
  history,
  inputs,
  joint,
  joint_config,
  joint_description,
  klt,
  lock,
  reading,
  receiver,
  shapes,
  slots,
  soft,
  starts,
  watchers,
)
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import frame, packets, payload
from waggle_tasks.protocol.symbols import Symbol

_USUAL_M = 1.3  # A distance before any is known.
_LATE_S = 0.2  # What a frame may be late.
_NOTICED_S = 10.0  # How late a first motion may be noticed.
_ROUNDS = 3  # Of deciding a word and looking again.


@dataclasses.dataclass(frozen=True)
class Read:
  """What came of a frame: its bits, or a reason."""

  reason: str
  word: tuple[int, ...] = ()
  clear: float = 0.0
  bits: str | None = None
  angle_deg: float | None = None
  distance_m: float = 0.0


@dataclasses.dataclass(frozen=True, eq=False)
class _Open:
  """A frame that has begun: its START, and when it can be read.

  A first time by this clock, and a last one by one that is slow.
  """

  start: lock.Lock
  due_s: float
  last: bool = False


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
    self._seen_with = calibrated.Calibrated(agreement.camera)
    self._tracker: watchers.Tracker = absolute.AbsoluteTracker(
      config.tracking, self._seen_with.bends
    )
    self._images = inputs.Images()
    self._forget()
    self.track: klt.Track | None = None
    self.segment: None = None

  @classmethod
  def describe(
    cls,
    agreement: agreement_lib.Agreement,
    config: joint_config.Config,
    width_px: float | None = None,
  ) -> description.Description:
    """See `receivers.describe`."""
    del width_px  # Nothing is told by the target's width.
    return joint_description.of(agreement, config)

  @property
  def home(self) -> watchers.Home | None:
    """Where the target hovered, for its tracker; None until it has left."""
    return self._tracker.ghost

  def _forget(self) -> None:
    """Begins anew, with another target or another place of it."""
    self._history = history.History()
    self._rests: deque[float] = deque()  # Times before its first motion.
    self._open: list[_Open] = []
    self._starts = starts.Starts(
      self._usual, self._limits, self._history, self._focal_px
    )

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
    return self._follow(image, time_s)

  def _follow(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    """What an image confirms that may be one of this stream."""
    found = self._tracker.step(self._seen_with.part(image), time_s)
    tracks = [self._seen_with.levelled(each) for each in found]
    home, anchor_px = self._tracker.ghost, None
    if home is not None:
      anchor_px = self._seen_with.place(home.anchor_px)
    events = self.follow(tracks, anchor_px, time_s)
    self.track = self._seen_with.seen(found[-1])
    return events

  def follow(
    self,
    tracks: Sequence[klt.Track],
    anchor_px: np.ndarray | None,
    time_s: float,
  ) -> tuple[receiver.Event, ...]:
    """Takes what a tracker makes of an image, and returns what `step` does.

    Args:
      tracks: The target in this image; when it has just left the place where
        it hovered, in all images since its motion began. At least one.
      anchor_px: (2,) where it hovered; None as long as it has not moved.
      time_s: The time of the image.
    """
    self.track = tracks[-1]
    if anchor_px is None:
      if self._history:
        self._forget()
      if self.track.valid:
        self._rests.append(time_s)
      while self._rests and time_s - self._rests[0] > _NOTICED_S:
        self._rests.popleft()
      return ()
    if not self._history:
      moved_s = tracks[0].time_s
      since_s = moved_s - self._limits.start_rest_s
      before = [at for at in self._rests if since_s <= at < moved_s]
      self._history.rest(before, anchor_px)
    for track in tracks:
      self._history.add(track)
    self._history.forget(time_s, 2 * (self._length_s + self._late_s))
    begun = self._starts.step(tracks)
    events = [self._begun(each, time_s) for each in begun]
    return (*events, *self._read(time_s))

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
      rest_s = self._limits.start_rest_s
      reason = reading.unrested(
        each.start, self._history.samples(each.start.begin_s - rest_s),
        self._usual, self._limits,
      )  # fmt: skip
      read = Read(reason) if reason else self._attempt(each.start)
      if read.bits is not None:  # None that began meanwhile is one.
        self._open = [o for o in self._open if o.start.begin_s > time_s]
        return [*events, *self._accept(read, read.bits, time_s)]
      self._open.remove(each)
      if each.last:
        events.append(_rejected(read, time_s))
      else:
        last = _Open(each.start, each.due_s + self._late_s, last=True)
        self._open.append(last)
    return events

  def _attempt(self, start: lock.Lock) -> Read:
    """The bits of a frame that began there, or why there are none."""
    limits = self._limits
    distance_m = self._focal_px / start.scale_px
    shape = shapes.seen(self._alphabet, self._angles_rad, distance_m)
    before_s, after_s = limits.start_rest_s, self._language.confirm_s
    reader = joint.Reader(
      slots.Slots(
        self._history.samples(start.begin_s - before_s),
        shape, start.begin_s, self._count, before_s, after_s,
      ),
      start,
    )  # fmt: skip
    found = reader.judged()
    if found.end_seen < limits.min_seen:
      return Read(f'END was seen for {found.end_seen:.0%} of its time')
    for _ in range(_ROUNDS):
      word, clear = soft.decide(reader, self._blocks, self._alphabet.size)
      if (word == reader.word).all():
        break
      reader.again(word)
    found = reader.judged()
    symbols = tuple(map(int, word))
    if reason := reading.doubt(found, clear, limits):
      return Read(reason, symbols, clear)
    reason, bits = self._agreement.coding.judge(
      symbols, self._agreement.frame_bits, self._alphabet.size
    )
    angle_deg = math.degrees(found.angle_rad)
    distance_m = self._focal_px / found.scale_px
    return Read(reason, symbols, clear, bits, angle_deg, distance_m)

  def _accept(
    self, read: Read, bits: str, time_s: float
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


def _rejected(read: Read, time_s: float) -> receiver.Event:
  return receiver.Event(
    time_s, Symbol.UNKNOWN, frame.State.LEAD_NULL, rejection=read.reason,
    word=read.word or None, clear=read.clear if read.word else None,
  )  # fmt: skip
