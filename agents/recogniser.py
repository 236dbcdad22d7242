"""Matches a path with the gestures: a symbol, or UNKNOWN with its reason.

Paper, section 'RGB optical flow and trajectory recognition'.
"""

import dataclasses

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import segmenter
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
  """

  symbol: Symbol
  reason: str = ''
  best: Symbol = Symbol.UNKNOWN
  rmse: float = 0.0
  margin: float = 0.0
  closure: float = 0.0
  span_px: float = 0.0


class Recogniser:
  """Compares paths with the templates of a codebook seen from the front."""

  def __init__(
    self, codebook: gestures.Codebook, config: config_lib.Recognition
  ) -> None:
    self._config = config
    self._templates = {
      symbol: gestures.normalise(codebook[symbol].image_path())
      for symbol in MOTIONS
    }

  def recognise(self, segment: segmenter.Segment) -> Recognition:
    """Names the gesture of a segment, or says why it has none."""
    path_px = segment.path_px
    span_px = float(np.ptp(path_px, axis=0).max())
    if segment.loss:
      reason = f'track lost: {segment.loss}'
      return Recognition(Symbol.UNKNOWN, reason, span_px=span_px)
    if span_px < self._config.min_span_px:
      reason = f'span {span_px:.1f} px < {self._config.min_span_px:g} px'
      return Recognition(Symbol.UNKNOWN, reason, span_px=span_px)
    points = gestures.normalise(path_px)
    ranked = sorted(
      (gestures.separation(points, template), symbol)
      for symbol, template in self._templates.items()
    )
    (rmse, best), (second, _) = ranked[:2]
    closure = float(np.hypot(*(path_px[-1] - path_px[0]))) / span_px
    reason = self._reason(rmse, second - rmse, closure)
    return Recognition(
      Symbol.UNKNOWN if reason else best,
      reason,
      best,
      rmse,
      second - rmse,
      closure,
      span_px,
    )

  def _reason(self, rmse: float, margin: float, closure: float) -> str:
    config = self._config
    if rmse >= config.max_rmse:
      return f'RMSE {rmse:.4f} >= {config.max_rmse:g}'
    if margin <= config.min_margin:
      return f'margin {margin:.4f} <= {config.min_margin:g}'
    if closure >= config.max_closure:
      return f'closure {closure:.4f} >= {config.max_closure:g}'
    return ''
