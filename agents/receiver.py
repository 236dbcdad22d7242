"""Receivers: images and timestamps in, events out."""

from collections.abc import Mapping
import dataclasses
from typing import Any, ClassVar, Protocol

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import (
  description,
  group,
  inputs,
  klt,
  liveness,
  recogniser,
  segmenter,
  sight,
  stillness,
  views,
  watchers,
)
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import clock as clock_lib
from waggle_tasks.protocol import frame, payload
from waggle_tasks.protocol.symbols import Symbol


@dataclasses.dataclass(frozen=True)
class Event:
  """Something that a receiver saw.

  Attributes:
    time_s: When it was confirmed.
    symbol: NULL, a motion symbol, or UNKNOWN.
    state: What the frame parser waits for after it.
    recognition: The scores of a motion; None for NULL.
    message: What was sent, when the event completes a message.
    rejection: Why the event broke a frame, when it did.
    view_angle_deg: With a message, where the dance was seen from, see
      `views.View`; None without a bank of views.
    distance_m: The same.
    word: With END of a frame that was read as a whole, its symbols.
    clear: How much nearer that is than any other word, 0 to 1.
  """

  time_s: float
  symbol: Symbol
  state: frame.State
  recognition: recogniser.Recognition | None = None
  message: payload.Payload | payload.Data | None = None
  rejection: str | None = None
  view_angle_deg: float | None = None
  distance_m: float | None = None
  word: tuple[int, ...] | None = None
  clear: float | None = None


class Receiver(Protocol):
  """What every receiver can do; images and times are all that it gets.

  What `Class(agreement, config)` makes is at the beginning of an episode. A
  class that has this one as a base needs only `step`.

  Attributes:
    DEFAULT: Its configuration, a frozen dataclass of any kind; None without
      one. `describe` may tell people of its limits, see `receivers.describe`.
    track: Where it saw the target in the last image, for people to look at;
      None where it does not say.
    segment: The motion that the last image ended, for the same; or None.
  """

  DEFAULT: ClassVar[object] = None
  track: klt.Track | None = None
  segment: segmenter.Segment | None = None

  def __init__(
    self, agreement: agreement_lib.Agreement, config: object
  ) -> None:
    """Makes it.

    Args:
      agreement: What both sides know; its camera is the receiver's own.
      config: `DEFAULT`, maybe with some of its numbers changed.
    """

  def step(self, image: np.ndarray, time_s: float) -> tuple[Event, ...]:
    """Takes an image, (H, W, 3) uint8 RGB, and returns what it confirms."""
    ...


def step(
  reader: Receiver, image: np.ndarray, time_s: float
) -> tuple[Event, ...]:
  """Lets a receiver take an image.

  Raises:
    ReceiverError: if it returns something else than events, or shows something
      else than a track and a segment.
  """
  events, name = reader.step(image, time_s), type(reader).__name__
  if not isinstance(events, tuple) or any(type(e) is not Event for e in events):
    raise group.ReceiverError(
      f'`step` of {name} must return a tuple of receiver.Event, mostly an empty'
      f' one: got {events!r} at {time_s:g} s'
    )
  _check(reader, _SHOWN, name, time_s)
  for event in events:
    _check(event, _EVENT, f'an event of {name}', time_s)
  return events


_SHOWN = {
  'track': klt.Track | None,
  'segment': segmenter.Segment | None,
}
_EVENT = {
  'symbol': Symbol,
  'state': frame.State,
  'recognition': recogniser.Recognition | None,
  'message': payload.Payload | payload.Data | None,
}


def _check(
  value: object, kinds: Mapping[str, Any], whose: str, time_s: float
) -> None:
  """Refuses fields that people and files could do nothing with."""
  for field, kind in kinds.items():
    held = getattr(value, field, None)
    if not isinstance(held, kind):
      word = getattr(kind, '__name__', str(kind))
      raise group.ReceiverError(
        f'`{field}` of {whose} must be {word}: got {held!r} at {time_s:g} s'
      )


def _check_language(agreement: agreement_lib.Agreement) -> None:
  """Refuses a language whose frames have no nulls between gestures."""
  if agreement.language is not None:
    raise group.ReceiverError(
      "`language` must be 'paper' for receivers that read one gesture after"
      " another: choose the receiver 'joint', which reads every language"
    )


