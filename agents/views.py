"""Gestures as a camera sees them: paths in pixels by the pinhole model.

Performer and observer hover at one height, and the observer's camera points at
the hovering performer; the viewing angle and the distance are all that is
left. A path that leaves the picture is cut there: what comes back comes back
where it left.
"""

from collections import deque
import dataclasses
import functools
import itertools
import math

import numpy as np

from waggle_tasks.agents import group, viewpoints
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import gestures
from waggle_tasks.protocol.symbols import MOTIONS, Symbol

_LEG_POINTS = 40
_NEAR_M = 0.05
_MOTIONS = 8  # The last ones tell the view; a message of six bits has 8.
# How far, in its logarithm, a size may be from a view's, of which there are
# five in twice the distance; and what a tracker may add to it.
_SAME_SIZE, _SAME_SIZE_PX = 0.25, 2.0
_SIZE, _FRONT = 0.02, 1e-7  # Weights that decide between equal fits.


@dataclasses.dataclass(frozen=True)
class View:
  """Where a dance is seen from.

  Attributes:
    angle_deg: From the performer's nose, positive where its frontal plane's x
      points.
    distance_m: From the camera to the hovering performer.
  """

  angle_deg: float
  distance_m: float


@dataclasses.dataclass(frozen=True, eq=False)
class Templates:
  """Normalised paths with which motions are compared.

  Attributes:
    paths: (4, V, 80, 2) without unit, in the order of `MOTIONS`.
    views: The V views they are seen from; None for the paper's templates,
      which are no pictures.
    spans_px: (4, V) how large they are in the picture; empty without views.
  """

  paths: np.ndarray
  views: tuple[View, ...] | None = None
  spans_px: np.ndarray = dataclasses.field(
    default_factory=lambda: np.empty((4, 0))
  )

  def errors(self, points: np.ndarray) -> np.ndarray:
    """RMSE (4, V) to the normalised path (80, 2)."""
    squares = np.sum((self.paths - points) ** 2, axis=-1)
    return np.sqrt(np.mean(squares, axis=-1))


class Sightings:
  """Tells from motions of known symbols where they are seen from.

  Shapes, and how large motions are beside one another, tell the angle; how
  large all of them are tells the distance.
  """

  def __init__(self, templates: Templates) -> None:
    """Begins without a motion.

    Args:
      templates: The codebook from all views; without views nothing is told.
    """
    self._templates = templates
    self._possible: np.ndarray | bool = True
    self._angles_deg = np.array([v.angle_deg for v in templates.views or ()])
    # For each of the last motions of a message, (V,): its errors, and the
    # log of its size to the view's.
    self._errors: deque[np.ndarray] = deque(maxlen=_MOTIONS)
    self._scales: deque[np.ndarray] = deque(maxlen=_MOTIONS)

  def fitting(
    self, symbol: Symbol, errors: np.ndarray, span_px: float, limit: float
  ) -> np.ndarray:
    """(V,) whether a motion, like all before it, can be seen from each view.

    The agreed gestures have one size, so that of a view must be about the
    motion's; and all motions of a message have one view.

    Args:
      symbol: What it seems to be.
      errors: (4, V) see `Templates.errors`.
      span_px: Its span.
      limit: Errors below this are a view's.
    """
    fits = self._possible & (errors[MOTIONS.index(symbol)] < limit)
    if self._templates.views is not None:
      tolerance = _SAME_SIZE + _SAME_SIZE_PX / span_px
      fits &= np.abs(self._scale(symbol, span_px)) < tolerance
    return fits

  def _scale(self, symbol: Symbol, span_px: float) -> np.ndarray:
    row = MOTIONS.index(symbol)
    return np.log(span_px / self._templates.spans_px[row])

  def add(
    self,
    symbol: Symbol,
    errors: np.ndarray,
    span_px: float,
    fits: np.ndarray,
  ) -> None:
    """Takes a motion.

    Args:
      symbol: What it is.
      errors: (4, V) see `Templates.errors`.
      span_px: Its span.
      fits: (V,) see `fitting`.
    """
    self._possible = fits
    if self._templates.views is not None:
      self._errors.append(errors[MOTIONS.index(symbol)])
      self._scales.append(self._scale(symbol, span_px))

  def view(self) -> View | None:
    """The view that fits all motions best, None when there is none."""
    views = self._templates.views
    if views is None or not self._errors:
      return None
    errors, scales = np.array(self._errors), np.array(self._scales)  # (M, V)
    misfit = np.mean(errors**2, axis=0) + np.var(scales, axis=0)
    scale = np.mean(scales, axis=0)
    # Of distances, which look much alike, the one of the right size; of
    # angles, which START alone does not tell, the front.
    prior = _SIZE * scale**2 + _FRONT * np.abs(self._angles_deg)
    best = int(np.argmin(misfit + prior))
    distance_m = views[best].distance_m / math.exp(scale[best])
    return View(views[best].angle_deg, distance_m)


