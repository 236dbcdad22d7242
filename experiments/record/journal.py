"""A journal: a file of lines, each of them on the disk once it is written.

Every line begins with a hash of the rest: one that was torn by a sudden end,
or touched since, is told from a whole one and passed over.
"""

from collections.abc import Iterator
import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
from typing import Any

from waggle_tasks.experiments.record import encoding

_DIGITS = 16  # Of the hash; enough to notice damage.


class Journal:
  """Adds lines to a journal."""

  def __init__(self, descriptor: int) -> None:
    """Makes a journal; see `opened`.

    Args:
      descriptor: Of its file, open for appending.
    """
    self._descriptor = descriptor

  def append(self, row: object) -> None:
    """Writes a line and waits until it is on the disk.

    Raises:
      OSError: if it cannot be written; then nothing of it is left.
    """
    line = encoding.dumps(row).encode()
    data = _hash(line) + b' ' + line + b'\n'
    size = os.fstat(self._descriptor).st_size
    try:
      while data:
        data = data[os.write(self._descriptor, data) :]
      _settle(self._descriptor)
    except OSError:
      os.ftruncate(self._descriptor, size)
      raise


def _settle(descriptor: int) -> None:
  """Waits until what was written is on the disk."""
  os.fsync(descriptor)
  if hasattr(fcntl, 'F_FULLFSYNC'):  # On macOS, fsync leaves it in the drive.
    with contextlib.suppress(OSError):  # Not every file system has it.
      fcntl.fcntl(descriptor, fcntl.F_FULLFSYNC)


@contextlib.contextmanager
def opened(path: pathlib.Path) -> Iterator[Journal]:
  """Opens a journal to go on with it; a torn last line is cut off.

  Args:
    path: Its file, made if needed.

  Raises:
    OSError: if it cannot be opened.
  """
  descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
  try:
    whole = path.read_bytes().rfind(b'\n') + 1
    os.ftruncate(descriptor, whole)
    yield Journal(descriptor)
  finally:
    os.close(descriptor)


def read(path: pathlib.Path) -> list[Any]:
  """The whole lines of a journal, in the order in which they were written.

  Raises:
    OSError: if there is a file that cannot be read.
    FormatError: if a newer program wrote one.
  """
  if not path.exists():
    return []
  lines = path.read_bytes().split(b'\n')[:-1]  # What follows is torn.
  pairs = [line.partition(b' ') for line in lines]
  rows = [json.loads(line) for said, _, line in pairs if said == _hash(line)]
  for row in rows:
    encoding.check_format(row, path)
  return rows


def _hash(line: bytes) -> bytes:
  return hashlib.sha256(line).hexdigest()[:_DIGITS].encode()
