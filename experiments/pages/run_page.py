"""The page of a run: what happened, in pictures, for those who must trust it.

A static file beside the data that it shows; `write` makes it again from them.
"""

from collections.abc import Sequence
import math
import pathlib
import sys
from typing import Any

from waggle_tasks.agents import receivers
from waggle_tasks.experiments.pages import (
  document,
  film_part,
  flights,
  heights,
  hover_part,
  markup,
  observer_part,
  room,
  rotor_part,
)
from waggle_tasks.experiments.record import (
  archive,
  changes,
  flown,
  scenario_fields,
  story,
  told,
  verdicts,
)
from waggle_tasks.protocol import payload

_VIDEOS = {'.webm': 'video/webm', '.mp4': 'video/mp4'}
_DATA = (
  'config.json', 'events.jsonl', 'result.json', 'provenance.json',
  archive.TRACES, archive.POSITIONS, flown.NAME,
)  # fmt: skip

# Of a scenario, what its one line says anyhow.
_TOLD = (
  'control', 'payload', 'bits', 'heading_step_deg', 'distance_unit_m',
  'observers', 'layout', 'distance_m', 'jitter_m', 'seed',
)  # fmt: skip

tag = markup.tag


def write(folder: pathlib.Path) -> pathlib.Path:
  """Makes a run folder's page from its data and returns its path.

  Raises:
    ArchiveError: if it is no run folder, or damaged.
    TraceError: the same, of its traces; FlownError, of flights.
  """
  wrong = AttributeError, LookupError, TypeError, receivers.ReceiverError
  try:
    whole = draw(archive.load(folder), videos(folder))
  except wrong as error:
    raise archive.ArchiveError(
      f'{folder} holds data that no run left: {error!r}'
    ) from None
  return document.save(folder, whole)


def leave(folder: pathlib.Path) -> None:
  """Makes the page of a run that was just flown; a fault of it is a warning.

  What was flown is in the files beside it, and `waggle report` makes the page
  again from them.
  """
  try:
    write(folder)
  except OSError:  # A disk that is full is no fault of the page.
    raise
  except Exception as error:
    print(
      f'no page of the run was made: {error!r}; its data are whole, and'
      ' `waggle report FOLDER` makes the page',
      file=sys.stderr,
    )


def videos(folder: pathlib.Path) -> list[str]:
  """The names of a run's videos, the shortest name, page one, first."""
  names = [p.name for p in folder.iterdir() if p.suffix in _VIDEOS]
  return sorted(names, key=lambda name: (len(name), name))


def draw(run: archive.Run, films: Sequence[str]) -> markup.Markup:
  """The page as text: equal data gives equal bytes."""
  outcomes = run.result.outcomes
  body = [
    _head(run),
    _failures(outcomes),
    film_part.draw(run, films),
    _flights(run),
    rotor_part.draw(run),
    hover_part.draw(run),
    *(observer_part.draw(run, outcome) for outcome in outcomes),
    _provenance(run),
  ]
  return document.page(_title(run), body, _facts(run))


def _title(run: archive.Run) -> str:
  verdict = 'passed' if run.result.passed else 'FAILED'
  return f'{_said(run)}, {verdict} \u2013 waggle broadcast'


def _said(run: archive.Run) -> str:
  """What was sent."""
  return told.message(run.scenario['payload'], run.scenario.get('bits', ''))


def _facts(run: archive.Run) -> dict[str, Any]:
  """What the script says about a moment."""
  agreed = run.config.agreement
  readings = {
    name: [
      [0.0, story.Reading(agreed).status],
      *([t, reading.status] for t, reading in story.readings(events, agreed)),
    ]
    for name, events in run.events.items()
  }
  sent = [[s.begin_s, s.end_s, s.words] for s in run.sent]
  return {
    'end': run.end_s,
    'sent': sent,
    'readings': readings,
    'ways': room.ways(run),
  }


