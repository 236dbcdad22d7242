"""Runs a suite again and again, each time with something moved or left out.

Each variant is a suite of its own in the output folder; ended at any moment,
the same command goes on where it was.
"""

from collections.abc import Mapping, Sequence
import dataclasses
import pathlib
from typing import Any

from waggle_tasks import suites
from waggle_tasks.experiments.record import provenance, writer
from waggle_tasks.experiments.studies import case_rows, pool

Results = Mapping[str, list[case_rows.SuiteRow]]


@dataclasses.dataclass(frozen=True)
class Variant:
  """What is moved, or left out.

  Attributes:
    label: Its description, for tables.
    changes: Fields of `Scenario` and their new values.
    receiver: The receiver.
  """

  label: str
  changes: dict[str, Any] = dataclasses.field(default_factory=dict)
  receiver: str = 'klt'


def run(
  variants: Mapping[str, Variant],
  cases: Sequence[suites.Case],
  folder: pathlib.Path,
  engine: pool.Engine,
  command: Sequence[str],
  page: writer.Page,
) -> Results:
  """Runs variants of a suite, one after the other.

  Args:
    variants: What to run, by name.
    cases: The suite.
    folder: Where each variant's folder is kept.
    engine: What flies the cases.
    command: The launcher and its flags; '--variant=NAME' runs one of them.
    page: Makes the page of a run folder.

  Returns:
    By name, the rows of each one.

  Raises:
    WaggleError: if the suite cannot run.
  """
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.studies import runner, suite_study

  results = {}
  for name, variant in variants.items():
    print(f'{name}: {variant.label}', flush=True)
    line = provenance.command_line(
      command[0], [*command[1:], f'--variant={name}']
    )
    moved = [_moved(case, variant) for case in cases]
    study = suite_study.Suite(moved, variant.receiver, page)
    results[name] = runner.run(study, folder / name, engine, line)
  return results


def _moved(case: suites.Case, variant: Variant) -> suites.Case:
  scene = dataclasses.replace(case.scene, **variant.changes)
  return dataclasses.replace(case, scene=scene)
