"""Undoes what happens to a whole picture: a camera that sways, or light.

A background is learned once; a picture in which everything has moved a little,
or become brighter, is brought back to it. A few numbers say how: how its camera
has turned, see `turns`, a gain and an offset, found by least squares, see
`levels`, first in a smaller picture, in which it has moved by less.
"""

import dataclasses

import cv2
import numpy as np

from waggle_tasks.agents import bands, difference, levels, light, turns

_MIN_FIT = 0.5  # Share of pixels that must.
_MIN_RANGE = 8.0  # Grey levels; a reference of fewer tells nothing.
_GAINS = (0.25, 4.0)
_STILL_PX, _STILL_LEVELS = 0.1, 1.0  # Less is left alone...
# ...and what so many median deviations do; a wrong guess costs time alone.
_DEVIATIONS, _GUESS_DEVIATIONS = 20.0, 6.0
_REST_PX = 0.03  # A camera that swayed is at rest within this.
_SMALLER = 4  # Times, in which a camera's jerks are small.


@dataclasses.dataclass(frozen=True)
class Scene:
  """What a picture is of.

  Attributes:
    edges: Which pixels tell of its shifts.
    small: The same of a smaller picture; None where there is no use for one.
    settles: Whether a shift that may be none is none.
    banded: Whether rows, or parts, may be brighter by themselves.
    least: Share of pixels that must fit where it sways: some fit by chance in
      wrong places.
  """

  edges: levels.Edges
  small: levels.Edges | None
  settles: bool
  banded: bool
  least: float


# All but the target, which may move by itself.
ROOM = Scene(
  levels.Edges(16, 160, 24, 8), levels.Edges(4, 40, 24, 8), True, True, 0.75
)
# Of a picture of little else.
TARGET = Scene(levels.Edges(4, 0, 8, 2), None, False, False, _MIN_FIT)


