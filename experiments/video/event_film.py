"""Events of an AEDAT4 file, added up into pictures; needs the extra [events].

An event says that a pixel has become brighter, or darker, by the contrast of
its camera (Lichtsteiner, Posch and Delbruck 2008,
doi:10.1109/JSSC.2007.914337). The sum of a pixel's events since the beginning
is how its logarithm of brightness differs from then: grey where nothing has
changed, whatever was to be seen. Nothing is filtered: what is left out once is
missing from every sum after it. How many grey levels an event is worth, and
that a pixel is shared out among its neighbours, so that a single event is none
to receivers, is chosen here.
"""

from collections.abc import Iterator
import math
import pathlib
from typing import Any

import cv2
import numpy as np

from waggle_tasks.experiments.video import sources

SUFFIX = '.aedat4'
FPS = 25.0  # Pictures a second, if nobody says: those of the paper's camera.
EXTRA = "pip install 'waggle-tasks[events]'"
_GREY, _LEVELS = 128, 20  # At first, and of an event...
_SHARED_PX = 1.0  # ...that is shared out so far.
_MOST_S = 1e6  # A longer step of time is none of a recording.
_US = 1e-6


class EventFilm:
  """A `Source`: the events of a camera, a picture for each step of time."""

  length_s = math.nan  # Known when all of it was read.

  def __init__(self, path: pathlib.Path, fps: float | None) -> None:
    """Opens a file.

    Args:
      path: The file.
      fps: How many pictures a second events are added up to; None for `FPS`.

    Raises:
      RecordingError: if the extra is not installed, the file is none, it has
        no events, or its picture is too small or too large.
    """
    try:
      import aedat
    except ImportError:
      raise sources.RecordingError(
        f'{path} holds events, which the extra [events] reads: {EXTRA}'
      ) from None
    self._path, self._step_s = path, 1 / (fps or FPS)
    try:
      self._decoder: Any = aedat.Decoder(path)
      streams = self._decoder.id_to_stream()
    except Exception as error:  # Whatever it says of a damaged file.
      raise self._damaged(error) from None
    found = [
      (number, each)
      for number, each in streams.items()
      if each['type'] == 'events'
    ]
    if not found:
      kinds = sorted({each['type'] for each in streams.values()})
      raise sources.RecordingError(
        f'{path} must hold a stream of events: got {", ".join(kinds) or "none"}'
      )
    self._stream, first = found[0]
    self.width, self.height = int(first['width']), int(first['height'])
    sources.check_size(path, self.width, self.height)

  def close(self) -> None:
    """Lets go of the file."""
    self._decoder = None

  def pictures(self) -> Iterator[sources.Timed]:
    """See `Source`."""
    sums = np.zeros((self.height, self.width))
    yield 0.0, lambda: _image(sums)
    waiting: list[np.ndarray] = []
    begin_us, count = None, 1
    for events in self._events():
      begin_us = int(events['t'][0]) if begin_us is None else begin_us
      times_s = (events['t'].astype(np.int64) - begin_us) * _US
      if not -self._step_s < times_s[0] or times_s[-1] > _MOST_S:
        raise self._damaged('its times leap')
      while len(times_s) and times_s[-1] >= count * self._step_s:
        cut = int(np.searchsorted(times_s, count * self._step_s))
        waiting.append(events[:cut])
        self._add(sums, waiting)
        waiting, events, times_s = [], events[cut:], times_s[cut:]
        yield count * self._step_s, lambda: _image(sums)
        count += 1
      waiting.append(events)
    self._add(sums, waiting)
    yield count * self._step_s, lambda: _image(sums)

  def _events(self) -> Iterator[np.ndarray]:
    """Packets of events, none of them empty."""
    decoder = iter(self._decoder)
    while True:
      try:
        packet = next(decoder)
      except StopIteration:
        return
      except Exception as error:
        raise self._damaged(error) from None
      if packet['stream_id'] == self._stream and len(packet['events']):
        yield packet['events']

  def _add(self, sums: np.ndarray, packets: list[np.ndarray]) -> None:
    """Adds events to the sums of their pixels."""
    events = np.concatenate(packets)
    shape = sums.shape
    if not len(events):
      return
    inside = (events['x'] < shape[1]) & (events['y'] < shape[0])
    if not inside.all():
      raise self._damaged('it has events outside of its picture')
    places = events['y'].astype(np.int64) * shape[1] + events['x']
    signs = np.where(events['on'], 1.0, -1.0)
    sums += np.bincount(places, signs, sums.size).reshape(shape)

  def _damaged(self, why: object) -> sources.RecordingError:
    return sources.RecordingError(
      f'{self._path} holds no events that can be read: it may be cut short or'
      f' damaged, or none of AEDAT4: {why}'
    )

  def check(self) -> None:
    """See `Source`; what is wrong was said when it was read."""

  def missing(self) -> str:
    """See `Source`: a file of events ends where it ends."""
    return ''


def _image(sums: np.ndarray) -> np.ndarray:
  """(H, W, 3) uint8 of the sums (H, W)."""
  soft = cv2.GaussianBlur(sums, (0, 0), _SHARED_PX)
  grey = np.clip(_GREY + _LEVELS * soft, 0, 255).astype(np.uint8)
  return cv2.cvtColor(grey, cv2.COLOR_GRAY2RGB)
