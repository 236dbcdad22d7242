"""Learns what is behind a target before it has ever moved."""

import dataclasses
import math

import cv2
import numpy as np

from waggle_tasks.agents import (
  alignment,
  difference,
  elapsed,
  ghost,
  learning,
  turns,
)
from waggle_tasks.agents import config as config_lib

_CONTRAST_PX = 96  # Side of the square in which there must be something.
_REST_PX = 128  # Side of the square in which a target rests.
_MIN_PIXELS = 4  # Fewest pixels of a motion.
_MAX_LEFT = 0.1  # Share of a change that a small motion may leave.
_LEFT = 0.5  # The same of one that wanders, and leans meanwhile.
_ALIKE = 0.7  # Correlation of a target with itself, a little moved.


@dataclasses.dataclass(frozen=True, eq=False)
class Departure:
  """A target that has left the place where it hovered.

  Attributes:
    alignment: Brings pictures to the background.
    detector: Weighs differences.
    speckled: Whether pixels are bad for a moment here and there.
    background: (H, W) with the target in it.
    slack_px: How far pictures may be out of place.
    ghost: Where the target was.
    greys: Times and images, (H, W) uint8, since its motion began; None for one
      of something else.
  """

  alignment: alignment.Alignment
  detector: difference.Detector
  speckled: bool
  background: difference.Background
  slack_px: float
  ghost: ghost.Ghost
  greys: list[tuple[float, np.ndarray | None]]


