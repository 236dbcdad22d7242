"""Runs `waggle` in processes that begin with its libraries already there.

A new Python takes a second of a core to import what every command needs. One
that has them stands by and is forked for each command: the fork has flags,
streams, a folder and an end of its own, as a new process has. Before the fork
there is nothing of GL, and one thread alone: what others hold then is held for
ever after it.
"""

from collections.abc import Sequence
import contextlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile

_MAIN = 'waggle_tasks.experiments.main'


class Starter:
  """A process to be forked; it ends with the one that made it."""

  def __init__(self) -> None:
    self._environment = _environment()
    self._parent = subprocess.Popen(
      [sys.executable, __file__],
      stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
      env=self._environment | {'OPENBLAS_NUM_THREADS': '1'},
    )  # fmt: skip

  def run(
    self, arguments: Sequence[str], folder: pathlib.Path | None
  ) -> subprocess.CompletedProcess[str]:
    """Runs one command to its end."""
    with tempfile.TemporaryDirectory() as name:
      streams = [pathlib.Path(name, each) for each in ('out', 'err')]
      order = [arguments, str(folder or pathlib.Path.cwd()), *map(str, streams)]
      self._parent.stdin.write(json.dumps(order) + '\n')
      self._parent.stdin.flush()
      status = int(self._parent.stdout.readline())
      said = [each.read_text(encoding='utf-8') for each in streams]
    return subprocess.CompletedProcess(arguments, status, *said)

  @property
  def is_as_new(self) -> bool:
    """Whether a new process would begin with the same environment."""
    return _environment() == self._environment

  def close(self) -> None:
    """Ends it."""
    self._parent.stdin.close()
    self._parent.wait()
    self._parent.stdout.close()


def _environment() -> dict[str, str]:
  of_test = 'PYTEST_CURRENT_TEST'
  return {name: x for name, x in os.environ.items() if name != of_test}


def _stand_by() -> None:
  """Forks for each line of the input; returns in the fork."""
  for line in iter(sys.stdin.readline, ''):
    pid = os.fork()
    if not pid:
      _become(*json.loads(line))
      return
    status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    sys.stdout.write(f'{status}\n')
    sys.stdout.flush()
  sys.exit()


def _become(arguments: list[str], folder: str, out: str, err: str) -> None:
  os.chdir(folder)
  sys.path[0] = folder
  sys.argv[1:] = arguments
  write = os.O_WRONLY | os.O_CREAT
  for stream, (path, mode) in enumerate(
    ((os.devnull, os.O_RDONLY), (out, write), (err, write))
  ):
    file = os.open(path, mode)
    os.dup2(file, stream)
    os.close(file)


if __name__ == '__main__':
  import runpy

  # ruff: noqa: F401
  # Without flags, and without what draws in the simulator.
  from waggle_tasks import scenario
  from waggle_tasks.experiments.pages import link_page, run_page, suite_page

  with contextlib.suppress(ImportError):  # An extra.
    from matplotlib import figure

  _stand_by()
  runpy.run_module(_MAIN, run_name='__main__', alter_sys=True)
