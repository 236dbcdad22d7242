"""The terminal and the signals of a command, as they really are.

What is printed may be of letters that a terminal does not have, may go to a
reader who has seen enough, and may end with the terminal itself.
"""

from collections.abc import Callable
import contextlib
import io
import os
import select
import signal
import sys
from typing import TextIO

from waggle_tasks.experiments.machine import files

READER_GONE = 141  # What shells give for a program that SIGPIPE ended.
NOT_PRINTED = 2
_ERRORS = 2  # File descriptor of standard error, the last of three.


def prepare() -> None:
  """Makes polite ends interrupt, and printing never fail because of a letter.

  A kill or a closed terminal ends like Ctrl-C: what is half written is
  removed. Who asked not to be told of one, as `nohup` does, is not.
  """
  for number in (signal.SIGTERM, signal.SIGHUP):
    if signal.getsignal(number) is not signal.SIG_IGN:
      signal.signal(number, signal.default_int_handler)
  _open_closed()
  for stream in (sys.stdout, sys.stderr):
    if isinstance(stream, io.TextIOWrapper):
      stream.reconfigure(errors='backslashreplace')


def told(work: Callable[[], int]) -> int:
  """What work returns, once everything that it printed has arrived.

  `waggle ... | head -1` has what it wanted: no complaint, now or at the end,
  when Python writes what is left; the status is 141, as usual.
  """
  try:
    status = work()
  except BrokenPipeError:
    if not any(map(_is_dead, (sys.stdout, sys.stderr))):
      raise  # Another pipe, to a worker.
    status = READER_GONE
  except OSError as error:
    status = _not_printed(error)
  for stream in (sys.stdout, sys.stderr):
    try:
      stream.flush()
    except BrokenPipeError:
      status = READER_GONE
      _silence(stream)
    except OSError as error:
      _silence(stream)
      if status != NOT_PRINTED:  # Else it was told.
        status = _not_printed(error)
  return status


def _not_printed(error: OSError) -> int:
  line = files.problem(error)
  if line is None:
    raise error
  with contextlib.suppress(OSError):
    print(f'waggle: cannot print: {line}', file=sys.stderr)
  return NOT_PRINTED


def _open_closed() -> None:
  """Gives what was closed from outside (`2>&-`) a place where nothing stays.

  Another file would be opened in its place, and be written over.
  """
  while (descriptor := os.open(os.devnull, os.O_RDWR)) <= _ERRORS:
    pass
  os.close(descriptor)
  for name in ('stdout', 'stderr'):
    if getattr(sys, name) is None:
      nowhere = open(os.devnull, 'w', encoding='utf-8')  # noqa: SIM115
      setattr(sys, name, nowhere)


def _is_dead(stream: TextIO) -> bool:
  """Whether nobody reads a stream any more."""
  try:
    descriptor = stream.fileno()
  except (OSError, ValueError):  # Kept in memory, or closed.
    return False
  if not hasattr(select, 'poll'):  # Python hides it where it is broken.
    return True
  poll = select.poll()
  poll.register(descriptor, select.POLLOUT)
  gone = select.POLLERR | select.POLLHUP
  return any(event & gone for _, event in poll.poll(0))


def _silence(stream: TextIO) -> None:
  """Drops what is left to be written: Python tries again when it ends."""
  nowhere = os.open(os.devnull, os.O_WRONLY)
  os.dup2(nowhere, stream.fileno())
  os.close(nowhere)