def templates(
  agreement: agreement_lib.Agreement, config: viewpoints.Views | None
) -> Templates:
  """The codebook from many views, or from the front alone without any."""
  if config is None:
    return frontal(agreement.codebook)
  return bank(agreement.codebook, config, agreement.camera)


@functools.cache
def frontal(codebook: gestures.Codebook) -> Templates:
  """The paper's templates: each gesture seen from the front, once."""
  paths = [gestures.normalise(codebook[s].image_path()) for s in MOTIONS]
  return Templates(np.stack(paths)[:, None])


@functools.cache
def bank(
  codebook: gestures.Codebook,
  config: viewpoints.Views,
  camera: camera_lib.Camera,
) -> Templates:
  """Each gesture seen from all around, by symbol and then by view.

  Raises:
    ReceiverError: if nothing of a gesture is in the picture of a view.
  """
  views = tuple(
    View(float(angle), float(distance))
    for angle in np.linspace(
      -config.max_angle_deg, config.max_angle_deg, config.angles
    )
    for distance in np.geomspace(
      config.min_distance_m, config.max_distance_m, config.distances
    )
  )
  paths_px = [
    [_seen(codebook[symbol], view, camera) for view in views]
    for symbol in MOTIONS
  ]
  return Templates(
    np.array([[gestures.normalise(p) for p in row] for row in paths_px]),
    views,
    np.array([[np.ptp(p, axis=0).max() for p in row] for row in paths_px]),
  )


def _seen(
  gesture: gestures.Gesture, view: View, camera: camera_lib.Camera
) -> np.ndarray:
  """What `project` returns, which must be more than a point."""
  path_px = project(gesture, view, camera)
  if not len(path_px) or not np.ptp(path_px, axis=0).any():
    raise group.ReceiverError(
      f'`focal_px` must be so short that {gesture.symbol} is in the picture'
      f' from {view.distance_m:g} m and {view.angle_deg:g} degrees: got'
      f' {camera.focal_px:g}'
    )
  return path_px


def project(
  gesture: gestures.Gesture, view: View, camera: camera_lib.Camera
) -> np.ndarray:
  """The part of a gesture that is in the picture.

  Args:
    gesture: The gesture.
    view: Where it is seen from.
    camera: What it is seen with.

  Returns:
    (T, 2) pixels from the picture's middle, x right and y down.
  """
  shares = np.linspace(0.0, 1.0, _LEG_POINTS)[:, None]
  corners = np.array(gesture.corners_m)
  x_m, z_m = np.concatenate(
    [a + shares * (b - a) for a, b in itertools.pairwise(corners)]
  ).T
  angle_rad = math.radians(view.angle_deg)
  depth_m = view.distance_m - x_m * math.sin(angle_rad)
  path_px = (
    camera.focal_px
    * np.stack([x_m * math.cos(angle_rad), -z_m], axis=1)
    / np.maximum(depth_m, _NEAR_M)[:, None]
  )
  half_px = np.array([camera.columns, camera.rows]) / 2
  seen = (np.abs(path_px) <= half_px).all(axis=1) & (depth_m > _NEAR_M)
  return path_px[seen]