def _head(run: archive.Run) -> markup.Markup:
  passed, outcomes = run.result.passed, run.result.outcomes
  expecting = sum(o.expected is not None for o in outcomes)
  if expecting:
    words = f'{run.result.correct} of {expecting} decoded {_said(run)}'
  else:
    words = 'nothing was to be decoded'
  chips = []
  for each in outcomes:
    words_ = [each.observer, ' ', told.short(each.decoded or 'no message')]
    link = tag('a', *words_, href=f'#{each.observer}')
    chips.append(document.chip(not each.failures, link))
  verdict = document.chip(passed, 'group passed' if passed else 'group FAILED')
  return tag(
    'header',
    tag('h1', verdict, ' ', words),
    tag('p', *chips, class_='chips'),
    tag('p', describe(run), class_='faint'),
    _changes(run),
  )


def _changes(run: archive.Run) -> markup.Markup | None:
  """What is unlike the default: disturbances, looks, languages."""
  said: tuple[str, ...] = _TOLD
  if run.scenario['layout'] == 'arc':
    said = (*said, 'half_span_deg')
  found = changes.among(run.scenario, said)
  if not found:
    return None
  return tag('p', tag('b', 'Changed: '), ', '.join(found), class_='changed')


def describe(run: archive.Run) -> str:
  """The scenario in a line."""
  scene = run.scenario
  units = payload.Units(**scene['units'])
  bits = payload.Payload.from_bits(scene['payload'], units)
  turn_deg = bits.heading * math.degrees(units.heading_step_rad)
  way = 'backward' if bits.direction else 'forward'
  reach_m = bits.distance * units.distance_unit_m
  layout = scene['layout']
  where = f'{layout}, {scene["distance_m"]:g} m'
  if layout == 'arc':
    where += f', half-span {scene["half_span_deg"]:g}\u00b0'
  elif not isinstance(layout, str):
    where = scenario_fields.layout_name(layout)
  control = '' if scene['control'] == 'none' else f'{scene["control"]}; '
  said = (
    f'payload {bits.bits}: {way}, heading {turn_deg:g}\u00b0, {reach_m:g} m'
  )
  if scene.get('bits'):
    said = f'data {_said(run)}'
  return (
    f'{control}{said}; observers: {scene["observers"]}; {where}; jitter'
    f' {scene["jitter_m"]:g} m, seed {scene["seed"]}; receiver'
    f' {run.config.receiver}; {run.end_s:.2f} s simulated'
  )


def _failures(outcomes: Sequence[verdicts.Outcome]) -> markup.Markup | None:
  lines = [
    tag('li', tag('b', each.observer), f': {failure}')
    for each in outcomes
    for failure in each.failures
  ]
  if not lines:
    return None
  return tag(
    'section', tag('h2', 'What failed'), tag('ul', *lines), class_='failed'
  )


def _flights(run: archive.Run) -> markup.Markup:
  return tag(
    'section',
    tag('h2', 'Flights'),
    tag('div', room.plan(run), room.front(run), class_='pair'),
    tag(
      'p',
      'Marked is where everyone is at the time of the cursor above, with the'
      ' last 8 s of its way.',
      class_='faint screen',
    ),
    tag('div', flights.displacements(run), flights.distances(run)),
    *_dance(run),
  )


def _dance(run: archive.Run) -> list[markup.Markup]:
  """Every gesture as it was flown, or the heights of levels."""
  if (drawn := heights.draw(run)) is not None:
    title = 'What the performer flew'
    return [tag('h3', title), tag('div', drawn, class_='scroll')]
  drawn = room.dance(run)
  if drawn is None:
    return []
  title = 'What the performer flew, from the front; world x and height in m'
  return [tag('h3', title), drawn]


def _provenance(run: archive.Run) -> markup.Markup:
  origin = run.provenance
  rows = [
    ['sources', f'SHA-256 {origin["source_digest"]}'],
    ['renderer', origin['renderer']],
    *([name, value] for name, value in origin['versions'].items()),
  ]
  files = [
    tag('a', name, href=name) for name in _DATA if (run.folder / name).exists()
  ]
  return tag(
    'section',
    tag('h2', 'Where it comes from'),
    tag('p', 'The command that runs it again:'),
    tag('pre', origin['command']),
    tag('p', 'Its data: ', markup.join(files, ', ')),
    tag('div', markup.table(('', 'version'), rows), class_='versions'),
  )