class Hover:
  """Watches a target that rests in the middle until it has left.

  Attributes:
    visible: Whether there is something, at rest, in the last image.
  """

  def __init__(
    self,
    config: config_lib.Differencing,
    geometry: turns.Geometry | None = None,
  ) -> None:
    self._config, self._geometry = config, geometry
    self._slack_px = 0.0
    self._speckled = False
    self._forget()

  def _forget(self) -> None:
    self._alignment: alignment.Alignment | None = None
    self._background: difference.Background | None = None
    self._separation: ghost.Separation | None = None
    self._lost_since_s = math.nan
    self.visible = False

  def step(self, image: np.ndarray, time_s: float) -> Departure | None:
    """Takes an image, (H, W, 3) uint8 RGB, later than the last one."""
    self.visible = False
    image = self._clean(image)
    if self._alignment is None:
      self._begin(image, time_s)
      return None
    aligned = self._alignment.step(image)
    if aligned is None:
      self._lose(time_s)
      return None
    self._lost_since_s = math.nan
    if self._alignment.moving and not self._slack_px:
      self._loosen()
    if self._background is not None:
      scene = self._alignment, self._background
      if self._separation is None:
        return self._watch(*scene, aligned, time_s)
      grey = difference.grey(aligned)
      return self._separate(*scene, self._separation, grey, time_s)
    if not self._learn(difference.grey(aligned), time_s):
      self._begin(self._clean(image), time_s)
    return None

  def _lose(self, time_s: float) -> None:
    """Notes an image of something else; another scene is learned in time."""
    if math.isnan(self._lost_since_s):
      self._lost_since_s = time_s
    if elapsed.lasted(self._lost_since_s, time_s, self._config.forget_s):
      self._forget()
    elif self._separation is not None:
      self._separation.add(None, time_s)

  def _clean(self, image: np.ndarray) -> np.ndarray:
    return difference.despeckled(image) if self._speckled else image

  def _begin(self, image: np.ndarray, time_s: float) -> None:
    """Learns anew, with this image as the first."""
    self._alignment = self._room(image)
    grey = difference.grey(image)
    self._scene = learning.Scene(
      self._config, grey, time_s, difference.middle(grey, _REST_PX),
      difference.middle(grey, self._config.watch_px),
    )  # fmt: skip
    self._scene.first.loosen(self._slack_px)
    self._detector = self._scene.detector
    self._know_target(grey)
    self._wanders = False
    self._since_s = time_s
    smooth = difference.soften(grey[difference.middle(grey, _CONTRAST_PX)])
    self._contrast = bool(np.ptp(smooth) >= self._config.min_contrast)

  def _loosen(self) -> None:
    """Allows everything to be a little out of place from now on."""
    self._slack_px = self._config.slack_px
    for each in filter(None, (self._scene.first, self._background)):
      each.loosen(self._slack_px)

  def _learn(self, grey: np.ndarray, time_s: float) -> bool:
    """Adds an image to the background, unless something has moved."""
    if not self._contrast:
      return False  # A picture of nothing, as a black one, is no scene.
    scene, middle = self._scene, difference.middle(grey, self._config.watch_px)
    scene.look(grey)
    self._detector = scene.detector
    if scene.speckled and not self._speckled:
      self._speckled = True  # Such pictures are another scene.
      return False
    moved = self._moved(grey[middle], scene.first[middle], 2.0)
    if moved and not self._hardly_moved(grey, scene.first, 2.0):
      return False
    self._wanders |= moved
    scene.add(grey, time_s)
    self.visible = True
    if elapsed.lasted(self._since_s, time_s, self._config.learn_s):
      self._background = scene.background
      self._detector = scene.detector
      self._background.loosen(self._slack_px)
      mean = self._background.grey
      self._alignment = self._room(mean)
      if self._wanders:  # Which smears it in the mean.
        box = difference.middle(grey, _REST_PX)
        mean[box] = grey[box]
      self._know_target(mean)
      self._last: np.ndarray | None = None
    return True

  def _watch(
    self,
    aligner: alignment.Alignment,
    background: difference.Background,
    image: np.ndarray,
    time_s: float,
  ) -> Departure | None:
    middle = difference.middle(image, self._config.watch_px)
    if self._last is None or not np.array_equal(image[middle], self._last):
      self._last = image[middle].copy()
      grey = difference.grey(image, middle)
      if self._wanders or self._moved(grey, background[middle], 1.0):
        self._since_s = time_s
        config = self._config.swaying if self._slack_px else self._config
        separation = self._separation = ghost.Separation(
          self._detector, difference.strict(background, _REST_PX), config,
          difference.middle(image, _REST_PX), middle,
        )  # fmt: skip
        whole = difference.grey(image)
        return self._separate(aligner, background, separation, whole, time_s)
    self.visible = True
    return None

  def _change(
    self,
    grey: np.ndarray,
    background: difference.Background,
    spread: float,
    wide: bool = False,
  ) -> np.ndarray:
    """Weights (h, w) of a part's difference from what is behind it."""
    sigmas = self._config.watch_sigmas
    return self._detector.weights(grey, background, sigmas, spread, wide)

  def _moved(
    self, grey: np.ndarray, background: difference.Background, spread: float
  ) -> bool:
    weights = self._change(grey, background, spread, wide=True)
    # In noise every difference is as large as the box that it is summed in.
    box_pixels = self._config.box_px**2 // 2
    least = box_pixels if self._detector.noisy else _MIN_PIXELS
    return cv2.countNonZero(weights) >= least

  def _room(self, image: np.ndarray) -> alignment.Alignment:
    """Brings pictures to this one, whichever way their camera has turned."""
    height, width = image.shape[:2]
    pinhole = turns.Turns((width, height), self._config.focal_px)
    return alignment.Alignment(image, self._geometry or pinhole)

  def _know_target(self, grey: np.ndarray) -> None:
    self._rest = rest = grey[difference.middle(grey, _REST_PX)]
    self._target = alignment.Alignment(rest, turns.Shifts(), alignment.TARGET)

  def _hardly_moved(
    self, grey: np.ndarray, background: difference.Background, spread: float
  ) -> bool:
    """Whether what has moved is the target, and hardly.

    Then undoing its motion undoes the change; what is behind a target may tell
    where it is too, but does not go with it.
    """
    box, target = difference.middle(grey, _REST_PX), self._target
    here, behind = grey[box], background[box]
    if not self._slack_px:
      undone = target.step(here)
      near = np.abs(target.shift_px).max() <= self._config.rest_px
      if undone is not None and target.tells_shifts and near:
        change = self._change(here, behind, spread).sum()
        left = self._change(undone, self._loose(behind), spread).sum()
        if left <= _MAX_LEFT * change:
          return True
    return self._wandered(here, behind, spread)

  def _loose(self, behind: difference.Background) -> difference.Background:
    """What is behind a target that may be a little out of place."""
    loose = difference.Background(behind.grey, behind.variance)
    loose.loosen(self._config.slack_px)
    return loose

  def _wandered(
    self, here: np.ndarray, behind: difference.Background, spread: float
  ) -> bool:
    """Whether the target is as it was, a little aside.

    It may lean a little more or less, so that more of the change is left. Where
    the room moves too, no more can be asked than that it is there.
    """
    far_px = math.ceil(self._config.rest_px)
    middle = slice(far_px, -far_px)
    inside = middle, middle
    match = cv2.matchTemplate(here, self._rest[inside], cv2.TM_CCOEFF_NORMED)
    _, alike, _, (left, top) = cv2.minMaxLoc(match)
    if self._slack_px:
      return alike >= _ALIKE
    if not (0 < left < 2 * far_px and 0 < top < 2 * far_px):
      return False
    height, width = here.shape
    moved = here[
      top : top + height - 2 * far_px, left : left + width - 2 * far_px
    ]
    known = self._loose(behind)[inside]
    change = self._change(here[inside], known, spread).sum()
    return bool(self._change(moved, known, spread).sum() <= _LEFT * change)

  def _separate(
    self,
    aligner: alignment.Alignment,
    background: difference.Background,
    separation: ghost.Separation,
    grey: np.ndarray,
    time_s: float,
  ) -> Departure | None:
    moved = self._moved(grey, background, 1.0)
    resting = not moved or self._hardly_moved(grey, background, 1.0)
    separation.add(grey, time_s)
    self.visible = resting
    if resting:
      self._since_s = time_s
      self._wanders |= moved
      separation.forget(self._config.separate_s)
      if not self._wanders:
        self._separation = None
        return None
    # Who is told by its looks may be gone, whatever the room looks like.
    if (separation.tells or not resting) and (found := separation.find()):
      return Departure(
        aligner, self._detector, self._speckled, background,
        self._slack_px, found, separation.greys,
      )  # fmt: skip
    if not resting and elapsed.lasted(
      self._since_s, time_s, self._config.separate_s
    ):
      self._forget()
    return None
