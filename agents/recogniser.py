"""Matches a path with the gestures: a symbol, or UNKNOWN with its reason.

Paper, section 'RGB optical flow and trajectory recognition'.
"""

import dataclasses

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import segmenter, views
from waggle_tasks.protocol import gestures
from waggle_tasks.protocol.symbols import MOTIONS, Symbol


@dataclasses.dataclass(frozen=True)
class Recognition:
  """What a motion was taken for.

  Attributes:
    symbol: A motion symbol, or UNKNOWN.
    reason: Why it is UNKNOWN; empty otherwise.
    best: The nearest gesture, whether accepted or not.
    rmse: Its error, in spans.
    margin: How much larger the second best's error is.
    closure: Distance from end to beginning, in spans.
    span_px: Largest side of the path's bounding box.
    view_angle_deg: Where it is seen from, by all motions since START, see
      `views.View`; None for UNKNOWN, and without a bank of views.
    distance_m: The same.
  """

  symbol: Symbol
  reason: str = ''
  best: Symbol = Symbol.UNKNOWN
  rmse: float = 0.0
  margin: float = 0.0
  closure: float = 0.0
  span_px: float = 0.0
  view_angle_deg: float | None = None
  distance_m: float | None = None


class Recogniser:
  """Compares paths with templates of a codebook."""

  def __init__(
    self, config: config_lib.RecognitionLimits, templates: views.Templates
  ) -> None:
    """Makes a recogniser.

    Args:
      config: The limits.
      templates: What to compare with.
    """
    self._config = config
    self._templates = templates
    self._sightings = views.Sightings(self._templates)

  def recognise(self, segment: segmenter.Segment) -> Recognition:
    """Names the gesture of a segment, or says why it has none."""
    path_px = segment.path_px
    span_px = float(np.ptp(path_px, axis=0).max())
    if segment.loss:
      reason = f'track lost: {segment.loss}'
      return Recognition(Symbol.UNKNOWN, reason, span_px=span_px)
    if reason := self._small(span_px, segment.width_px):
      return Recognition(Symbol.UNKNOWN, reason, span_px=span_px)
    errors = self._templates.errors(gestures.normalise(path_px))  # (4, V)
    ranked = sorted(zip(errors.min(axis=1).tolist(), MOTIONS, strict=True))
    (rmse, best), (second, _) = ranked[:2]
    closure = float(np.hypot(*(path_px[-1] - path_px[0]))) / span_px
    reason = self._reason(rmse, second - rmse, closure)
    if best is Symbol.START:  # A new message, maybe of someone else.
      self._sightings = views.Sightings(self._templates)
    where: tuple[float | None, float | None] = None, None
    if not reason:
      where, reason = self._locate(best, errors, span_px)
    return Recognition(
      Symbol.UNKNOWN if reason else best,
      reason,
      best,
      rmse,
      second - rmse,
      closure,
      span_px,
      *where,
    )

  def _locate(
    self, symbol: Symbol, errors: np.ndarray, span_px: float
  ) -> tuple[tuple[float | None, float | None], str]:
    """Angle and distance, or why a motion does not belong to those before."""
    seen, limit = self._sightings, self._config.max_rmse
    fits = seen.fitting(symbol, errors, span_px, limit)
    if not fits.any():
      reason = f'no view of {symbol} fits its size and the motions before'
      return (None, None), reason
    seen.add(symbol, errors, span_px, fits)
    view = seen.view()
    if view is None:
      return (None, None), ''
    return (view.angle_deg, view.distance_m), ''

  def _small(self, span_px: float, width_px: float | None) -> str:
    config = self._config
    if span_px >= config.least_span_px(width_px):
      return ''
    rule = f'{config.min_span_px:g} px'
    if width_px is not None:
      rule = f'{config.min_span_widths:g} widths of {width_px:.1f} px'
    return f'span {span_px:.1f} px < {rule}'

  def _reason(self, rmse: float, margin: float, closure: float) -> str:
    config = self._config
    if rmse >= config.max_rmse:
      return f'RMSE {rmse:.4f} >= {config.max_rmse:g}'
    if margin <= config.min_margin:
      return f'margin {margin:.4f} <= {config.min_margin:g}'
    if closure >= config.max_closure:
      return f'closure {closure:.4f} >= {config.max_closure:g}'
    return ''
