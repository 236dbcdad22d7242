"""Finds and reads a dancer that may be anywhere in the picture.

`joint` follows what hovers in the middle of the picture. Here a reader of the
middle has others beside it: where something begins to move, a new one is shown
a window of the picture about that place, beginning with the last seconds. The
middle one goes first. Of all who dance elsewhere the one nearest to the middle
is read, and nobody while something stands out in the middle, or something that
looks like the dancer hovers still nearer to it.
"""

from collections import deque
import dataclasses
import math
from typing import ClassVar

import cv2
import numpy as np

from waggle_tasks.agents import (
  company,
  description,
  difference,
  group,
  inputs,
  joint_config,
  joint_receiver,
  klt,
  motions,
  receiver,
  watchers,
)
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import alphabets
from waggle_tasks.protocol import camera as camera_lib

_NEAR = 0.15  # Of its side: so far from a window's middle is no other dancer.
_POINTS = 9  # Of a way, to tell how far it leads.
_ROUND_PX = 64  # About a dance, so that its dancer is in the window whole.


@dataclasses.dataclass(frozen=True)
class Seeking(group.Group):
  """Where a dancer is sought.

  Attributes:
    nearest_m: How near a dancer may be whose whole way is in the window that is
      read about its place.
    kept_s: How much of the past a new reader is shown: a dancer's rest before
      it begins.
    found_s: How long a dancer may take to leave its place.
    most: How many places are read at once.
  """

  nearest_m: float = group.number(0.6, 0.2, 100)
  kept_s: float = group.number(2.5, 0.5, 60)
  found_s: float = group.number(1.5, 0.1, 60)
  most: int = group.number(4, 1, 100)


@dataclasses.dataclass(frozen=True)
class Config:
  """The receiver's numbers.

  Attributes:
    frames: How each dancer is followed and read.
    seeking: Where one is sought.
  """

  frames: joint_config.Config = joint_config.Config()
  seeking: Seeking = Seeking()

  def __post_init__(self) -> None:
    group.check_kinds(self)


class _Window:
  """A part of the picture and its reader."""

  def __init__(
    self,
    agreement: agreement_lib.Agreement,
    config: Config,
    place_px: np.ndarray,
    time_s: float,
  ) -> None:
    """Begins a reader about a place, (2,)."""
    self._side_px = _side_px(agreement, config.seeking.nearest_m)
    self._corner_px = np.rint(place_px - self._side_px / 2).astype(int)
    camera = camera_lib.Camera(
      self._side_px, self._side_px, agreement.camera.focal_px
    )
    agreed = dataclasses.replace(agreement, camera=camera)
    self.reader = joint_receiver.JointReceiver(agreed, config.frames)
    self.since_s = time_s
    self.found = False  # Its dancer has left its place, and counts...
    self.refused = False  # ...or not: somebody hovers nearer to the middle.

  @property
  def home(self) -> watchers.Home | None:
    """See `JointReceiver`, in this window."""
    return self.reader.home

  def holds(self, place_px: np.ndarray) -> bool:
    """Whether a motion at a place, (2,), is that of its dancer."""
    middle_px = self._corner_px + self._side_px / 2
    reach_px = self._side_px * (_NEAR if self.home is None else 0.5)
    return bool(np.abs(place_px - middle_px).max() <= reach_px)

  def step(self, grey: np.ndarray, time_s: float) -> tuple[receiver.Event, ...]:
    """Takes a picture, (H, W) uint8; beyond its edge it goes on as there."""
    left, top = self._corner_px
    columns = np.clip(np.arange(self._side_px) + left, 0, grey.shape[1] - 1)
    rows = np.clip(np.arange(self._side_px) + top, 0, grey.shape[0] - 1)
    part = cv2.cvtColor(grey[rows[:, None], columns], cv2.COLOR_GRAY2RGB)
    return self.reader.step(part, time_s)

  def home_px(self, home: watchers.Home) -> np.ndarray:
    """(2,) where its dancer hovered, in the whole picture."""
    return home.anchor_px + self._corner_px

  def seen(self) -> klt.Track | None:
    """Its track in the whole picture."""
    if (track := self.reader.track) is None:
      return None
    place_px = track.centre_px + self._corner_px
    return dataclasses.replace(track, centre_px=place_px)