class Alignment:
  """Brings images of one scene to the first of them.

  Attributes:
    tells_shifts: Whether there are enough edges to know where it is.
    moving: Whether the last image had to be shifted...
    sways: ...or any one so far.
  """

  def __init__(
    self, image: np.ndarray, geometry: turns.Geometry, scene: Scene = ROOM
  ) -> None:
    """Begins with the reference.

    Args:
      image: (H, W, 3) uint8 RGB or (H, W) grey.
      geometry: How it may move.
      scene: What it is of.
    """
    self._geometry, self._scene = geometry, scene
    self._nothing = np.array([*np.zeros(geometry.count), 1.0, 0.0])
    self._fit = self._last = self._nothing
    self.sways = self.moving = False
    self.renew(difference.grey(image))

  def renew(self, reference: np.ndarray) -> None:
    """Takes another reference, (H, W) uint8, in the place of the one so far."""
    geometry, scene = self._geometry, self._scene
    self._reference = reference
    soft = difference.soften(self._reference)
    self._level = level = levels.Level(soft, geometry, scene.edges)
    self.tells_shifts = level.tells_shifts
    self._sharp = self._reference[*level.places].astype(float)
    self._index = np.ravel_multi_index(level.places, soft.shape)
    self._small: levels.Level | None = None
    if scene.small is not None and level.tells_shifts:
      small = geometry.smaller(_SMALLER)
      self._small = levels.Level(_smaller(soft), small, scene.small)
    # Deviation of each motion for that of the pixels.
    self._spread = np.linalg.norm(level.inverse[:-2], axis=1)
    self._useful = np.ptp(level.levels) > _MIN_RANGE
    self._bands = bands.Bands(self._reference)

  @property
  def shift_px(self) -> np.ndarray:
    """How far the last image was shifted, (2,) along x and y."""
    return self._fit[:2]

  def step(self, image: np.ndarray) -> np.ndarray | None:
    """Takes an image of the same scene, (H, W, 3) uint8 RGB or (H, W) grey.

    Returns:
      The same where nothing has happened to it as a whole; otherwise (H, W)
      uint8 grey like the reference; None when it is another picture.
    """
    self.moving = False
    if not self._useful:
      return image
    change = self._change(image)
    if (
      self._scene.banded
      and not self.sways
      and levels.scatter(change) >= _STILL_LEVELS
    ):
      image = self._bands.undo(difference.grey(image))
      change = self._change(image)
    if self._fit is self._nothing and self._as_it_was(change):
      return image
    grey = difference.grey(image)
    return self._undo(grey) if self._find(grey) else None

  def _find(self, grey: np.ndarray) -> bool:
    """Finds what happened to an image, (H, W) uint8, of the same scene.

    Returns:
      Whether it is one.
    """
    soft = difference.soften(grey)
    fit, share, scatter = self._level.solve(soft, self._guess(soft))
    least = self._scene.least if self.sways else _MIN_FIT
    if share < least or not _GAINS[0] < fit[-2] < _GAINS[1]:
      self._fit = self._nothing
      return self._same_in_other_light(grey)
    motion_px = np.abs(fit[:-2])
    still_px = self._still_px(_DEVIATIONS * scatter)
    self.sways |= bool((motion_px > still_px).any())
    if (motion_px < (_REST_PX if self.sways else still_px)).all():
      fit[:-2] = 0.0
    change = (fit[-2] - 1) * self._sharp + fit[-1]
    still = not fit[:-2].any() and _little(change)
    self._fit = self._last = self._nothing if still else fit
    return True

  def _same_in_other_light(self, grey: np.ndarray) -> bool:
    """Whether it is the picture of a camera at rest, lit elsewise in parts."""
    if self.sways or not self._scene.banded:
      return False
    evened = light.evened(self._reference, grey)
    if evened is None:
      return False
    soft = difference.soften(evened)
    fit, share, _ = self._level.solve(soft, self._nothing)
    return share >= _MIN_FIT and bool(np.abs(fit[:-2]).max() < _STILL_PX)

  def _guess(self, soft: np.ndarray) -> np.ndarray:
    """About how an image differs, (n,), by a smaller one."""
    if self._small is None:
      return self._last
    start = self._last.copy()
    start[:-2] /= _SMALLER
    guess, share, _ = self._small.solve(_smaller(soft), start)
    if share < _MIN_FIT:
      return self._last
    guess[:-2] *= _SMALLER
    return guess

  def _change(self, image: np.ndarray) -> np.ndarray:
    """What an image has more than the reference, (K,), where pixels tell."""
    in_a_row = image.reshape(1, self._reference.size, *image.shape[2:])
    return difference.grey(in_a_row[:, self._index])[0] - self._sharp

  def _as_it_was(self, change: np.ndarray) -> bool:  # (K,)
    """Whether a first guess, which is quick, finds nothing to undo."""
    scatter = levels.scatter(change)
    limit = levels.outlier(scatter)
    guess = self._level.inverse @ np.clip(change, -limit, limit)
    relit = guess[-2] * self._sharp + guess[-1]
    still_px = self._still_px(_GUESS_DEVIATIONS * scatter)
    still = (np.abs(guess[:-2]) < still_px).all()
    return bool(still and _little(relit))

  def _still_px(self, levels: float) -> np.ndarray:
    """The largest motions that pixels wrong by so many levels may feign."""
    if not self._scene.settles:
      return np.zeros_like(self._spread)
    return np.maximum(_STILL_PX, levels * self._spread)

  def _undo(self, grey: np.ndarray) -> np.ndarray:
    motion, (gain, offset) = self._fit[:-2], self._fit[-2:]
    if gain != 1 or offset:
      levels = (np.arange(256) - offset) / gain
      grey = cv2.LUT(grey, np.clip(np.rint(levels), 0, 255).astype(np.uint8))
    self.moving = bool(motion.any())
    if not self.moving:
      return grey
    return self._geometry.undone(grey, motion, self._reference)


def _smaller(grey: np.ndarray) -> np.ndarray:
  """A picture (H, W) uint8, so many times smaller."""
  size = tuple(length // _SMALLER for length in grey.shape[::-1])
  return difference.soften(cv2.resize(grey, size, interpolation=cv2.INTER_AREA))


def _little(light: np.ndarray) -> bool:  # (K,)
  """Whether a change of light is small, in grey levels."""
  return bool(np.abs(light).mean() < _STILL_LEVELS)
