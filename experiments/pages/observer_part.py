"""What one observer saw and did, for the page of a run."""

from waggle_tasks.agents import description, outsiders, receivers
from waggle_tasks.experiments.pages import (
  document,
  frames_part,
  gesture_plots,
  markup,
  signals,
  timelines,
)
from waggle_tasks.experiments.record import archive, verdicts
from waggle_tasks.experiments.record import told as told_lib
from waggle_tasks.experiments.record import traces as traces_lib

tag = markup.tag


def draw(run: archive.Run, outcome: verdicts.Outcome) -> markup.Markup:
  """An observer's outcome, what it saw, and its motions."""
  name = outcome.observer
  trace = run.traces.get(name)
  told = _told(run, trace)
  plots = tag('p', 'No track was kept.', class_='faint')
  if trace is not None and len(trace.times_s):
    plots = tag('div', signals.draw(trace, run.end_s, told), class_='scroll')
  return tag(
    'section',
    tag('h2', name, ' ', document.chip(not outcome.failures, _word(outcome))),
    _outcome(outcome),
    plots,
    *_read(run, name, told),
    id=name,
    class_='observer',
  )


def _read(
  run: archive.Run, name: str, told: description.Description
) -> list[markup.Markup]:
  """Its frames, if it reads them as a whole; else its motions."""
  if frames_part.are_told(run, name):
    return [
      tag('h3', f'Frames of {name}'),
      frames_part.draw(run, name, told.frames),
    ]
  events = timelines.motions(run.events[name])
  drawn = tag('p', 'It saw no motion.', class_='faint')
  if events:
    drawn = gesture_plots.draw(events, run.traces.get(name), told)
  return [tag('h3', f'Motions of {name}'), drawn]


def _told(
  run: archive.Run, trace: traces_lib.Trace | None
) -> description.Description:
  """The limits of the run's receiver, where it is on this machine."""
  width_px = None if trace is None else signals.width_px(trace)
  try:
    return receivers.describe(
      run.config.receiver, run.config.agreement, width_px
    )
  except outsiders.MissingError:  # A page needs no more than the data.
    return description.Description()


def _word(outcome: verdicts.Outcome) -> str:
  if outcome.failures:
    return 'failed'
  return 'passed' if outcome.expected else 'waited, as it should'


def _outcome(outcome: verdicts.Outcome) -> markup.Markup:
  columns = [
    ('sent', 'expected', 0, 1), ('decoded', 'decoded', 0, 1),
    ('END, s', 'end_s', 2, 1), ('final null, s', 'final_null_s', 2, 1),
    ('start, s', 'start_s', 2, 1), ('arrival, s', 'arrival_s', 2, 1),
    ('error, mm', 'error_m', 2, 1e3), ('hold, s', 'hold_s', 2, 1),
  ]  # fmt: skip
  if outcome.estimate_error_m is not None:
    columns.append(('by estimate, mm', 'estimate_error_m', 2, 1e3))
  cells = []
  for _, field, digits, scale in columns:
    value = getattr(outcome, field)
    if isinstance(value, float):
      value = f'{value * scale:.{digits}f}'
    elif value is not None:
      value = told_lib.short(value)
    cells.append('\u2013' if value is None else value)
  return markup.table(('', *(name for name, *_ in columns)), [['', *cells]])
