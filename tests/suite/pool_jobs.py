"""What worker processes do in tests: here, for them to import by name."""

from collections.abc import Callable
import os
import pathlib
import signal
import time

Report = Callable[[float], None]


def double(report: Report, number: int) -> int:
  """Reports twice and returns a number's double."""
  report(0.25)
  report(0.75)
  return 2 * number


def fail(report: Report) -> None:
  """Raises."""
  del report
  raise ValueError('no such luck')


def die(report: Report, tries: pathlib.Path, deaths: int) -> str:
  """Ends its own process for the first times, as if somebody killed it.

  Args:
    report: Told once, so that death comes in the middle.
    tries: A file that gets a line for each try.
    deaths: How many times.
  """
  report(1.0)
  if _count(tries) <= deaths:
    os.kill(os.getpid(), signal.SIGKILL)
  return 'alive'


def leave(report: Report, torn: bool) -> None:
  """Ends its own process, if `torn` in the middle of a message."""
  (pipe,) = (cell.cell_contents for cell in report.__closure__)
  if torn:
    os.write(pipe.fileno(), b'\x00\x00\x00\x64half')  # 100 bytes, it says.
  os._exit(1)


def hang(report: Report, tries: pathlib.Path, hangs: int) -> str:
  """Says nothing for a minute, the first times."""
  del report
  if _count(tries) <= hangs:
    time.sleep(60)
  return 'awake'


def chatter(report: Report, tries: pathlib.Path, duration_s: float) -> str:
  """Takes long, and reports all the while."""
  _count(tries)
  end_s = time.monotonic() + duration_s
  while time.monotonic() < end_s:
    report(1.0)
    time.sleep(0.05)
  return 'done'


def _count(tries: pathlib.Path) -> int:
  """Adds the process's id as a line and returns how many there are."""
  with tries.open('a', encoding='utf-8') as file:
    file.write(f'{os.getpid()}\n')
  return len(tries.read_text(encoding='utf-8').splitlines())
