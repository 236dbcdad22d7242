"""What `waggle bench` can do: measure, and compare event logs."""

from collections.abc import Mapping, Sequence
import dataclasses
import os
from typing import Any

import tqdm

from waggle_tasks import registry, suites
from waggle_tasks.experiments.bench_parts import events, sections, tables
from waggle_tasks.experiments.machine import cores, gl
from waggle_tasks.experiments.record import provenance


@dataclasses.dataclass(frozen=True)
class Answer:
  """What came out.

  Attributes:
    text: For people.
    found: For machines, by name.
    passed: False when event logs differ.
  """

  text: str
  found: Mapping[str, Any]
  passed: bool = True


def machine() -> dict[str, Any]:
  """What measurements depend on, before they begin."""
  return {
    'renderer': gl.render_once().renderer,
    'cores': len(cores.usable()),
    'load': os.getloadavg()[0],
    'versions': provenance.versions(),
  }


def measure(
  here: Mapping[str, Any], only: Sequence[str], settings: sections.Settings
) -> Answer:
  """Measures parts of the benchmark.

  Args:
    here: What `machine` returned.
    only: Names of `sections.SECTIONS`; empty for all of them.
    settings: How much is measured.

  Raises:
    BenchError: if a name is not known.
  """
  names, results = sections.chosen(only), {}
  bar = tqdm.tqdm(names, bar_format='{desc}|{bar}| {n}/{total} [{elapsed}]')
  for name in bar:
    bar.set_description_str(f'{name} ')
    results[name] = sections.SECTIONS[name](settings)
  clock = settings.clock.__name__
  title = (
    f'{here["renderer"]}, {here["cores"]} cores, load {here["load"]:.1f} when'
    f' it began.\nMedians of {settings.repeats}, images and loops by {clock}.'
  )
  return Answer(
    f'{title}\n\n{tables.text(results)}',
    {
      'settings': settings,
      'clock': clock,
      'ratios': tables.ratios(results),
      'measured': results,
    },
  )


def check_events(suite: str | None) -> Answer:
  """Compares event logs with either camera.

  Args:
    suite: One of `suites.SUITES`; None for the default broadcast alone.

  Raises:
    SuiteError: if the suite is not known.
  """
  default = suites.Case('broadcast', 'own', '', registry.find('broadcast'))
  cases = (default,) if suite is None else suites.find(suite)
  logs = [*events.compare(cases, len(cores.usable()))]
  same = all(each.difference is None for each in logs)
  return Answer(events.report(logs), {'events': logs}, same)
