"""What an observer's receiver measured: position, speed, support, quality."""

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.experiments import traces as traces_lib
from waggle_tasks.experiments.pages import markup, plot

_SLOWEST_PX_S = 0.01  # What the logarithmic plot of speeds shows as rest.
_TOP = 22.0


def draw(
  trace: traces_lib.Trace, end_s: float, config: config_lib.Config
) -> markup.Markup:
  """The panels of one observer, one below the other.

  Args:
    trace: What it saw.
    end_s: Where the time axis ends.
    config: The limits that lines are drawn at.
  """
  rest, flow = config.stillness, isinstance(config.motion, config_lib.Motion)
  offset_px = np.where(
    trace.valid[:, None], trace.centre_px - anchor_px(trace), np.nan
  )  # (T, 2)
  near, far = _range(offset_px, rest.anchor_px)
  speed = np.where(
    trace.valid, np.maximum(trace.speed_px_s, _SLOWEST_PX_S), np.nan
  )
  fastest = max(10 ** np.ceil(np.log10(np.nanmax(speed, initial=10.0))), 10.0)
  most = 1.15 * trace.support.max(initial=10)

  def panel(
    title: str, unit: str, height: float, low: float, high: float,
    lines: list[plot.Line], limits: plot.Limits | None,
    logarithmic: bool = False, last: bool = False,
  ) -> markup.Markup:  # fmt: skip
    scale = plot.Scale(low, high, _TOP + height, _TOP, logarithmic)
    return plot.panel(
      title, unit, trace.times_s, lines, scale, end_s, limits, last
    )

  return markup.join(
    [
      panel(
        'position', 'px from anchor', 130, near, far,
        [
          plot.Line(offset_px[:, 0], 'a', 'right'),
          plot.Line(-offset_px[:, 1], 'b', 'up'),
        ],
        plot.Limits(
          [-rest.anchor_px, rest.anchor_px],
          f'a null stays within {rest.anchor_px:g} px',
        ),
      ),
      panel(
        'speed', 'px/s, log', 110, _SLOWEST_PX_S, fastest,
        [plot.Line(speed, 'a')],
        _speeds(config.motion), logarithmic=True,
      ),
      panel(
        'support', 'features' if flow else 'pixels', 60, 0.0, most,
        [plot.Line(trace.support, 'a')],
        plot.Limits(
          [config.tracking.min_support],
          f'at least {config.tracking.min_support}',
        ) if flow else None,
      ),
      panel(
        'f-b ratio' if flow else 'quality', '0 to 1', 60, 0.0, 1.05,
        [plot.Line(trace.quality, 'a')],
        plot.Limits(
          [rest.null_quality], f'a null needs {rest.null_quality:g}'
        ),
        last=True,
      ),
    ]
  )  # fmt: skip


def _speeds(motion: config_lib.Motion | config_lib.Excursion) -> plot.Limits:
  """The speeds at which motions begin and end."""
  if isinstance(motion, config_lib.Excursion):
    return plot.Limits(
      [motion.off_px_s], f'motion ends under {motion.off_px_s:g} px/s'
    )
  return plot.Limits(
    [motion.off_px_s, motion.on_px_s],
    f'motion begins over {motion.on_px_s:g} px/s and ends under'
    f' {motion.off_px_s:g} px/s',
  )


def anchor_px(trace: traces_lib.Trace) -> np.ndarray:  # (2,)
  """Where the target was first: the anchor of nulls."""
  if not trace.valid.any():
    return trace.centre_px[:1].sum(axis=0)
  # The frame before the first valid one found the features that it follows.
  return trace.centre_px[max(int(trace.valid.argmax()) - 1, 0)]


def _range(offset_px: np.ndarray, least: float) -> tuple[float, float]:
  """A range with a margin around positions, right and up."""
  values = offset_px * (1.0, -1.0)
  low = min(np.nanmin(values, initial=-1.5 * least), -1.5 * least)
  high = max(np.nanmax(values, initial=1.5 * least), 1.5 * least)
  margin = 0.05 * (high - low)
  return float(low - margin), float(high + margin)
