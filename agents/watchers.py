"""A tracker and the segmenter that goes with it: images in, motions out."""

from typing import Protocol

import numpy as np

from waggle_tasks.agents import (
  absolute,
  calibrated,
  excursion,
  group,
  klt,
  segmenter,
  wander,
  wandering,
)
from waggle_tasks.agents import config as config_lib
from waggle_tasks.protocol import camera as camera_lib


class Watcher(Protocol):
  """Follows the target and cuts its track into motions.

  Attributes:
    gave_up: Whether it has just given up the target, to seek one anew.
    seen: The target in the last image, in its own pixels.
  """

  gave_up: bool
  seen: klt.Track | None

  @property
  def anchor_px(self) -> np.ndarray | None:
    """(2,) where the target was first, or None."""
    ...

  @property
  def moving(self) -> bool:
    """Whether a motion is under way."""
    ...

  @property
  def wander(self) -> wander.Wander | None:
    """How the target wanders while it rests, where that is known."""
    ...

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[klt.Track, segmenter.Segment | None]:
    """Takes an image; the target in it, and the motion that it ended.

    Both as a level pinhole would see them.
    """
    ...


class FlowWatcher:
  """The paper's: sums of displacements, cut by speed."""

  gave_up = False  # It stays where it lost the target.

  def __init__(
    self,
    tracking: config_lib.Tracking,
    motion: config_lib.Motion,
    seen_with: calibrated.Calibrated,
  ) -> None:
    self.seen: klt.Track | None = None
    self._seen_with = seen_with
    self._tracker = klt.KltTracker(tracking)
    self._segmenter = segmenter.Segmenter(motion, tracking)

  @property
  def anchor_px(self) -> np.ndarray | None:
    """See `Watcher`."""
    anchor_px = self._tracker.anchor_px
    return None if anchor_px is None else self._seen_with.place(anchor_px)

  @property
  def moving(self) -> bool:
    """See `Watcher`."""
    return self._segmenter.active

  @property
  def wander(self) -> None:
    """See `Watcher`."""

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[klt.Track, segmenter.Segment | None]:
    """See `Watcher`."""
    found = self._tracker.step(self._seen_with.part(image), time_s)
    self.seen = self._seen_with.seen(found)
    track = self._seen_with.levelled(found)
    return track, self._segmenter.step(track)


class Home(Protocol):
  """Where a target rested before it moved."""

  @property
  def anchor_px(self) -> np.ndarray:
    """(2,) its centre."""
    ...

  @property
  def width_px(self) -> float:
    """Its width."""
    ...


class Tracker(Protocol):
  """Tells where a target is, once it is known where it rested."""

  @property
  def ghost(self) -> Home | None:
    """Where it rested; None as long as that is not known."""
    ...

  @property
  def anchor_px(self) -> np.ndarray | None:
    """(2,) where it rests, or None."""
    ...

  def step(self, image: np.ndarray, time_s: float) -> list[klt.Track]:
    """Takes an image; see `absolute.AbsoluteTracker`."""
    ...


class AbsoluteWatcher:
  """Absolute positions, cut where the target leaves its rest and returns."""

  def __init__(
    self,
    tracker: Tracker,
    motion: config_lib.Excursion,
    wanders: wandering.Wandering,
    least_s: float,
    seen_with: calibrated.Calibrated,
  ) -> None:
    self.seen: klt.Track | None = None
    self._seen_with, self._tracker = seen_with, tracker
    self._motion, self._wanders, self._least_s = motion, wanders, least_s
    self._segmenter: excursion.ExcursionSegmenter | None = None
    self.gave_up = False

  @property
  def anchor_px(self) -> np.ndarray | None:
    """See `Watcher`."""
    anchor_px = self._tracker.anchor_px
    return None if anchor_px is None else self._seen_with.place(anchor_px)

  @property
  def moving(self) -> bool:
    """See `Watcher`; a rest counts from where it began."""
    cut = self._segmenter
    return cut is not None and cut.active and not cut.returned

  @property
  def wander(self) -> wander.Wander | None:
    """See `Watcher`."""
    return None if self._segmenter is None else self._segmenter.wander

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[klt.Track, segmenter.Segment | None]:
    """See `Watcher`."""
    found = self._tracker.step(self._seen_with.part(image), time_s)
    self.seen = self._seen_with.seen(found[-1])
    tracks = [self._seen_with.levelled(each) for each in found]
    ghost = self._tracker.ghost
    self.gave_up = ghost is None and self._segmenter is not None
    if ghost is None:
      self._segmenter = None
      return tracks[-1], None
    if self._segmenter is None:
      self._segmenter = excursion.ExcursionSegmenter(
        self._motion,
        self._seen_with.place(ghost.anchor_px),
        self._seen_with.scale(ghost.anchor_px) * ghost.width_px,
        self._wanders,
        self._least_s,
      )
      self._segmenter.wander.prime(tracks, self._motion.lead_s)
    segments = [self._segmenter.step(track) for track in tracks]
    return tracks[-1], next(filter(None, segments), None)


def make(
  config: config_lib.Config,
  least_s: float = 0.0,
  camera: camera_lib.Camera = camera_lib.Camera(),
) -> Watcher:
  """The watcher of a configuration.

  Args:
    config: The receiver's numbers.
    least_s: See `excursion.ExcursionSegmenter`.
    camera: What images come from.

  Raises:
    ReceiverError: if its tracker and its segmenter do not go together.
  """
  seen_with = calibrated.Calibrated(camera)
  match config.tracking, config.motion:
    case (
      config_lib.Differencing() as tracking,
      config_lib.Excursion() as motion,
    ):
      return AbsoluteWatcher(
        absolute.AbsoluteTracker(tracking, seen_with.bends),
        motion, config.wandering, least_s, seen_with,
      )  # fmt: skip
    case config_lib.Tracking() as tracking, config_lib.Motion() as motion:
      return FlowWatcher(tracking, motion, seen_with)
  raise group.ReceiverError(
    '`motion` must be an Excursion with Differencing, and a Motion with'
    f' Tracking: got {config.motion!r}'
  )
