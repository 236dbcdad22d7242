"""What an observer's receiver measured: position, speed, support, quality."""

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.experiments import traces as traces_lib
from waggle_tasks.experiments.pages import markup, plot

_SLOWEST_PX_S = 0.01  # What the logarithmic plot of speeds shows as rest.
_TOP = 22.0

_Tracking = config_lib.Tracking | config_lib.Differencing


def draw(
  trace: traces_lib.Trace, end_s: float, config: config_lib.Config
) -> markup.Markup:
  """The panels of one observer, one below the other.

  Args:
    trace: What it saw.
    end_s: Where the time axis ends.
    config: The limits that lines are drawn at.
  """
  offset_px = np.where(
    trace.valid[:, None], trace.centre_px - _anchor_px(trace), np.nan
  )  # (T, 2)
  near, far = _range(offset_px, config.stillness.anchor_px)
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
        _places(config, _width_px(trace)),
      ),
      panel(
        'speed', 'px/s, log', 110, _SLOWEST_PX_S, fastest,
        [plot.Line(speed, 'a')],
        _speeds(config.motion, _width_px(trace)), logarithmic=True,
      ),
      panel(
        'support', _support_unit(config.tracking), 60, 0.0, most,
        [plot.Line(trace.support, 'a')], _supports(config.tracking),
      ),
      panel(
        *_quality(config.tracking), 60, 0.0, 1.05,
        [plot.Line(trace.quality, 'a')],
        _qualities(config.tracking, config.stillness), last=True,
      ),
    ]
  )  # fmt: skip


def _places(config: config_lib.Config, width_px: float | None) -> plot.Limits:
  """How far from its anchor the target may be at rest."""
  rest_px, motion = config.stillness.anchor_px, config.motion
  values, name = [-rest_px, rest_px], f'a null stays within {rest_px:g} px'
  if isinstance(motion, config_lib.Excursion):
    rule = f'{motion.radius_widths:g} widths, at least {motion.radius_px:g} px'
    if width_px is not None:
      away_px = motion.away_px(width_px)
      values += [-away_px, away_px]
      rule = f'{away_px:.1f} px ({rule})'
    name = f'{name}, a motion leaves its rest by {rule}'
  return plot.Limits(values, name)


def _width_px(trace: traces_lib.Trace) -> float | None:
  """How wide the target was at first, where that is known."""
  return trace.motions[0].width_px if trace.motions else None


def _support_unit(tracking: _Tracking) -> str:
  flow = isinstance(tracking, config_lib.Tracking)
  return 'features' if flow else 'pixels'


def _supports(tracking: _Tracking) -> plot.Limits | None:
  """The support of a valid frame, where there is such a limit."""
  if not isinstance(tracking, config_lib.Tracking):
    return None
  return plot.Limits([tracking.min_support], f'at least {tracking.min_support}')


def _quality(tracking: _Tracking) -> tuple[str, str]:
  """What tracking quality is, and its unit."""
  if not isinstance(tracking, config_lib.Tracking):
    return 'share seen', 'of the target'
  if tracking.forward_backward:
    return 'f-b ratio', '0 to 1'
  return 'kept ratio', 'no f-b check'


def _qualities(tracking: _Tracking, rest: config_lib.Stillness) -> plot.Limits:
  """The quality of a null and of a valid frame."""
  if isinstance(tracking, config_lib.Tracking):
    least = tracking.min_quality
  else:
    least = tracking.lost_share
  return plot.Limits(
    [rest.null_quality, least],
    f'a null needs {rest.null_quality:g}, the track {least:g}',
  )


def _speeds(
  motion: config_lib.Motion | config_lib.Excursion, width_px: float | None
) -> plot.Limits:
  """The speeds at which motions begin and end."""
  if isinstance(motion, config_lib.Excursion):
    slow_px_s = motion.off_px_s
    rule = f'{motion.off_widths_s:g} widths/s, at least {slow_px_s:g} px/s'
    if width_px is not None:
      slow_px_s = motion.slow_px_s(width_px)
      rule = f'{slow_px_s:.1f} px/s ({rule})'
    return plot.Limits([slow_px_s], f'motion ends under {rule}')
  return plot.Limits(
    [motion.off_px_s, motion.on_px_s],
    f'motion begins over {motion.on_px_s:g} px/s and ends under'
    f' {motion.off_px_s:g} px/s',
  )


def _anchor_px(trace: traces_lib.Trace) -> np.ndarray:  # (2,)
  """Where the target was first: the anchor of nulls."""
  if not trace.valid.any():
    return trace.centre_px[:1].sum(axis=0)
  if _width_px(trace) is not None:
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
