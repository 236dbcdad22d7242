"""Receivers: images and timestamps in, events out."""

import dataclasses
from typing import ClassVar, Protocol

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import (
  klt,
  liveness,
  recogniser,
  segmenter,
  stillness,
  views,
  watchers,
)
from waggle_tasks.protocol import frame, gestures, payload
from waggle_tasks.protocol.symbols import Symbol


@dataclasses.dataclass(frozen=True)
class Event:
  """Something that a receiver saw.

  Attributes:
    time_s: When it was confirmed.
    symbol: NULL, a motion symbol, or UNKNOWN.
    state: What the frame parser waits for after it.
    recognition: The scores of a motion; None for NULL.
    message: The payload, when the event completes a frame.
    rejection: Why the event broke a frame, when it did.
    view_angle_deg: With a message, where the dance was seen from, see
      `views.View`; None without a bank of views.
    distance_m: The same.
  """

  time_s: float
  symbol: Symbol
  state: frame.State
  recognition: recogniser.Recognition | None = None
  message: payload.Payload | None = None
  rejection: str | None = None
  view_angle_deg: float | None = None
  distance_m: float | None = None


class Receiver(Protocol):
  """What every receiver can do; images and times are all that it gets.

  Attributes:
    track: Where it saw the target in the last image, for people to look at.
    segment: The motion that the last image ended, for the same; or None.
  """

  track: klt.Track | None
  segment: segmenter.Segment | None

  def step(self, image: np.ndarray, time_s: float) -> tuple[Event, ...]:
    """Takes an image, (H, W, 3) uint8 RGB, and returns what it confirms."""
    ...


class StagedReceiver:
  """Watches, recognises, confirms nulls and parses frames."""

  DEFAULT: ClassVar[config_lib.Config]

  def __init__(
    self,
    codebook: gestures.Codebook,
    config: config_lib.Config | None = None,
  ) -> None:
    """Makes a receiver at the beginning of an episode.

    Args:
      codebook: The agreed gestures.
      config: The receiver's numbers; None for its own.
    """
    config = config or self.DEFAULT
    self._watcher = watchers.make(config)
    templates = views.templates(codebook, config.views)
    self._recogniser = recogniser.Recogniser(
      codebook, config.recognition, templates
    )
    self._stillness = stillness.StillnessDetector(
      config.stillness, config.tracking.max_gap_s
    )
    self._liveness = liveness.Liveness(config.stillness.max_repeated)
    self._parser = frame.Parser(rules=config.framing)
    self._where: tuple[float | None, float | None] = None, None
    self.track: klt.Track | None = None
    self.segment: segmenter.Segment | None = None

  def step(self, image: np.ndarray, time_s: float) -> tuple[Event, ...]:
    """Takes one image, which is all that the receiver ever gets.

    Args:
      image: (H, W, 3) uint8 RGB.
      time_s: Its time in seconds.

    Returns:
      The events that this image confirms; mostly none.
    """
    watcher = self._watcher
    self.track, self.segment = watcher.step(image, time_s)
    events = []
    if self.segment is not None:
      recognition = self._recogniser.recognise(self.segment)
      events.append(self._event(time_s, recognition.symbol, recognition))
    self._liveness.step(image)
    if self._stillness.step(self.track, watcher.anchor_px, watcher.moving):
      if self._liveness.lives():
        events.append(self._event(time_s, Symbol.NULL, None))
      else:
        self._stillness.begin()
    return tuple(events)

  def _event(
    self,
    time_s: float,
    symbol: Symbol,
    recognition: recogniser.Recognition | None,
  ) -> Event:
    self._parser, outcome = self._parser.step(symbol)
    message = rejection = None
    where = None, None
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
