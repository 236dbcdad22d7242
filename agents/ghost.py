"""Finds a target by the ghost that it leaves where it hovered.

A background that was learned while the target hovered holds the target. Once
it has moved away, two places differ from that background: where it is now, and
where it was, which stays as it is. That ghost tells where the target was at
rest, how large it is, and what is behind it.
"""

import dataclasses

import numpy as np

from waggle_tasks.agents import blobs as blobs_lib
from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import difference

# A ghost must not change for so long, or a little longer: what moves may be
# back where it was...
_LAG_S = 0.16
_MAX_CHANGE = 0.2  # ...but for this share.
# A target and its ghost differ from the background about equally.
_MIN_BALANCE = 0.25
# It may be seen in parts, which together are hardly larger than what moves.
_LARGER = 1.2
_MIN_SHARE = 0.1  # Of the largest difference; less is a fragment.
_MARGIN_PX = 3
_MIN_WIDTH_PX = 5


@dataclasses.dataclass(frozen=True, eq=False)
class Ghost:
  """Where a target hovered.

  Attributes:
    anchor_px: (2,) its centre.
    width_px: Its width.
    size_px: (2,) width and height of the difference that it makes.
    extent_px: (2,) how it is spread, see `difference.extent_px`.
    total: The sum of its weights.
    box: Left, top, right and bottom of what it covered.
  """

  anchor_px: np.ndarray
  width_px: float
  size_px: np.ndarray
  extent_px: np.ndarray
  total: float
  box: tuple[int, int, int, int]


class Separation:
  """Watches a target leave its ghost.

  Attributes:
    greys: Times and images, (H, W) uint8, so far; None for no image of it.
    tells: Whether it tells a target from others by its looks.
  """

  def __init__(
    self,
    detector: difference.Detector,
    background: difference.Background,
    config: config_lib.Differencing,
    home: difference.Box,
    near: difference.Box,
  ) -> None:
    """Begins with the first motion.

    Args:
      detector: Weighs differences.
      background: (H, W) with the target in it.
      config: The tracker's numbers.
      home: Where the target hovers...
      near: ...and where it is just after it has left: what changes elsewhere
        is not its doing.
    """
    self._home, self._near = home, near
    self._detector = detector
    self._background = background
    self._config = config
    self.tells = config.most_wider > 0
    self.greys: list[tuple[float, np.ndarray | None]] = []

  def add(self, grey: np.ndarray | None, time_s: float) -> None:
    """Takes an image, (H, W) uint8, or notes that there was none."""
    self.greys.append((time_s, grey))

  def forget(self, keep_s: float) -> None:
    """Drops images that are older than the last one by so much."""
    now_s = self.greys[-1][0]
    self.greys = [each for each in self.greys if now_s - each[0] <= keep_s]

  def find(self) -> Ghost | None:
    """The ghost, once the target has left it in the last image."""
    now_s, grey = self.greys[-1]
    older = [
      each
      for at_s, each in self.greys
      if each is not None and _LAG_S - 1e-6 < now_s - at_s < 2 * _LAG_S + 1e-6
    ]
    if grey is None or not older:
      return None
    known, grey_before = self._background, older[-1]
    before = difference.Background(grey_before, known.variance, known.slack)
    weigh, sigmas = self._detector.weights, self._config.watch_sigmas
    blobs = blobs_lib.Blobs(weigh(grey, self._background, sigmas, wide=True))
    totals = np.where(blobs.inside(self._near), blobs.totals, 0.0)
    changes = blobs.sums(weigh(grey, before, sigmas, spread=2.0, wide=True))
    still = changes < _MAX_CHANGE * totals
    home = still & blobs.inside(self._home)
    most = totals[home].max(initial=0.0) if self.tells else totals.max()
    large = totals > _MIN_SHARE * most
    home, away = (np.flatnonzero(large & each) for each in (home, ~still))
    if not len(home):
      return None
    middle_px = np.array([grey.shape[1], grey.shape[0]]) / 2
    if not self.tells:
      home = blobs.about(home, middle_px)
      return self._left(blobs, home, away, middle_px)
    while len(away):  # The nearest that is like what is missing.
      thing = blobs.about(away, middle_px)
      boxes = blobs.boxes[thing]
      size_px = boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)
      parts = blobs.parts(home, middle_px, _LARGER * size_px)
      if found := self._left(blobs, parts, thing, middle_px):
        return found
      away = np.setdiff1d(away, thing)
    return None

  def _left(
    self,
    blobs: blobs_lib.Blobs,
    home: np.ndarray,
    away: np.ndarray,
    middle_px: np.ndarray,
  ) -> Ghost | None:
    """What some blobs are the ghost of, if others are what has left it."""
    rest, motion = blobs.totals[home].sum(), blobs.totals[away].sum()
    if min(rest, motion) <= _MIN_BALANCE * max(rest, motion):
      return None
    found = self._ghost(blobs.only(home))
    moving = blobs.only(away)
    if not difference.alike(moving, found.extent_px, self._config):
      return None
    # Others hover beside a target: above or below is the wash of its rotors.
    aside_px = abs(found.anchor_px[0] - middle_px[0])
    config, width_px = self._config, found.width_px
    reach_px = max(config.middle_px, config.middle_widths * width_px)
    return found if width_px >= _MIN_WIDTH_PX and aside_px <= reach_px else None

  def _ghost(self, weights: np.ndarray) -> Ghost:
    total, anchor_px = difference.centroid(weights, (0, 0))
    rows, columns = (np.flatnonzero(weights.any(axis=axis)) for axis in (1, 0))
    height, width = weights.shape
    box = (
      max(int(columns[0]) - _MARGIN_PX, 0),
      max(int(rows[0]) - _MARGIN_PX, 0),
      min(int(columns[-1]) + 1 + _MARGIN_PX, width),
      min(int(rows[-1]) + 1 + _MARGIN_PX, height),
    )
    size_px = np.array([np.ptp(columns), np.ptp(rows)]) + 1.0
    width_px = float(size_px[0]) - self._detector.blur_px
    extent_px = difference.extent_px(weights)
    return Ghost(anchor_px, width_px, size_px, extent_px, total, box)
