"""Lets swarms choose a nest site by dancing, beside published models.

Vehicles find sites of different quality, dance for them as vigorously as they
measure them to be good, and read each other's dances as often as was measured
on rendered pictures (see `waggle ladder`). Who reads a dance for another site
while it dances takes it as a stop signal. A swarm has chosen when a quorum is
for one site. Every combination of --vehicles, --ratios, --noises and
--conditions is a case of --worlds swarms; the condition 'perfect' is the
published model, in which each dance is read. Nothing is rendered and nothing is
flown. Leaves results.jsonl, a text, pictures and a page. Ended at any moment,
the same command goes on where it was. Exit status 0, 2 on bad input.
"""

from collections.abc import Callable, Sequence
import dataclasses
import pathlib
import sys
from typing import Any

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.episodes import (
  colony_swarm,
  ladder_table,
  word_level,
)
from waggle_tasks.experiments.flags import engine_flag
from waggle_tasks.experiments.pages import colony_page
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.results import (
  colony_figure,
  colony_tables,
  figures,
)
from waggle_tasks.experiments.studies import colony_study

_USUAL, _WATCHED = colony_swarm.Swarm(), word_level.Watching()
_VEHICLES = flags.DEFINE_list('vehicles', ['10', '100', '1000'], 'How many.')
_RATIOS = flags.DEFINE_list(
  'ratios', ['0.5', '0.7', '0.8', '0.9', '0.95'],
  'Quality of the second of two sites, where that of the first is 1.',
)  # fmt: skip
_QUALITIES = flags.DEFINE_list(
  'qualities', None, 'Qualities of more sites, the best first; in place of'
  ' --ratios.',
)  # fmt: skip
_NOISES = flags.DEFINE_list(
  'noises', ['0.2'], 'Of the measure that a vehicle takes of a site.'
)
_CONDITIONS = flags.DEFINE_list(
  'conditions', ['perfect', 'calm'], 'How dances are watched: perfect, or some'
  f' of {", ".join(ladder_table.CONDITIONS)}.',
)  # fmt: skip
_MODEL = flags.DEFINE_string(
  'model', _USUAL.model, f'One of {", ".join(colony_swarm.MODELS)}.'
)
_NUMBERS = {
  name: flags.DEFINE_float(name, getattr(_USUAL, name), text)
  for name, text in (
    ('value', 'Value of a site of quality 1.'),
    ('stop', 'Rate of the stop signal; only in the model value.'),
    ('follow', 'How much vehicles follow dances; only in the model list.'),
    ('found', 'Chance to find a site alone; only in the model list.'),
    ('quorum', 'Share that must be for a site.'),
    ('wrong', 'Share of frames that are read as another site; none ever was.'),
    ('step_s', 'How long a frame takes until it is read, s.'),
    ('longest_s', 'When a swarm is ended that has not chosen, s.'),
  )
}
_PLACES = {
  name: flags.DEFINE_float(name, getattr(_WATCHED, name), text)
  for name, text in (
    ('near_m', 'Least distance of watchers, m.'),
    ('far_m', 'Largest distance of watchers, m.'),
    ('aside_deg', 'How far to the side watchers are at most, degrees.'),
  )
}
_WORLDS = flags.DEFINE_integer('worlds', 200, 'Swarms of each case.')
_SEED = flags.DEFINE_integer('seed', 0, 'Of all that is drawn.')
engine_flag.define()
_OUTPUT = flags.DEFINE_string('output', 'runs/colony', 'Result folder.')


def main(argv: Sequence[str]) -> int:
  """Lets swarms choose, and shows what they chose."""
  del argv
  places = {name: flag.value for name, flag in _PLACES.items()}
  base = dataclasses.replace(
    _USUAL, model=_MODEL.value, watching=word_level.Watching(**places),
    **{name: flag.value for name, flag in _NUMBERS.items()},
  )  # fmt: skip
  factors: dict[str, Sequence[Any]] = {
    'vehicles': _read('vehicles', _VEHICLES.value, int),
    'noise': _read('noises', _NOISES.value, float),
    'ratio': _read('ratios', _RATIOS.value, float),
    'condition': _CONDITIONS.value,
  }
  if _QUALITIES.value is not None:
    sites = tuple(_read('qualities', _QUALITIES.value, float))
    base = dataclasses.replace(base, qualities=sites)
    del factors['ratio']
  cases = colony_study.cases(base, factors, _WORLDS.value, _SEED.value)
  engine, _ = engine_flag.engine()
  command = provenance.command_line('colony', launch.given_flags())
  folder = pathlib.Path(_OUTPUT.value)
  rows = colony_study.run(cases, folder, engine, command)
  page = colony_page.write(folder, rows)
  print(colony_tables.report(rows))
  print(f'\n{len(rows)} cases, {page}')
  if not figures.can_draw():
    print(colony_figure.MISSING)
  return 0


def _read(
  field: str, texts: Sequence[str], kind: Callable[[str], Any]
) -> list[Any]:
  try:
    return [*map(kind, texts)]
  except ValueError:
    raise colony_swarm.ColonyError(
      f'`{field}` must be numbers: got {",".join(texts)!r}'
    ) from None


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