class StagedReceiver:
  """Watches, recognises, confirms nulls and parses frames."""

  DEFAULT: ClassVar[config_lib.Config]

  def __init__(
    self,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    config: config_lib.Config | None = None,
  ) -> None:
    """Makes a receiver at the beginning of an episode.

    Args:
      agreement: What both sides know.
      config: The receiver's numbers, for the paper's camera; None for its
        own.
    """
    _check_language(agreement)
    config = group.zoomed(config or self.DEFAULT, agreement.camera.zoom)
    clock = agreement.clock if config.framing.clock else None
    least_s = 0.0 if clock is None else clock.least_s
    self._watcher = self._watch(config, least_s, agreement.camera)
    templates = views.templates(agreement, config.views)
    self._recogniser = recogniser.Recogniser(config.recognition, templates)
    blind_s = 0.0
    if clock is not None and config.stillness.bridges:
      blind_s = clock.blind_s
    self._stillness = stillness.StillnessDetector(
      config.stillness, config.tracking.max_gap_s, blind_s
    )
    self._liveness = liveness.Liveness(config.stillness.max_stale_s)
    self._sight = sight.Sight()
    self._parser = frame.Parser(
      units=agreement.units, rules=config.framing, clock=clock
    )
    self._images = inputs.Images()
    self._where: tuple[float | None, float | None] = None, None
    self.track: klt.Track | None = None
    self.segment: segmenter.Segment | None = None

  def _watch(
    self, config: config_lib.Config, least_s: float, camera: camera_lib.Camera
  ) -> watchers.Watcher:
    """What follows the target, see `watchers.make`."""
    return watchers.make(config, least_s, camera)

  @classmethod
  def describe(
    cls,
    agreement: agreement_lib.Agreement,
    config: object,
    width_px: float | None = None,
  ) -> description.Description:
    """The receiver's limits, see `receivers.describe`."""
    if not isinstance(config, config_lib.Config):
      return description.Description()  # Of one's own, around such a receiver.
    config = group.zoomed(config, agreement.camera.zoom)
    return dataclasses.replace(
      description.of(config, width_px),
      templates=lambda: views.templates(agreement, config.views),
    )

  def step(self, image: np.ndarray, time_s: float) -> tuple[Event, ...]:
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
    self._liveness.step(image, time_s)
    return self._follow(image, time_s)

  def _follow(self, image: np.ndarray, time_s: float) -> tuple[Event, ...]:
    """What an image confirms that may be one of this stream."""
    watcher = self._watcher
    track, self.segment = watcher.step(image, time_s)
    self.track = watcher.seen
    if watcher.gave_up:
      self._sight.give_up()
    self._sight.step(track)
    events = []
    if self.segment is not None:
      found = self._recogniser.recognise(self.segment)
      moment = self._sight.event(self.segment.begin_s, self.segment.end_s)
      events.append(self._event(time_s, found.symbol, moment, found))
    if self._stillness.step(
      track, watcher.anchor_px, watcher.moving, watcher.wander
    ):
      if self._may_rest(time_s):
        moment = self._sight.event(self._stillness.since_s, time_s)
        events.append(self._event(time_s, Symbol.NULL, moment))
      else:
        self._stillness.begin()
    return tuple(events)

  def _may_rest(self, time_s: float) -> bool:
    """Whether a rest that was seen may be one, for all that can be known."""
    final = self._parser.state is frame.State.FINAL_NULL
    return not final or self._liveness.lives(time_s)

  def _event(
    self,
    time_s: float,
    symbol: Symbol,
    moment: clock_lib.Moment,
    recognition: recogniser.Recognition | None = None,
  ) -> Event:
    self._parser, outcome = self._parser.step(symbol, moment)
    self._liveness.event(symbol is Symbol.NULL, not self._parser.begun)
    message = rejection = None
    where: tuple[float | None, float | None] = None, None
    if recognition is not None:
      self._where = recognition.view_angle_deg, recognition.distance_m
    if isinstance(outcome, frame.Message):
      message, where = outcome.payload, self._where
    elif isinstance(outcome, frame.Rejection):
      rejection = outcome.reason
    return Event(
      time_s, symbol, self._parser.state, recognition, message, rejection,
      *where,
    )  # fmt: skip


class KltReceiver(StagedReceiver):
  """The paper's receiver."""

  DEFAULT = config_lib.KLT


class KltBankReceiver(StagedReceiver):
  """The paper's tracker, and gestures as they look from every side."""

  DEFAULT = config_lib.KLT_BANK


class AbsoluteReceiver(StagedReceiver):
  """Absolute positions, and gestures as they look from the front."""

  DEFAULT = config_lib.ABSOLUTE


class ViewBankReceiver(StagedReceiver):
  """Absolute positions, and gestures as they look from every side."""

  DEFAULT = config_lib.VIEW_BANK
