"""Silence for libraries that write to the terminal past Python."""

from collections.abc import Iterator
import contextlib
import os
import sys

_ERRORS = 2  # File descriptor of standard error.

# OpenCV's FFmpeg asks once, when it is first used, how much it should say: -8
# is nothing. What is wrong with a file is said by the error that it leads to.
os.environ.setdefault('OPENCV_FFMPEG_LOGLEVEL', '-8')


@contextlib.contextmanager
def quiet() -> Iterator[None]:
  """Drops what the process writes to standard error, C libraries included.

  For short calls only: whatever another thread says meanwhile is lost too.
  """
  sys.stderr.flush()
  kept = os.dup(_ERRORS)
  nowhere = os.open(os.devnull, os.O_WRONLY)
  try:
    os.dup2(nowhere, _ERRORS)
    yield
  finally:
    os.dup2(kept, _ERRORS)
    os.close(kept)
    os.close(nowhere)
