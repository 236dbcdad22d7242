"""Folders of results: claimed before the work, and there when it is done."""

from collections.abc import Iterator
import contextlib
import itertools
import os
import pathlib
import shutil

from waggle_tasks import errors
from waggle_tasks.experiments.machine import files


class OutputError(errors.WaggleError):
  """A folder that exists already or cannot be written."""


class TakenError(OutputError):
  """A name that exists, or that somebody else is about to write."""


@contextlib.contextmanager
def new_folder(path: pathlib.Path) -> Iterator[pathlib.Path]:
  """A folder that appears under its name only once it is complete.

  Its name is claimed before the work: of two who ask for it at once, one gets
  it, and the other is refused.

  Args:
    path: Where it should be; its parents are made.

  Yields:
    A hidden folder beside it to write into. It is renamed when the block
    ends, and removed when the block raises.

  Raises:
    OutputError: if `path` exists, is being written or cannot be written.
  """
  check_free(path)
  draft = files.draft_of(path)
  made = [parent for parent in draft.parents if not parent.exists()]
  try:
    with files.claimed(path):
      check_free(path)
      shutil.rmtree(draft, ignore_errors=True)  # Of one that was killed.
      try:
        draft.mkdir()
        yield draft
        os.rename(draft, path)
      finally:
        shutil.rmtree(draft, ignore_errors=True)
  except files.ClaimedError:
    raise TakenError(
      f'`output` must not be in use: another run is writing {path}'
    ) from None
  except BrokenPipeError:  # Of who read what was printed.
    raise
  except OSError as error:
    raise _refused(path, error) from None
  finally:
    for parent in made:  # The innermost first; those in use stay.
      with contextlib.suppress(OSError):
        parent.rmdir()


@contextlib.contextmanager
def next_folder(stem: str) -> Iterator[tuple[pathlib.Path, pathlib.Path]]:
  """The first of runs/STEM-1, runs/STEM-2, ... that nobody has or claims.

  Args:
    stem: How it begins.

  Yields:
    Its draft, as `new_folder` does, and the folder.

  Raises:
    OutputError: if it cannot be written.
  """
  with contextlib.ExitStack() as stack:
    for number in itertools.count(1):
      path = pathlib.Path('runs', f'{stem}-{number}')
      with contextlib.suppress(TakenError):
        draft = stack.enter_context(new_folder(path))
        break
    yield draft, path


@contextlib.contextmanager
def claimed(path: pathlib.Path, field: str) -> Iterator[None]:
  """Keeps the name of a new file until it is written.

  Args:
    path: The file.
    field: The flag that names it.

  Raises:
    OutputError: if it exists, its folder does not, or somebody writes it.
  """
  with contextlib.ExitStack() as stack:
    try:
      if path.absolute().parent.is_dir():
        stack.enter_context(files.claimed(path))
    except files.ClaimedError:
      raise TakenError(
        f'`{field}` must not be in use: another run is writing {path}'
      ) from None
    except OSError as error:
      raise OutputError(
        f'`{field}` must be writable: {path}: {error.strerror}'
      ) from None
    if os.path.lexists(path) or not path.absolute().parent.is_dir():
      raise OutputError(
        f'`{field}` must be a new file in a folder that exists: got'
        f' {str(path)!r}'
      )
    yield


def check_free(path: pathlib.Path) -> None:
  """Refuses an output folder that exists or cannot be made, before work.

  Raises:
    OutputError: naming the folder and the reason.
  """
  if path.name in ('', '..'):
    raise OutputError(f'`output` must end in a name: got {path}')
  if os.path.lexists(path):
    raise TakenError(f'`output` must not exist yet: {path} does')
  check_writable(path)


def check_writable(folder: pathlib.Path) -> None:
  """Refuses a folder that cannot be written, or made, before work.

  Raises:
    OutputError: naming the folder that is in the way.
  """
  there = [folder.absolute(), *folder.absolute().parents]
  first = next(path for path in there if os.path.lexists(path))
  if not first.is_dir() or not os.access(first, os.W_OK | os.X_OK):
    raise OutputError(f'`output` must be writable: {first} is not')


def _refused(path: pathlib.Path, error: OSError) -> OutputError:
  return OutputError(f'`output` must be writable: {path}: {error.strerror}')
