"""The README's own examples, run as they stand."""

import pathlib
import re

import pytest

from waggle_tasks.experiments import main

TEXT = (pathlib.Path(__file__).parents[1] / 'README.md').read_text('utf-8')
BLOCKS = re.findall(r'```python\n(.*?)```', TEXT, re.DOTALL)


def test_every_command_is_listed_and_exists() -> None:
  listed = re.findall(r'^\| `waggle (\w+)`', TEXT, re.MULTILINE)
  assert sorted(listed) == sorted(main.COMMANDS)


def test_the_loop_reads_and_flies_a_message(
  capsys: pytest.CaptureFixture[str],
) -> None:
  exec(compile(BLOCKS[0], 'README.md', 'exec'), {})
  out = capsys.readouterr().out
  assert out.count("'arrival'") == 2
  assert out.count('direction=1, heading=0, distance=2') == 2


def test_codebooks_and_layouts_are_values() -> None:
  namespace = {}
  exec(compile(BLOCKS[0].splitlines()[0], 'README.md', 'exec'), namespace)
  for block in BLOCKS[1:]:
    exec(compile(block, 'README.md', 'exec'), namespace)
  observations = namespace['environment'].reset().observation
  assert len(observations) == 5
  assert observations[0]['position_m'] == pytest.approx([0, -1.3, 1.3])
  namespace['environment'].close()
