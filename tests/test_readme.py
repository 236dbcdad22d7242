"""The README's own examples, run as they stand."""

import contextlib
import io
import json
import pathlib
import re

import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments import main
from waggle_tasks.experiments.record import nulls, writer
from waggle_tasks.protocol import limits

TEXT = (pathlib.Path(__file__).parents[1] / 'README.md').read_text('utf-8')
BLOCKS = re.findall(r'```python\n(.*?)```', TEXT, re.DOTALL)


def test_every_command_is_listed_and_exists() -> None:
  listed = re.findall(r'^\| `waggle (\w+)`', TEXT, re.MULTILINE)
  assert sorted(listed) == sorted(main.COMMANDS)


@pytest.fixture(scope='module')
def first() -> tuple[dict[str, object], str]:
  """What the first example defines, and what it prints."""
  namespace: dict[str, object] = {}
  return namespace, run(BLOCKS[0], namespace)


@pytest.fixture
def namespace(first: tuple[dict[str, object], str]) -> dict[str, object]:
  """What later examples go on from."""
  return {**first[0]}


def run(block: str, namespace: dict[str, object]) -> str:
  """What a block prints."""
  out = io.StringIO()
  with contextlib.redirect_stdout(out):
    exec(compile(block, 'README.md', 'exec'), namespace)
  return out.getvalue()


@pytest.mark.slow
def test_the_loop_reads_and_flies_a_message(
  first: tuple[dict[str, object], str],
) -> None:
  _, out = first
  assert out.count("'arrival'") == 2
  assert out.count('direction=1, heading=0, distance=2') == 2


@pytest.mark.slow
def test_a_faster_language_is_read_by_the_same_loop(
  namespace: dict[str, object],
) -> None:
  out = run(BLOCKS[1], namespace)
  assert out.count("'arrival'") == 2
  assert out.count('direction=0, heading=0, distance=2') == 2
  assert namespace['environment'].task.performer.end_s < 65


@pytest.mark.long
def test_everyone_in_a_layout_of_ones_own_reads(
  namespace: dict[str, object],
) -> None:
  out = run(BLOCKS[2], namespace)
  assert out.count("'arrival'") == 5
  assert out.count('direction=0, heading=0, distance=2') == 5


@pytest.mark.slow
def test_the_scenario_of_a_run_is_made_again(
  namespace: dict[str, object], tmp_path: pathlib.Path
) -> None:
  scene = scenario.Scenario(observers=2, seed=3)
  config = json.dumps(writer.config(scene, 'klt'))
  (tmp_path / 'config.json').write_text(config)
  run(BLOCKS[3], namespace)
  assert namespace['scene_of'](str(tmp_path)) == scene


def test_the_numbers_are_those_of_the_code() -> None:
  assert f'{limits.MAX_UP_MPS2} m/s² upwards' in TEXT
  assert f'{limits.MAX_SIDEWAYS_MPS2} m/s² sideways' in TEXT
  for name in ('klt', 'view_bank'):
    assert f'`{name}` {nulls.needed_s(name):.2f} s' in TEXT
