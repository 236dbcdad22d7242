"""A folder of results: one writer at a time."""

from collections.abc import Collection, Iterator
import contextlib
import fcntl
import itertools
import pathlib

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import folders

_LOCK = '.lock'


@contextlib.contextmanager
def locked(
  folder: pathlib.Path, names: Collection[str], what: str
) -> Iterator[None]:
  """Makes a folder and keeps others from writing into it.

  Args:
    folder: Where results are kept.
    names: What it may hold, and what is left where one was half written.
    what: Whose results, for people.

  Raises:
    OutputError: if the folder is in use, holds something else or cannot be
      written, here or in the block.
  """
  try:
    folder.mkdir(parents=True, exist_ok=True)
    rest = itertools.chain.from_iterable(map(files.leftovers, names))
    known = {_LOCK, *names, *rest}
    strange = {p.name for p in folder.iterdir()} - known
    if strange:
      raise folders.OutputError(
        f'`output` must be new or hold results of a {what}: {folder} holds'
        f' {sorted(strange)[0]}'
      )
    with (folder / _LOCK).open('w') as lock:
      fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
      yield
  except BlockingIOError:
    raise folders.OutputError(
      f'`output` must not be in use: another run is writing {folder}'
    ) from None
  except BrokenPipeError:  # Of who read what was printed.
    raise
  except OSError as error:
    raise folders.OutputError(
      f'`output` must be writable: {folder}: {error.strerror}'
    ) from None
