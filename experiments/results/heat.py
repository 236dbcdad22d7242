"""How the cells of an envelope look: colours, words and units."""

from collections.abc import Sequence

from waggle_tasks.experiments.results import envelope, palette

# Five stops of cividis, which readers with and without colour vision see
# alike (Nunez, Anderton and Renslow 2018), from failure to success.
STOPS = ('#00224e', '#434e6c', '#7d7c78', '#bbad6c', '#fee838')
_NAMES = {
  'bearing_deg': 'viewing angle',
  'half_span_deg': 'half span of the arc',
}
_UNITS = {
  'm': 'm', 'deg': 'degrees', 's': 's', 'hz': 'Hz', 'px': 'px', 'mps': 'm/s',
  'mm': 'mm',
}  # fmt: skip


def colour(share: float) -> str:
  """The colour of a share of successes, 0 to 1."""
  place = share * (len(STOPS) - 1)
  index = min(int(place), len(STOPS) - 2)
  low, high = palette.rgb(STOPS[index]), palette.rgb(STOPS[index + 1])
  mixed = (
    round(a + (b - a) * (place - index)) for a, b in zip(low, high, strict=True)
  )
  return '#' + ''.join(f'{each:02x}' for each in mixed)


def title(panel: envelope.Panel) -> str:
  """A map's other factors, such as 'noise sigma = 5'."""
  parts = []
  for factor, value in panel.fixed.items():
    words, unit = _words(factor)
    parts.append(f'{words} = {label(value)} {unit}'.rstrip())
  return ', '.join(parts)


def axis(factor: str | None) -> str:
  """A factor as the title of an axis, such as 'distance, m'."""
  return ', '.join(filter(None, _words(factor))) if factor else ''


def _words(factor: str) -> tuple[str, str]:
  """A factor's name for people and its unit, which may be empty."""
  stem, _, unit = factor.rpartition('_')
  if unit not in _UNITS:
    stem, unit = factor, ''
  return _NAMES.get(factor, stem.replace('_', ' ')), _UNITS.get(unit, '')


def label(value: object) -> str:
  """A factor's value at an axis."""
  if value is None:
    return ''
  return f'{value:g}' if isinstance(value, float) else str(value)


def share(rows: Sequence[envelope.Row]) -> tuple[float, str]:
  """A cell's share of successes, and the same in words, such as '4/5'."""
  got = envelope.count(rows)
  return got.right / got.exposures, f'{got.right}/{got.exposures}'
