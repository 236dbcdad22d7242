"""One case of a suite: its identity, its run, and whether its files hold."""

from collections.abc import Callable
import hashlib
import json
import pathlib
import shutil

from waggle_tasks import suites
from waggle_tasks.experiments.episodes import evaluator, outside
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  archive,
  encoding,
  provenance,
  writer,
)
from waggle_tasks.experiments.studies import case_rows, job_progress

SEAL = 'seal.json'


def fly(
  report: Callable[[float], None],
  case: suites.Case,
  receiver_name: str,
  identity_: str,
  command: str,
  page: writer.Page,
  draft: pathlib.Path,
) -> str | None:
  """Runs a case and leaves its sealed run folder; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    receiver_name: The receiver.
    identity_: Its identity.
    command: The shell line that runs it again.
    page: Makes the folder's page, which is no part of what is sealed.
    draft: The folder to leave; replaced when it exists.

  Returns:
    Why it could not be written, which another try would not change; None when
    it was.
  """
  foreign = outside.paths(receiver_name, [case.scene])
  start = provenance.Start.now(command, foreign)
  onlookers = [job_progress.reporter(report)]
  try:
    shutil.rmtree(draft, ignore_errors=True)
    draft.mkdir(parents=True)
    rollout = rollout_lib.run(case.scene, receiver_name, onlookers)
    verdict = evaluator.evaluate(case.scene, rollout)
    writer.write_run(
      draft,
      case.scene,
      receiver_name,
      rollout,
      verdict,
      start.end(rollout.renderer),
    )
    sums = {path.name: _sha(path) for path in sorted(draft.iterdir())}
    seal = {'case': case.name, 'identity': identity_, 'files': sums}
    (draft / SEAL).write_text(encoding.pretty(seal), encoding='utf-8')
    page(draft)
  except OSError as error:
    said = files.problem(error)
    if said is None:
      raise
    shutil.rmtree(draft, ignore_errors=True)  # Room for what is under way.
    return said
  return None


def flaw(folder: pathlib.Path, identity_: str) -> str | None:
  """Why the results in a folder cannot be used, or None when they can."""
  try:
    seal = json.loads((folder / SEAL).read_text(encoding='utf-8'))
    known, sums = seal['identity'], dict(seal['files'])
    found = {
      path.name: _sha(path)
      for path in folder.iterdir()
      if path.name not in (SEAL, archive.PAGE)
    }
  except FileNotFoundError:
    return 'not finished'
  except (OSError, ValueError, KeyError, TypeError) as error:
    return f'damaged: {type(error).__name__}'
  if known != identity_:
    return 'from another configuration, other sources or other versions'
  for name in sorted(sums.keys() | found.keys()):
    if sums.get(name) != found.get(name):
      return f'{name} is not what was written'
  return None


def row(case: suites.Case, folder: pathlib.Path) -> case_rows.SuiteRow:
  """A case's row, from its sealed folder."""
  seal = json.loads((folder / SEAL).read_text(encoding='utf-8'))
  config = archive.read_config(folder / 'config.json')
  result = archive.read_result(folder / 'result.json')
  return case_rows.SuiteRow(
    case=case.name,
    group=case.group,
    label=case.label,
    identity=seal['identity'],
    receiver=config.receiver,
    observers=case.scene.observers,
    expecting=sum(o.expected is not None for o in result.outcomes),
    correct=result.correct,
    passed=result.passed,
    simulated_s=result.simulated_s,
    published=case.published,
    outcomes=result.outcomes,
    scenario=config.scenario,
  )


def _sha(path: pathlib.Path) -> str:
  return hashlib.sha256(path.read_bytes()).hexdigest()
