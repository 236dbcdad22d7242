"""What is told of where results come from."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

from waggle_tasks.experiments.record import provenance

ROOT = pathlib.Path(__file__).parents[1]
FOLDERS = ('entities', 'arenas', 'agents', 'experiments')
DIGEST = (
  'from waggle_tasks.experiments.record import provenance as p\n'
  'print(p.agents.__path__[0], p.source_digest(p.source_hashes()))'
)


def test_a_checkout_and_what_is_built_of_it_have_one_digest(
  tmp_path: pathlib.Path,
) -> None:
  """Here as in a wheel: all folders within the one package."""
  home = tmp_path / 'waggle_tasks'
  shutil.copytree(ROOT / 'waggle_tasks', home)
  for folder in FOLDERS:
    shutil.copytree(ROOT / folder, home / folder)
  child = subprocess.run(
    [sys.executable, '-c', DIGEST],
    capture_output=True, text=True, check=True, cwd=tmp_path,
    env=os.environ | {'PYTHONPATH': str(tmp_path)},
  )  # fmt: skip
  here = provenance.source_digest(provenance.source_hashes())
  assert child.stdout.split() == [str(home / 'agents'), here]


@pytest.mark.parametrize(
  'name',
  [
    'waggle_tasks.agents.klt',
    'waggle_tasks.entities.renderer',
    'waggle_tasks.experiments.episodes.evaluator',
    'waggle_tasks.experiments.studies.spoilers',
    'waggle_tasks.protocol.frame',
    'waggle_tasks.scenario',
  ],
)
def test_what_decides_results_is_of_their_identity(name: str) -> None:
  assert name in provenance.deciding_hashes()


@pytest.mark.parametrize(
  'name',
  [
    'waggle_tasks.experiments.broadcast',
    'waggle_tasks.experiments.flags.scenario_flags',
    'waggle_tasks.experiments.pages.run_page',
    'waggle_tasks.experiments.results.heat',
    'waggle_tasks.experiments.video.film',
  ],
)
def test_a_changed_page_or_launcher_flies_nothing_anew(name: str) -> None:
  assert name in provenance.source_hashes()
  assert name not in provenance.deciding_hashes()
