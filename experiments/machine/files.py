"""Files and folders: one writer of a name at a time, and whole or not at all.

A name is claimed before it is written, by a lock on a hidden file beside it.
Locks end with their process: what one that was killed left behind is known by
its missing lock, and is used again.
"""

from collections.abc import Iterator
import contextlib
import errno
import fcntl
import os
import pathlib
import sys

_TRIES = 100  # Others may remove what was just opened.


def draft_of(path: pathlib.Path) -> pathlib.Path:
  """Where something is written until it is whole; only with its claim."""
  return path.with_name(f'.{path.name}.draft')


def leftovers(name: str) -> tuple[str, str]:
  """What a process that was killed may leave beside a name."""
  path = pathlib.Path(name)
  return draft_of(path).name, _claim_of(path).name


# What a user can mend, and no mistake of ours.
_OF_A_USER = {
  errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES,
  errno.EPERM, errno.ENAMETOOLONG, errno.EIO, errno.EMFILE, errno.ENFILE,
}  # fmt: skip


def problem(error: BaseException) -> str | None:
  """One line about a disk that is full or refuses; None for other errors."""
  if not isinstance(error, OSError) or error.errno not in _OF_A_USER:
    return None
  place = '' if error.filename is None else f'{error.filename}: '
  return f'{place}{error.strerror}'


def check_text(name: str, kind: type[Exception]) -> None:
  """Refuses a name that is no text: libraries fail with it, some badly.

  Args:
    name: What a user gave, or a path.
    kind: The error to raise.
  """
  try:
    name.encode()
  except UnicodeEncodeError:
    encoding = sys.getfilesystemencoding().upper()
    raise kind(
      f'names must be text in {encoding}: got {name!a}; give the file another'
      ' name'
    ) from None


class ClaimedError(Exception):
  """A name that somebody else is writing."""


@contextlib.contextmanager
def claimed(path: pathlib.Path, *, wait: bool = False) -> Iterator[None]:
  """Keeps a name from all others who claim it.

  Args:
    path: The name; nothing needs to be there. Its folder is made.
    wait: Whether to wait for those who have it.

  Raises:
    ClaimedError: if somebody has it, and this does not wait.
    OSError: if its folder cannot be written.
  """
  claim = _claim_of(path)
  descriptor = _lock(claim, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
  try:
    yield
  finally:
    claim.unlink(missing_ok=True)
    os.close(descriptor)


def replace(path: pathlib.Path, data: str | bytes) -> pathlib.Path:
  """Writes a file, or puts a new one in its place, as a whole.

  Whoever is writing it is waited for.

  Args:
    path: The file.
    data: See `put`.

  Returns:
    The path.

  Raises:
    OSError: see `put`.
  """
  with claimed(path, wait=True):
    return put(path, data)


def put(path: pathlib.Path, data: str | bytes) -> pathlib.Path:
  """Does what `replace` does, for those who have claimed the name.

  Args:
    path: The file.
    data: What it holds. Of text, what is no Unicode is written as escapes.

  Returns:
    The path.

  Raises:
    OSError: if it cannot be written; then the one before is as it was.
  """
  if isinstance(data, str):
    data = data.encode('utf-8', 'backslashreplace')
  draft = draft_of(path)
  try:
    draft.write_bytes(data)
    os.replace(draft, path)
  finally:
    draft.unlink(missing_ok=True)
  return path


def _claim_of(path: pathlib.Path) -> pathlib.Path:
  return path.with_name(f'.{path.name}.claim')


def _lock(claim: pathlib.Path, how: int) -> int:
  """Makes and locks a file; returns its descriptor."""
  for left in reversed(range(_TRIES)):
    try:
      claim.parent.mkdir(parents=True, exist_ok=True)
      descriptor = os.open(claim, os.O_RDWR | os.O_CREAT, 0o666)
    except FileNotFoundError:  # Whoever made the folder took it away again.
      if not left:
        raise
      continue
    try:
      fcntl.flock(descriptor, how)
      if _is_at(descriptor, claim):
        return descriptor
    except BlockingIOError:
      os.close(descriptor)
      break
    except BaseException:
      os.close(descriptor)
      raise
    os.close(descriptor)  # Who had it took it away: it locks nothing any more.
  raise ClaimedError(f'{claim} is in use')


def _is_at(descriptor: int, path: pathlib.Path) -> bool:
  """Whether an open file is the one that has a name now."""
  try:
    return os.path.samestat(os.fstat(descriptor), path.stat())
  except FileNotFoundError:
    return False
