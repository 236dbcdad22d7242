"""Receivers that read tracks: all of their stages but the one with pictures."""

from collections.abc import Sequence
import dataclasses
import math
from typing import Any

import numpy as np

from waggle_tasks.agents import (
  calibrated,
  group,
  joint_config,
  joint_receiver,
  receiver,
  receivers,
  track_follower,
  watchers,
)
from waggle_tasks.agents import config as config_lib
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib

READERS = 'absolute', 'view_bank', 'joint'


def place(
  x_px: float = math.nan, y_px: float = math.nan, width_px: float = math.nan
) -> np.ndarray:
  """What a reader of tracks takes for an image, (3,).

  Args:
    x_px: To the right; without numbers the target is not seen.
    y_px: Down.
    width_px: How wide the target is, where that is known.
  """
  return np.array([x_px, y_px, width_px])


class _Order:
  """Checks that places are those of one track."""

  def __init__(self) -> None:
    self._time_s = -math.inf

  def check(self, image: np.ndarray, time_s: float) -> None:
    """Takes a place and its time.

    Raises:
      ReceiverError: if it is none, or its time not a later finite number.
    """
    if not isinstance(image, np.ndarray) or image.shape != (3,):
      raise group.ReceiverError(f'`place` must be an array (3,): got {image!r}')
    if not math.isfinite(time_s) or time_s <= self._time_s:
      raise group.ReceiverError(
        f'`time_s` must be a finite number later than {self._time_s!r}, that'
        f' of the place before: got {time_s!r}'
      )
    self._time_s = time_s


class StagedTracks(receiver.StagedReceiver):
  """Cuts tracks into gestures, names them, and parses frames."""

  def __init__(
    self, agreement: agreement_lib.Agreement, config: config_lib.Config
  ) -> None:
    """See `receiver.StagedReceiver`; of a track nobody knows if it lives."""
    self._zoom, self._order = agreement.camera.zoom, _Order()
    calm = dataclasses.replace(config.stillness, max_stale_s=0.0)
    super().__init__(agreement, dataclasses.replace(config, stillness=calm))

  def _watch(
    self, config: config_lib.Config, least_s: float, camera: camera_lib.Camera
  ) -> watchers.Watcher:
    """What cuts the track."""
    match config.tracking, config.motion:
      case (
        config_lib.Differencing() as tracking,
        config_lib.Excursion() as motion,
      ):
        follower = track_follower.TrackFollower(tracking, self._zoom)
        return watchers.AbsoluteWatcher(
          follower, motion, config.wandering, least_s,
          calibrated.Calibrated(camera),
        )  # fmt: skip
    return watchers.make(config, least_s, camera)

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    """Takes a `place` and its time in seconds.

    Raises:
      ReceiverError: if it is none, or the time not a later one.
    """
    self._order.check(image, time_s)
    return self._follow(image, time_s)


class JointTracks(joint_receiver.JointReceiver):
  """Reads frames as a whole from a track."""

  def __init__(
    self, agreement: agreement_lib.Agreement, config: joint_config.Config
  ) -> None:
    """See `joint_receiver.JointReceiver`."""
    super().__init__(agreement, config)
    zoom, self._order = agreement.camera.zoom, _Order()
    near = group.zoomed(config, zoom)
    self._tracker = track_follower.TrackFollower(near.tracking, zoom)

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    """Takes a `place` and its time in seconds.

    Raises:
      ReceiverError: if it is none, or the time not a later one.
    """
    self._order.check(image, time_s)
    return self._follow(image, time_s)


def make(
  name: str,
  agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
) -> receiver.Receiver:
  """Makes a reader of tracks, whose places are those of a level pinhole.

  Args:
    name: A receiver as `receivers.make` takes it, of those that follow places:
      `READERS`.
    agreement: What both sides know.

  Raises:
    ReceiverError: as `receivers.make` does, and if it follows pixels.
  """
  made, config = receivers.configured(name)
  known = agreement.camera
  pinhole = camera_lib.Camera(known.columns, known.rows, known.focal_px)
  agreement = dataclasses.replace(agreement, camera=pinhole)
  work: Any = None  # A `receiver.Receiver`.
  if made is joint_receiver.JointReceiver:
    if isinstance(config, joint_config.Config):
      work = JointTracks(agreement, config)
  elif made in _staged(READERS) and isinstance(config, config_lib.Config):
    work = StagedTracks(agreement, config)
  if work is not None:
    return work
  raise group.ReceiverError(
    f'`receiver` must be one of {[*READERS]} for tracks, as others follow'
    f' pixels: got {name!r}'
  )


def _staged(names: Sequence[str]) -> list[receivers.Maker]:
  return [receivers.RECEIVERS[name] for name in names]
