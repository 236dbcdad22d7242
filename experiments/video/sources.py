"""What a recording is read from: pictures, each with its time.

A broken, endless or hostile file costs a bounded time and memory and gives
one clear error.
"""

from collections.abc import Callable, Iterator
import fractions
import pathlib
from typing import Protocol

import cv2
import numpy as np

from waggle_tasks import errors

MIN_SIDE_PX, MAX_SIDE_PX = 16, 4096
OPEN_S, READ_S = 10, 10
EXTRA = "pip install 'waggle-tasks[video]'"  # What brings PyAV.

# The time of a picture, in s since the first one, and what makes it.
Timed = tuple[float, Callable[[], np.ndarray]]


class RecordingError(errors.WaggleError):
  """A file that is no readable video, or a part of it that does not exist."""


def no_times(path: pathlib.Path) -> RecordingError:
  """The error for pictures of which nobody knows when they were taken."""
  return RecordingError(
    f'{path} holds pictures without times: say how many a second with --fps'
  )


class Source(Protocol):
  """An open recording.

  Attributes:
    width: Of its pictures in pixels, as they are shown: upright, and every
      pixel as wide as it is high.
    height: The same.
    length_s: What its container announces for its pictures, as a hint; NaN
      when it does not.
  """

  width: int
  height: int
  length_s: float

  def pictures(self) -> Iterator[Timed]:
    """Reads on; call it once.

    Yields:
      Times as the recording has them, and (H, W, 3) uint8 RGB.

    Raises:
      RecordingError: when the recording turns out to be damaged.
    """
    ...

  def check(self) -> None:
    """Looks back when as much was read as was wanted.

    Raises:
      RecordingError: if what was given cannot be what was filmed.
    """
    ...

  def missing(self) -> str:
    """Why less may have been read than there was; empty when all was.

    Ask it at the end.
    """
    ...

  def close(self) -> None:
    """Lets go of the file."""
    ...


def check_size(path: pathlib.Path | str, width: int, height: int) -> None:
  """Refuses pictures that are too small or too large.

  Raises:
    RecordingError: naming the limit.
  """
  if max(width, height) > MAX_SIDE_PX:
    raise RecordingError(
      f'{path} must be at most {MAX_SIDE_PX} pixels wide and high:'
      f' got {width} x {height}'
    )
  if min(width, height) < MIN_SIDE_PX:
    raise RecordingError(
      f'{path} must be at least {MIN_SIDE_PX} pixels wide and high:'
      f' got {width} x {height}'
    )


def shown_width(width: int, aspect: fractions.Fraction | None) -> int:
  """How wide a picture is when its pixels become as wide as they are high.

  Args:
    width: As it is stored.
    aspect: Width of a stored pixel over its height; None when not known.
  """
  # Some cameras write nonsense here, which players pass over as well.
  if not aspect or not 0.25 <= aspect <= 4:
    return width
  return round(width * aspect)


def widened(image: np.ndarray, width: int) -> np.ndarray:
  """The picture in another width."""
  if image.shape[1] == width:
    return image
  size = width, image.shape[0]
  return cv2.resize(image, size, None, 0, 0, cv2.INTER_LINEAR)
