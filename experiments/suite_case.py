"""One case of a suite: its identity, its run, and whether its files hold."""

from collections.abc import Callable
import datetime
import hashlib
import json
import pathlib
import shutil

import cv2
from dm_control import composer
import dm_env

from waggle_tasks import suites
from waggle_tasks.agents import observer_agent
from waggle_tasks.experiments import evaluator, provenance, records
from waggle_tasks.experiments import rollout as rollout_lib
from waggle_tasks.protocol import timing

SEAL = 'seal.json'
_REPORT_FRAMES = 50  # How often a running case says that it is alive.


def identity(case: suites.Case, receiver_name: str, source_digest: str) -> str:
  """A SHA-256 of all that decides a case's result.

  Args:
    case: The case.
    receiver_name: The receiver.
    source_digest: Of this project's sources, see `provenance`.
  """
  parts = {
    'config': records.config(case.scene, receiver_name),
    'sources': source_digest,
    'versions': provenance.versions(),
  }
  text = json.dumps(records.to_json(parts), sort_keys=True)
  return hashlib.sha256(text.encode()).hexdigest()


def fly(
  report: Callable[[float], None],
  case: suites.Case,
  receiver_name: str,
  identity_: str,
  command: str,
  draft: pathlib.Path,
) -> None:
  """Runs a case and leaves its sealed run folder; called in a worker.

  Args:
    report: Told now and then how many frames are done.
    case: The case.
    receiver_name: The receiver.
    identity_: Its identity.
    command: The shell line that runs it again.
    draft: The folder to leave; replaced when it exists.
  """
  cv2.setNumThreads(1)  # Workers share the cores.
  shutil.rmtree(draft, ignore_errors=True)
  draft.mkdir(parents=True)
  began = datetime.datetime.now(datetime.UTC)

  def watch(
    environment: composer.Environment,
    timestep: dm_env.TimeStep,
    team: observer_agent.Team,
  ) -> None:
    del team
    frame = timing.frames(environment.physics.time())
    if timestep.last() or frame % _REPORT_FRAMES == 0:
      report(frame)

  rollout = rollout_lib.run(case.scene, receiver_name, [watch])
  verdict = evaluator.evaluate(case.scene, rollout)
  origin = provenance.Provenance.of(command, rollout.renderer, began)
  records.write_run(draft, case.scene, receiver_name, rollout, verdict, origin)
  files = {path.name: _sha(path) for path in sorted(draft.iterdir())}
  seal = {'case': case.name, 'identity': identity_, 'files': files}
  (draft / SEAL).write_text(records.pretty(seal), encoding='utf-8')


def flaw(folder: pathlib.Path, identity_: str) -> str | None:
  """Why the results in a folder cannot be used, or None when they can."""
  try:
    seal = json.loads((folder / SEAL).read_text(encoding='utf-8'))
    known, files = seal['identity'], dict(seal['files'])
    found = {
      path.name: _sha(path) for path in folder.iterdir() if path.name != SEAL
    }
  except FileNotFoundError:
    return 'not finished'
  except (OSError, ValueError, KeyError, TypeError) as error:
    return f'damaged: {type(error).__name__}'
  if known != identity_:
    return 'from another configuration, other sources or other versions'
  for name in sorted(files.keys() | found.keys()):
    if files.get(name) != found.get(name):
      return f'{name} is not what was written'
  return None


def row(case: suites.Case, folder: pathlib.Path) -> dict[str, object]:
  """A case's line of results.jsonl, from its sealed folder."""
  seal = json.loads((folder / SEAL).read_text(encoding='utf-8'))
  result = json.loads((folder / 'result.json').read_text(encoding='utf-8'))
  config = json.loads((folder / 'config.json').read_text(encoding='utf-8'))
  expecting = sum(o['expected'] is not None for o in result['outcomes'])
  return {
    'case': case.name,
    'group': case.group,
    'label': case.label,
    'identity': seal['identity'],
    'receiver': config['receiver'],
    'observers': case.scene.observers,
    'expecting': expecting,
    'correct': result['correct'],
    'passed': result['passed'],
    'simulated_s': result['simulated_s'],
    'published': records.to_json(case.published),
    'outcomes': result['outcomes'],
    'scenario': config['scenario'],
  }


def _sha(path: pathlib.Path) -> str:
  return hashlib.sha256(path.read_bytes()).hexdigest()
