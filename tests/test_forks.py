"""Processes that are forked after images were drawn say so, and never hang."""

import subprocess
import sys

import pytest

# What a child does that was forked after its parent did something.
CODE = """
import multiprocessing, sys
import waggle_tasks
from waggle_tasks.entities import forks

def make():
  return waggle_tasks.load('no_send', observers=1, duration_s=1.0)

def child():
  try:
    {child}
    print('drew')
  except forks.ForkError as error:
    print(error)

if __name__ == '__main__':
  {parent}
  method = multiprocessing.get_context('fork')
  process = method.Process(target=child)
  process.start()
  process.join(30)
  print(process.exitcode)
  process.kill()
"""
ANEW = 'make().close()'


def forked(parent: str, child: str) -> list[str]:
  """What a child says, and how it ended."""
  done = subprocess.run(
    [sys.executable, '-c', CODE.format(parent=parent, child=child)],
    stdout=subprocess.PIPE,
    text=True,
    timeout=60,
    check=True,
  )
  return done.stdout.splitlines()


@pytest.mark.slow
@pytest.mark.parametrize(
  ('parent', 'child'),
  [
    (ANEW, ANEW),  # As a vector of environments does.
    ('kept = make()', ANEW),
    ('kept = make()', 'kept.reset()'),
  ],
)
def test_a_fork_after_drawing_is_an_error_that_says_how_to_start_it(
  parent: str, child: str
) -> None:
  line, ended = forked(parent, child)
  assert line.startswith('images must not be drawn in a process that was fork')
  assert "multiprocessing.get_context('spawn')" in line
  assert ended == '0'


@pytest.mark.slow
def test_a_fork_before_drawing_draws() -> None:
  assert forked('import dm_control', ANEW) == ['drew', '0']
