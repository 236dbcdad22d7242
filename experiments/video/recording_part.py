"""Which part of a recording is read: its time, its place and its speed."""

import dataclasses

from waggle_tasks.experiments.video import sources
from waggle_tasks.protocol import checks

RecordingError = sources.RecordingError


@dataclasses.dataclass(frozen=True)
class RecordingPart:
  """Which part of a recording is read.

  Attributes:
    start_s: First moment, in s since its first picture.
    end_s: Last moment, or None for all there is.
    roi: Left, top, width and height of the part of the picture, in pixels as
      it is shown; None for all of it.
    anchor_px: Where the target hovers first, x right and y down in the whole
      picture; None for the middle of the part.
    speed: Seconds of the dance in a second of the recording.
  """

  start_s: float = 0.0
  end_s: float | None = None
  roi: tuple[int, int, int, int] | None = None
  anchor_px: tuple[float, float] | None = None
  speed: float = 1.0

  def __post_init__(self) -> None:
    checks.number('start', self.start_s, 0.0, 1e6, RecordingError)
    checks.number('speed', self.speed, 0.01, 100.0, RecordingError)
    if self.end_s is not None:
      checks.number('end', self.end_s, 0.0, 1e6, RecordingError)
      if self.end_s <= self.start_s:
        raise RecordingError(
          f'`end` must be later than `start`, {self.start_s:g} s:'
          f' got {self.end_s:g} s'
        )
    if self.roi is not None and not (
      min(self.roi[:2]) >= 0 and min(self.roi[2:]) >= 16
    ):
      raise RecordingError(
        '`roi` must be left, top, width, height in pixels, at least 16 wide'
        f' and high: got {",".join(map(str, self.roi))}'
      )

  def crop(self, width: int, height: int) -> tuple[slice, slice]:
    """Which rows and columns of a picture are read.

    Args:
      width: Of the picture in pixels.
      height: The same.

    Raises:
      RecordingError: if they are not all in it.
    """
    if self.roi is None:
      return slice(0, height), slice(0, width)
    left, top, across, down = self.roi
    if left + across > width or top + down > height:
      raise RecordingError(
        f'`roi` must lie in the picture, {width} x {height}:'
        f' got {",".join(map(str, self.roi))}'
      )
    return slice(top, top + down), slice(left, left + across)

  def border(self, rows: slice, columns: slice) -> tuple[int, int, int, int]:
    """What to add at the top, bottom, left and right to centre the anchor.

    Args:
      rows: As `crop` gives them.
      columns: The same.

    Raises:
      RecordingError: if the anchor is in none of them.
    """
    if self.anchor_px is None:
      return 0, 0, 0, 0
    x, y = self.anchor_px
    if not (columns.start <= x < columns.stop and rows.start <= y < rows.stop):
      raise RecordingError(
        f'`anchor` must lie in the part that is read: got {x:g},{y:g}'
      )
    right = round(2 * (x - columns.start) - (columns.stop - columns.start))
    bottom = round(2 * (y - rows.start) - (rows.stop - rows.start))
    return max(-bottom, 0), max(bottom, 0), max(-right, 0), max(right, 0)
