"""What an observer's receiver measured: position, speed, support, quality."""

import numpy as np

from waggle_tasks.agents import description
from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import traces as traces_lib

_SLOWEST_PX_S = 0.01  # What the logarithmic plot of speeds shows as rest.
_TOP = 22.0
_REST_PX = 10.0  # Positions are shown at least so far from the anchor.


def draw(
  trace: traces_lib.Trace, end_s: float, told: description.Description
) -> markup.Markup:
  """The panels of one observer, one below the other.

  Args:
    trace: What it saw.
    end_s: Where the time axis ends.
    told: The limits that lines are drawn at.
  """
  offset_px = np.where(
    trace.valid[:, None], trace.centre_px - _anchor_px(trace), np.nan
  )  # (T, 2)
  least_px = max(map(abs, told.place.limits), default=_REST_PX)
  near, far = _range(offset_px, least_px)
  speed = np.where(
    trace.valid, np.maximum(trace.speed_px_s, _SLOWEST_PX_S), np.nan
  )
  fastest = max(10 ** np.ceil(np.log10(np.nanmax(speed, initial=10.0))), 10.0)
  most = 1.15 * trace.support.max(initial=10)

  def panel(
    measure: description.Measure, height: float, low: float, high: float,
    *lines: plot.Curve, logarithmic: bool = False, last: bool = False,
  ) -> markup.Markup:  # fmt: skip
    scale = plot.Scale(low, high, _TOP + height, _TOP, logarithmic)
    limits = None
    if measure.limits:
      limits = plot.Limits(measure.limits, measure.rule)
    return plot.panel(
      measure.name, measure.unit, trace.times_s, lines, scale, end_s, limits,
      last,
    )  # fmt: skip

  return markup.join(
    [
      panel(
        told.place, 130, near, far,
        plot.Curve(offset_px[:, 0], 'a', 'right'),
        plot.Curve(-offset_px[:, 1], 'b', 'up'),
      ),
      panel(
        told.speed, 110, _SLOWEST_PX_S, fastest, plot.Curve(speed, 'a'),
        logarithmic=True,
      ),
      panel(told.support, 60, 0.0, most, plot.Curve(trace.support, 'a')),
      panel(
        told.quality, 60, 0.0, 1.05, plot.Curve(trace.quality, 'a'), last=True
      ),
    ]
  )  # fmt: skip


def width_px(trace: traces_lib.Trace) -> float | None:
  """How wide the target was at first, where that is known."""
  return trace.motions[0].width_px if trace.motions else None


def _anchor_px(trace: traces_lib.Trace) -> np.ndarray:  # (2,)
  """Where the target was first: the anchor of nulls."""
  if not trace.valid.any():
    return trace.centre_px[:1].sum(axis=0)
  if width_px(trace) is not None:
    # Until its first motion, whose way begins at rest, it is known to be near
    # the middle of the picture and no better.
    return trace.motions[0].path_px[0]
  # The frame before the first valid one found the features that it follows.
  return trace.centre_px[max(int(trace.valid.argmax()) - 1, 0)]


def _range(offset_px: np.ndarray, least: float) -> tuple[float, float]:
  """A range with a margin around positions, right and up."""
  values = offset_px * (1.0, -1.0)
  low = min(np.nanmin(values, initial=-1.5 * least), -1.5 * least)
  high = max(np.nanmax(values, initial=1.5 * least), 1.5 * least)
  margin = 0.05 * (high - low)
  return float(low - margin), float(high + margin)
