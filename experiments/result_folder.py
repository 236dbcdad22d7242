"""A folder of results: one writer at a time, and files whole or not at all."""

from collections.abc import Collection, Iterator
import contextlib
import fcntl
import os
import pathlib

from waggle_tasks.experiments import records

_LOCK = '.lock'


@contextlib.contextmanager
def locked(
  folder: pathlib.Path, names: Collection[str], what: str
) -> Iterator[None]:
  """Makes a folder and keeps others from writing into it.

  Args:
    folder: Where results are kept.
    names: What it may hold; drafts of these too.
    what: Whose results, for people.

  Raises:
    OutputError: if the folder is in use, holds something else or cannot be
      written, here or in the block.
  """
  try:
    folder.mkdir(parents=True, exist_ok=True)
    known = {_LOCK, *names, *map(_draft_name, names)}
    strange = {p.name for p in folder.iterdir()} - known
    if strange:
      raise records.OutputError(
        f'`output` must be new or hold results of a {what}: {folder} holds'
        f' {sorted(strange)[0]}'
      )
    with (folder / _LOCK).open('w') as lock:
      fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
      yield
  except BlockingIOError:
    raise records.OutputError(
      f'`output` must not be in use: another run is writing {folder}'
    ) from None
  except OSError as error:
    raise records.OutputError(
      f'`output` must be writable: {folder}: {error.strerror}'
    ) from None


def replace(path: pathlib.Path, text: str) -> None:
  """Writes a file, or puts a new one in its place, as a whole."""
  draft = path.with_name(_draft_name(path.name))
  draft.write_text(text, encoding='utf-8')
  os.replace(draft, path)


def _draft_name(name: str) -> str:
  return f'.{name}.draft'
