"""How high the performer was, over the levels of its language."""

from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import archive
from waggle_tasks.protocol import levels

_HEIGHT, _TOP = 130.0, 22.0
_MARGIN = 0.1  # Above the highest level and below the lowest.


def draw(run: archive.Run) -> markup.Markup | None:
  """The performer's height over time; None for a language without levels."""
  language = run.config.agreement.language
  alphabet = None if language is None else language.alphabet
  if not isinstance(alphabet, levels.Levels):
    return None
  above_m = run.positions_m['performer'][:, 2]
  home_m = run.config.agreement.hover_height_m
  lines_m = [home_m + alphabet.height_m(k) for k in range(alphabet.count)]
  low, high = min(*lines_m, *above_m), max(*lines_m, *above_m)
  edge = _MARGIN * (high - low)
  scale = plot.Scale(low - edge, high + edge, _TOP + _HEIGHT, _TOP)
  limits = plot.Limits(lines_m, f'levels 0 to {alphabet.count - 1}, from below')
  return plot.panel(
    'height', 'm', run.times_s, [plot.Curve(above_m, 'a')], scale, run.end_s,
    limits, last=True,
  )  # fmt: skip
