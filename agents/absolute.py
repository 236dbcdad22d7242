"""Tells where a target is, in every image on its own: nothing adds up."""

import math

import cv2
import numpy as np

from waggle_tasks.agents import blobs as blobs_lib
from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import difference, hover, klt, pace, parallax, turns
from waggle_tasks.agents import ghost as ghost_lib

_REPAIRS = 25  # Images that the background behind the hover is made from.
# A target that is sought in the whole picture must be this much of itself.
_MIN_SHARE, _MAX_SHARE = 0.3, 3.0
_MOST_SIDE = 2.0  # Its sides are at most so many times longer or shorter.
_PART_SHARE = 0.05  # Less of a target is no other one.
_COVERED = 0.5  # Of a gate: what changes so much of it hides the target.


class AbsoluteTracker:
  """Follows one target that begins near the middle of the image.

  While it hovers its position is not known, only that it has not moved; once
  it has left its ghost, the images since then are looked at again.

  Attributes:
    ghost: Where it hovered; None as long as it has not moved.
  """

  def __init__(
    self,
    config: config_lib.Differencing,
    geometry: turns.Geometry | None = None,
  ) -> None:
    """Makes the tracker.

    Args:
      config: Its numbers.
      geometry: How pictures move when their camera turns; None for that of a
        pinhole.
    """
    self._config, self._geometry = config, geometry
    self._hover = hover.Hover(config, geometry)
    self._follower: Follower | None = None
    self.ghost: ghost_lib.Ghost | None = None
    self.anchor_px: np.ndarray | None = None

  def step(self, image: np.ndarray, time_s: float) -> list[klt.Track]:
    """Takes one image.

    Args:
      image: (H, W, 3) uint8 RGB; it is not kept.
      time_s: Its time, later than the last one's.

    Returns:
      The target in this image; when it has just left its ghost, in all images
      since its motion began, of which this is the last.
    """
    if self._follower is None:
      return self._wait(image, time_s)
    track = self._follower.step(image, time_s)
    if self._follower.lost_s(time_s) > self._config.relearn_s:
      self._hover = hover.Hover(self._config, self._geometry)
      self._follower = None
      self.ghost = self.anchor_px = None
    return [track]

  def _wait(self, image: np.ndarray, time_s: float) -> list[klt.Track]:
    departure = self._hover.step(image, time_s)
    if departure is not None:
      self.ghost = departure.ghost
      self.anchor_px = departure.ghost.anchor_px
      follower = self._follower = Follower(self._config, departure)
      return [
        follower.lose(at) if grey is None else follower.follow(grey, at)
        for at, grey in departure.greys
      ]
    # Somewhere in the middle: all that is known before it moves.
    middle_px = np.array([image.shape[1], image.shape[0]]) / 2
    visible = self._hover.visible
    self.anchor_px = middle_px if visible else None
    return [klt.Track(time_s, middle_px, 0.0, 0, float(visible), visible)]