class SeekerReceiver:
  """Reads who dances in the middle of the picture, or else elsewhere."""

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
      ReceiverError: if the camera has a lens that bends, or is not level: a
        part of its picture is none of a pinhole.
    """
    camera = agreement.camera
    if not camera.is_plain:
      raise group.ReceiverError(
        "`receiver` 'seeker' must have a level camera without a lens that"
        f' bends: got `pitch_deg` {camera.pitch_deg:g}, `roll_deg`'
        f" {camera.roll_deg:g} and `lens` {camera.lens.model!r}; 'joint' reads"
        ' with any, where the dancer is ahead'
      )
    self._config = config = config or self.DEFAULT
    self._agreement = agreement
    self._images = inputs.Images()
    self._motions = motions.Motions(agreement.camera.zoom)
    self._past: deque[tuple[float, np.ndarray]] = deque()
    self._middle = joint_receiver.JointReceiver(agreement, config.frames)
    self._windows: list[_Window] = []
    self.track: klt.Track | None = None
    self.segment: None = None

  @classmethod
  def describe(
    cls,
    agreement: agreement_lib.Agreement,
    config: Config,
    width_px: float | None = None,
  ) -> description.Description:
    """See `receivers.describe`."""
    return joint_receiver.JointReceiver.describe(
      agreement, config.frames, width_px
    )

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    """See `joint_receiver.JointReceiver.step`."""
    self._images.check(image, time_s)
    events = self._middle.step(image, time_s)
    self.track = None  # Nobody is known before somebody moves.
    grey = difference.grey(image)
    places = self._motions.step(grey, time_s)
    if self._middle.home is not None:
      self.track = self._middle.track
      self._windows = []
      self._past.clear()
      return events
    heard = [
      (each, each.step(grey, time_s))
      for each in self._windows
      if not each.refused
    ]
    self._past.append((time_s, grey))
    kept_s = self._config.seeking.kept_s
    while time_s - self._past[0][0] > kept_s + 1e-6:
      self._past.popleft()
    self._keep(time_s)
    for place_px in places:
      self._seek(place_px, time_s)
    dancers = [each for each in self._windows if each.found]
    if not dancers:
      return events
    nearest = min(dancers, key=self._aside_px)
    self.track = nearest.seen()
    return next((news for each, news in heard if each is nearest), ())

  def _keep(self, time_s: float) -> None:
    """Tells whose dancers count, and drops windows in which nobody dances."""
    for window in self._windows:
      home = window.home
      if home is not None and not (window.found or window.refused):
        window.refused = self._others(window, home)
        window.found = not window.refused
    limit_s = self._config.seeking.found_s
    self._windows = [
      each
      for each in self._windows
      if (
        each.home is not None
        if each.found
        else time_s - each.since_s <= limit_s
      )
    ]

  def _seek(self, place_px: np.ndarray, time_s: float) -> None:
    """Begins a reader about a place where something moves, (2,)."""
    if any(window.holds(place_px) for window in self._windows):
      return
    if len(self._windows) >= self._config.seeking.most:
      return
    window = _Window(self._agreement, self._config, place_px, time_s)
    for at_s, grey in self._past:
      window.step(grey, at_s)
    self._windows.append(window)

  def _aside_px(self, window: _Window) -> float:
    """How far from the middle the dancer of a window hovered."""
    home = window.home
    if home is None:
      return math.inf
    middle_px = np.array(self._agreement.camera.size) / 2
    return math.dist(window.home_px(home), middle_px)

  def _others(self, window: _Window, home: watchers.Home) -> bool:
    """Whether somebody hovers nearer to the middle than its dancer did."""
    picture = company.Rest(
      self._past[0][1], window.home_px(home), home.width_px,
      self._agreement.camera.zoom,
    )  # fmt: skip
    return picture.middle_holds() or picture.alike(
      self._aside_px(window) - home.width_px
    )


def _side_px(agreement: agreement_lib.Agreement, nearest_m: float) -> int:
  """The side of a window that holds a dance, and its dancer's width."""
  ways = agreement.spoken.alphabet.motions
  reach_m = max(np.abs(alphabets.sample(way, _POINTS)).max() for way in ways)
  camera = agreement.camera
  half_px = camera.focal_px * reach_m / nearest_m + _ROUND_PX * camera.zoom
  return min(2 * math.ceil(half_px), max(camera.size)) // 2 * 2
