"""Measures the goodput of languages, codes and repetition in conditions.

Every scheme is flown in every condition at every place, --broadcasts times,
each with a seed and a payload of its own, by the engine of `waggle sweep`.
A scheme is a language, with its code changed or not, and with a number of
rounds: 'swift', 'swift:check=crc4,parity=0', 'swift x3'. The paper's language
cannot repeat in one dance: 'paper x3' is three broadcasts of one payload, of
which what is read first counts. Leaves results.jsonl, results.csv, a text,
pictures and a page. Ended at any moment, the same command goes on where it was.
Exit status 0 when no observer read a wrong message or moved without a right
one, 1 otherwise, 2 on bad input. --codes flies nothing: it counts what codes
do on a simulated channel.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks import fidelity as fidelity_lib
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import engine_flag
from waggle_tasks.experiments.pages import link_page
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.results import (
  code_tables,
  envelope,
  figures,
  link_figure,
  link_tables,
)
from waggle_tasks.experiments.studies import (
  link_cases,
  link_conditions,
  link_schemes,
)

_SCHEMES = flags.DEFINE_string(
  'schemes', 'paper,brisk,swift', f'Schemes: each {link_schemes.FORM}.'
)
_CONDITIONS = flags.DEFINE_list(
  'conditions', ['calm', 'noise', 'mocap', 'drop30', 'blackouts'],
  f'Some of {", ".join(link_conditions.CONDITIONS)}.',
)  # fmt: skip
_DISTANCES = flags.DEFINE_list('distances', ['1.3'], 'Of observers, m.')
_BEARINGS = flags.DEFINE_list(
  'bearings', ['0'], 'From where they look, degrees from the front.'
)
_BROADCASTS = flags.DEFINE_integer(
  'broadcasts', 5, 'Messages of each scheme in each condition at each place.'
)
_OBSERVERS = flags.DEFINE_integer('observers', 1, 'Observers of a broadcast.')
_BITS = flags.DEFINE_string(
  'bits', '', 'What every message says in place of six random bits: characters'
  ' of 0 and 1, or random:N for N bits that each message draws; in any language'
  ' but the paper\'s.',
)  # fmt: skip
_FIDELITY = flags.DEFINE_string(
  'fidelity', fidelity_lib.PIXELS, 'How much of each broadcast is made, one of'
  f' {", ".join(fidelity_lib.FIDELITIES)}.',
)  # fmt: skip
_AIRTIME = flags.DEFINE_float(
  'airtime_s', None, 'Time that all schemes are given to be compared, s;'
  f' unset, that of {link_tables.ROUNDS} messages of the paper.',
)  # fmt: skip
_CODES = flags.DEFINE_boolean(
  'codes', False, 'Only count messages of the codes of swift on a channel.'
)
_MESSAGES = flags.DEFINE_integer(
  'messages', 1_000_000, 'How many, of each code on each channel.'
)
engine_flag.define()
_OUTPUT = flags.DEFINE_string('output', 'runs/link', 'Result folder.')


def main(argv: Sequence[str]) -> int:
  """Flies and shows a link and returns the exit status."""
  del argv
  if _CODES.value:
    print(code_tables.report(_MESSAGES.value))
    return 0
  plan = link_cases.Plan(
    link_schemes.parse(_SCHEMES.value),
    _CONDITIONS.value,
    _numbers('distances', _DISTANCES.value),
    _numbers('bearings', _BEARINGS.value),
    _BROADCASTS.value,
    _OBSERVERS.value,
    _BITS.value,
    _FIDELITY.value,
  )
  airtime_s = _AIRTIME.value
  if airtime_s is not None and not 0 < airtime_s < float('inf'):
    raise flags.Error(f'--airtime_s must be positive, finite: got {airtime_s}')
  cases, refused = link_cases.cases(plan)
  for line in refused:
    print(f'not flown: {line}', file=sys.stderr)
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import low_level
  from waggle_tasks.experiments.studies import link_study, runner

  for case in cases:
    low_level.check([case.scene], case.receiver)
  engine, _ = engine_flag.engine()
  command = provenance.command_line('link', launch.given_flags())
  folder = pathlib.Path(_OUTPUT.value)
  rows = runner.run(link_study.Link(cases), folder, engine, command)
  page = link_page.write(folder, rows, airtime_s)
  print(link_tables.report(rows, airtime_s or link_tables.usual_airtime_s()))
  print(f'\n{len(rows)} broadcasts, {page}')
  if not figures.can_draw():
    print(link_figure.MISSING)
  got = envelope.count(rows)
  return 1 if got.wrong or got.unauthorised else 0


def _numbers(field: str, texts: Sequence[str]) -> list[float]:
  try:
    return [*map(float, texts)]
  except ValueError:
    raise link_schemes.SchemeError(
      f'`{field}` must be numbers: got {",".join(texts)!r}'
    ) from None


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
