"""A suite as a study: each of its cases leaves a run folder."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import os
import pathlib
import shutil
from typing import Any

from waggle_tasks import suites
from waggle_tasks.experiments.record import archive, folders, writer
from waggle_tasks.experiments.studies import case_rows, pool, runner, suite_case

_CASES, _DRAFTS = 'cases', '.drafts'


class Suite(runner.Study[suites.Case, case_rows.SuiteRow]):
  """The cases of a suite."""

  kind = 'suite'
  files = _CASES, _DRAFTS, archive.PAGE

  def __init__(
    self,
    cases: Sequence[suites.Case],
    receiver_name: str,
    page: writer.Page,
  ) -> None:
    """Makes a suite.

    Args:
      cases: What is flown.
      receiver_name: The receiver of every observer.
      page: Makes the page of a case's run folder.
    """
    super().__init__(cases, receiver_name)
    self._page = page

  def known(
    self, folder: pathlib.Path, identities: Mapping[str, str]
  ) -> dict[str, case_rows.SuiteRow]:
    """Rows of sound run folders; unsound ones are put out of the way."""
    out = {}
    for case in self.cases:
      home = folder / _CASES / case.name
      if not home.exists():
        continue
      if flaw := suite_case.flaw(home, identities[case.name]):
        print(f'{case.name}: run anew: {flaw}')
        shutil.rmtree(home)
      else:
        out[case.name] = suite_case.row(case, home)
    return out

  def job(
    self, case: suites.Case, identity: str, command: str, folder: pathlib.Path
  ) -> pool.Job:
    """Flies a case into a draft of its folder."""
    line = f'{command} --case={case.name}'
    arguments = case, self.receiver_name, identity, line, self._page
    draft = folder / _DRAFTS / case.name
    return pool.Job(case.name, suite_case.fly, arguments, draft=draft)

  @contextlib.contextmanager
  def keeping(
    self, folder: pathlib.Path
  ) -> Iterator[Callable[[pool.Done], case_rows.SuiteRow]]:
    """Gives drafts their name when they are whole."""
    (folder / _CASES).mkdir(exist_ok=True)
    cases = {case.name: case for case in self.cases}

    def keep(done: pool.Done) -> case_rows.SuiteRow:
      name = done.job.name
      if done.value is not None:
        raise folders.OutputError(
          f'`output` must be writable: {name} could not be recorded:'
          f' {done.value}; cases that were are kept'
        )
      draft, home = folder / _DRAFTS / name, folder / _CASES / name
      if done.files:
        draft.mkdir(parents=True, exist_ok=True)
      for file, data in done.files.items():
        (draft / file).write_bytes(data)
      os.replace(draft, home)
      return suite_case.row(cases[name], home)

    try:
      yield keep
    finally:
      shutil.rmtree(folder / _DRAFTS, ignore_errors=True)

  def lines(self, row: case_rows.SuiteRow) -> list[dict[str, Any]]:
    """One for each observer."""
    out = []
    for outcome in row.outcomes:
      fields = dict(vars(outcome))
      failures = '; '.join(fields.pop('failures'))
      out.append(
        {
          'group': row.group, 'case': row.case, 'receiver': row.receiver,
          **fields, 'failures': failures, 'group_passed': row.passed,
        }
      )  # fmt: skip
    return out