class Follower:
  """Follows a target whose background is known."""

  def __init__(
    self, config: config_lib.Differencing, departure: hover.Departure
  ) -> None:
    """Begins where the target hovered.

    Args:
      config: The tracker's numbers.
      departure: The target and what is behind it; its background is repaired
        where the target was.
    """
    self._config = config
    self._alignment = departure.alignment
    self._detector = departure.detector
    self._speckled = departure.speckled
    self._background = departure.background
    height, width = departure.background.grey.shape
    self._size = width, height
    self._ghost = departure.ghost
    left, top, right, bottom = departure.ghost.box
    self._home = slice(top, bottom), slice(left, right)
    # It has left in the last one, which is there.
    last = next(each for _, each in departure.greys[::-1] if each is not None)
    self._behind = last[self._home].astype(np.float32)
    self._background.grey[self._home] = last[self._home]
    self._background.loosen(departure.slack_px)
    self._repairs = 1
    self._centre_px = departure.ghost.anchor_px
    noisy = self._detector.noise > config.speed_noise
    more = 1 + noisy + (departure.slack_px > 0)
    self._pace = pace.Pace(config.speed_s * more)
    self._seen_s = math.inf
    self._parallax = parallax.Parallax(config)

  def lost_s(self, time_s: float) -> float:
    """For how long the target has not been seen."""
    return max(time_s - self._seen_s, 0.0)

  def step(self, image: np.ndarray, time_s: float) -> klt.Track:
    """Takes an image, (H, W, 3) uint8 RGB."""
    if self._speckled:
      image = difference.despeckled(image)
    aligned = self._alignment.step(image)
    if aligned is None:
      return self.lose(time_s, outside=self._at_edge())
    if self._alignment.moving and self._background.slack is None:
      self._background.loosen(self._config.slack_px)
    return self.follow(aligned, time_s)

  def follow(self, image: np.ndarray, time_s: float) -> klt.Track:
    """Takes an aligned image, (H, W, 3) uint8 RGB or (H, W) uint8 grey."""
    gate, config = self._gate(), self._config
    weights = self._weights(image, gate, config.box_sigmas)
    weights = self._mine(weights, gate)
    total, centre_px = difference.centroid(
      weights, (gate[1].start, gate[0].start)
    )
    share = total / self._ghost.total
    outside = self._at_edge()
    support = cv2.countNonZero(weights)
    if support > _COVERED * weights.size:
      return self.lose(time_s, outside=outside)
    if not (
      config.lost_share <= share <= config.most_share
      and difference.alike(weights, self._ghost.extent_px, config)
    ):
      found = None if outside else self._search(image)
      if found is None:
        return self.lose(time_s, min(share, 1.0), outside)
      share, centre_px = found
    self._repair(image, gate)
    if self._alignment.sways:
      self._renew(image, gate, time_s)
    self._centre_px, self._seen_s = centre_px, time_s
    speed_px_s = self._pace.step((time_s, *centre_px))
    return klt.Track(
      time_s, centre_px, speed_px_s, support, min(share, 1.0), True,
      width_px=self._ghost.width_px,
    )  # fmt: skip

  def lose(
    self, time_s: float, quality: float = 0.0, outside: bool = False
  ) -> klt.Track:
    """Notes an image in which it is not seen.

    Args:
      time_s: Its time.
      quality: What share of it was seen.
      outside: Whether it may be out of the picture.
    """
    self._pace.forget()
    return klt.Track(time_s, self._centre_px, 0.0, 0, quality, False, outside)

  def _gate(self) -> tuple[slice, slice]:
    """The square in which the target must be."""
    config, (width, height) = self._config, self._size
    half_px = config.gate_widths * self._ghost.width_px + config.gate_px
    x, y = self._centre_px
    return (
      slice(max(int(y - half_px), 0), min(int(y + half_px) + 1, height)),
      slice(max(int(x - half_px), 0), min(int(x + half_px) + 1, width)),
    )

  def _at_edge(self) -> bool:
    """Whether the target was last seen where it may leave the picture."""
    reach_px = self._ghost.width_px / 2 + self._config.gate_px
    inside_px = np.minimum(self._centre_px, self._size - self._centre_px)
    return bool(inside_px.min() < reach_px)

  def _weights(
    self,
    image: np.ndarray,
    box: tuple[slice, slice],
    sigmas: float,
    wide: bool = False,
  ) -> np.ndarray:
    return self._detector.weights(
      difference.grey(image, box), self._background[box], sigmas, wide=wide
    )

  def _mine(self, weights: np.ndarray, gate: tuple[slice, slice]) -> np.ndarray:
    """Weights of the target without those of another that comes near it."""
    edges = weights[0], weights[-1], weights[:, 0], weights[:, -1]
    if not any(edge.any() for edge in edges):
      return weights  # The target alone is well inside.
    blobs = blobs_lib.Blobs(weights)
    (large,) = np.nonzero(blobs.totals > _PART_SHARE * self._ghost.total)
    if len(large) < 2:
      return weights
    place_px = self._centre_px - (gate[1].start, gate[0].start)
    return blobs.only(blobs.about(large, place_px))

  def _search(self, image: np.ndarray) -> tuple[float, np.ndarray] | None:
    """Finds the target anywhere: its share and centre, if there is just one."""
    whole = slice(0, self._size[1]), slice(0, self._size[0])
    weights = self._weights(image, whole, self._config.watch_sigmas, wide=True)
    blobs = blobs_lib.Blobs(weights)
    shares = blobs.totals / self._ghost.total
    fits = (shares > _MIN_SHARE) & (shares < _MAX_SHARE)
    sides = (blobs.boxes[:, 2:] - blobs.boxes[:, :2]) / self._ghost.size_px
    sides = np.maximum(sides, 1e-9)  # Some are of nothing.
    fits &= (np.abs(np.log2(sides)) < np.log2(_MOST_SIDE)).all(axis=1)
    (picked,) = np.nonzero(fits)
    if len(picked) != 1:
      return None
    _, centre_px = difference.centroid(blobs.only(picked), (0, 0))
    reach_px = self._config.reach_widths * self._ghost.width_px
    if reach_px and math.dist(centre_px, self._ghost.anchor_px) > reach_px:
      return None
    return float(shares[picked[0]]), centre_px

  def _repair(self, image: np.ndarray, gate: tuple[slice, slice]) -> None:
    """Averages what is behind the hovering target while it is away."""
    apart = any(
      a.stop <= b.start or b.stop <= a.start
      for a, b in zip(gate, self._home, strict=True)
    )
    if self._detector.noisy and self._repairs < _REPAIRS and apart:
      self._behind += difference.grey(image, self._home)
      self._repairs += 1
      self._background.grey[self._home] = np.rint(self._behind / self._repairs)

  def _renew(
    self, image: np.ndarray, gate: tuple[slice, slice], time_s: float
  ) -> None:
    """Follows what is behind the target while its camera moves aside."""
    grey, known = difference.grey(image), self._background
    if self._parallax.step(grey, gate, time_s, known):
      known.variance = self._detector.background(known.grey).variance
      self._alignment.renew(known.grey)
