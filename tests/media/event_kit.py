"""Makes AEDAT4 files of pictures, as a camera of events would."""

from collections.abc import Iterable
import pathlib

import cv2
import numpy as np

_CONTRAST = 0.2  # Of the logarithm of brightness, for one event.
_NOISE_HZ = 100  # Events of nothing, a second, anywhere.
_BEGIN_US = 1_700_000_000_000_000  # Such cameras give times since 1970.


def write(
  path: pathlib.Path, images: Iterable[tuple[np.ndarray, float]]
) -> pathlib.Path:
  """Writes the events of pictures, (H, W, 3) uint8 RGB, and their times.

  Brightness changes steadily from one picture to the next.
  """
  import dv_processing as dv

  rng = np.random.RandomState(0)
  writer, known, before_s = None, np.empty(0), 0.0
  for image, time_s in images:
    grey = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    bright = np.log(grey.astype(float) + 5.0)
    if writer is None:
      config = dv.io.MonoCameraWriter.EventOnlyConfig(
        'DVXplorer_sample', grey.shape[::-1]
      )
      writer, known = dv.io.MonoCameraWriter(str(path), config), bright
    steps = np.trunc((bright - known) / _CONTRAST).astype(int)
    known = known + steps * _CONTRAST
    rows, columns = np.nonzero(steps)
    found = []
    for y, x in zip(rows.tolist(), columns.tolist(), strict=True):
      step = int(steps[y, x])
      for part in range(abs(step)):
        share = (part + 1) / (abs(step) + 1)
        at_s = before_s + share * (time_s - before_s)
        found.append((_BEGIN_US + round(at_s * 1e6), x, y, step > 0))
    noise = rng.poisson(_NOISE_HZ * (time_s - before_s))
    for share in rng.random_sample(noise):
      y, x = (int(rng.randint(side)) for side in grey.shape)
      at_s = before_s + share * (time_s - before_s)
      found.append((_BEGIN_US + round(at_s * 1e6), x, y, bool(rng.randint(2))))
    store = dv.EventStore()
    for each in sorted(found):
      store.push_back(*each)
    if found:
      writer.writeEvents(store)
    before_s = time_s
  del writer
  return path
