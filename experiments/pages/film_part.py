"""The part of a run's page with its films and what is bound to them."""

from collections.abc import Sequence

from waggle_tasks.experiments.pages import markup, timelines
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import palette

tag = markup.tag


def draw(run: archive.Run, films: Sequence[str]) -> markup.Markup:
  """The video with the timelines that are bound to it."""
  video, choice = None, None
  if films:
    source = films[0]
    video = tag(
      'video', src=source, controls=True, preload='auto', muted=True,
      playsinline=True,
    )  # fmt: skip
    choice = _bar(films)
  hint = 'Click a plot to go to that time; arrow keys step.'
  missing = tag(
    'p',
    'This run has no video; `waggle broadcast --video` makes one.',
    class_='faint',
  )
  return tag(
    'section',
    tag('h2', 'Timeline'),
    video or missing,
    choice,
    tag('p', tag('output', id='now'), class_='now'),
    tag('div', timelines.draw(run), class_='scroll'),
    tag('p', hint, class_='faint screen'),
    _patterns(),
    id='film',
  )


def _bar(films: Sequence[str]) -> markup.Markup:
  """What the script controls the video with; useless without it."""
  rates = [
    tag('option', f'{rate}\u00d7', value=rate, selected=rate == 1)
    for rate in (1, 2, 4, 8)
  ]
  pages = [tag('button', name, type='button', data_film=name) for name in films]
  return tag(
    'div',
    tag('button', 'Play', type='button', id='play'),
    tag('label', 'Speed ', tag('select', *rates, id='rate')),
    tag('button', 'Full screen', type='button', id='full'),
    *(pages if len(pages) > 1 else ()),
    class_='bar',
    hidden=True,
  )


def _patterns() -> markup.Markup:
  """Stripes, so that UNKNOWN is told without its colour."""
  line = tag('path', d='M0 6L6 0', stroke=palette.BLACK, stroke_width='1.2')
  pattern = tag(
    'pattern', line, id='stripes', width=6, height=6,
    patternUnits='userSpaceOnUse',
  )  # fmt: skip
  return tag('svg', tag('defs', pattern), width=0, height=0)
