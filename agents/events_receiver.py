"""Reads dances by an event camera: nothing but changes of brightness.

Images end in its front end, see `event_camera`. Behind it there are events
alone, and a dancer that hovers is not to be seen: events show it for the first
time when it leaves its place. That events tell motion from rest is the idea of
MoCom (Zhang et al. 2025, arXiv:2510.14770), which reads such gestures with an
event camera. Summed by pixel, events are how brightness differs from what it
was before the dance (Scheerlinck et al. 2018, 'Continuous-time Intensity
Estimation Using Event Cameras', ACCV; without its filter, as these events have
no noise of their own). So the target is tracked in pictures of sums, by its
difference from nothing; motions are cut, recognised and parsed as `view_bank`
does in the paper's language, and as `joint` does in all others.
"""

import dataclasses
from typing import ClassVar

import numpy as np

from waggle_tasks.agents import (
  config,
  description,
  event_camera,
  group,
  inputs,
  joint_config,
  joint_receiver,
  klt,
  receiver,
  segmenter,
)
from waggle_tasks.protocol import agreement as agreement_lib

# Of a picture of sums: how bright nothing is, how much an event adds, and how
# many are told apart.
_NOTHING, _LEVELS, _MOST = 128, 12, 10
# A picture of nothing is a scene for whoever sees events.
_SEEN = config.Differencing(min_contrast=0.0)
_WHOLE = joint_config.Config()


@dataclasses.dataclass(frozen=True)
class Config:
  """The receiver's numbers.

  Attributes:
    pixels: How events are made.
    gestures: How they are read in the paper's language...
    frames: ...and in all others.
  """

  pixels: event_camera.Pixels = event_camera.Pixels()
  gestures: config.Config = dataclasses.replace(
    config.VIEW_BANK, tracking=_SEEN
  )
  frames: joint_config.Config = dataclasses.replace(
    _WHOLE, tracking=dataclasses.replace(_WHOLE.tracking, min_contrast=0.0)
  )

  def __post_init__(self) -> None:
    group.check_kinds(self)


class Sums:
  """Events summed by pixel, those of darker ones with a minus.

  Attributes:
    picture: (H, W, 3) uint8, the sums as they are shown to a tracker.
  """

  def __init__(self, shape: tuple[int, ...]) -> None:
    """Begins without an event, for images of a shape (H, W, 3)."""
    self._sums = np.zeros(shape[:2], np.int32)
    self.picture = np.full(shape, _NOTHING, np.uint8)

  def add(self, events: event_camera.Events) -> None:
    """Takes events."""
    where = events.rows, events.columns
    np.add.at(self._sums, where, events.signs)
    shown = np.clip(self._sums[where], -_MOST, _MOST)
    self.picture[where] = (_NOTHING + _LEVELS * shown)[:, None]


class EventsReceiver:
  """Makes events of images, and reads them."""

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
    """
    config = config or self.DEFAULT
    self._camera = event_camera.EventCamera(config.pixels)
    self._images = inputs.Images()
    self._sums: Sums | None = None
    self._reader: receiver.ViewBankReceiver | joint_receiver.JointReceiver = (
      receiver.ViewBankReceiver(agreement, config.gestures)
      if agreement.language is None
      else joint_receiver.JointReceiver(agreement, config.frames)
    )

  @classmethod
  def describe(
    cls,
    agreement: agreement_lib.Agreement,
    config: Config,
    width_px: float | None = None,
  ) -> description.Description:
    """See `receivers.describe`."""
    if agreement.language is None:
      return receiver.ViewBankReceiver.describe(
        agreement, config.gestures, width_px
      )
    return joint_receiver.JointReceiver.describe(
      agreement, config.frames, width_px
    )

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
    """Takes one image, which is all that the receiver ever gets.

    Args:
      image: (H, W, 3) uint8 RGB, of one size in an episode.
      time_s: Its time in seconds, later than that of the image before.

    Returns:
      The events, in the sense of `receiver.Event`, that this image confirms.

    Raises:
      ReceiverError: if the image or its time is of another kind; then nothing
        has changed.
    """
    self._images.check(image, time_s)
    if self._sums is None:
      self._sums = Sums(image.shape)
    self._sums.add(self._camera.step(image, time_s))
    return self._reader.step(self._sums.picture, time_s)
