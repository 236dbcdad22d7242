"""What a hand-made receiver reads of the tracks that learners get."""

from typing import TYPE_CHECKING

import numpy as np

from waggle_tasks.agents import receiver, tracks

if TYPE_CHECKING:
  from waggle_tasks.rl import glimpses

RECEIVER = 'joint'


def share(seen: 'glimpses.Glimpses', seed: int = 0, count: int = 128) -> float:
  """The share of payloads that it reads.

  Args:
    seen: How dances are seen.
    seed: Of the dances, and of how each is seen.
    count: How many dances.
  """
  rng = np.random.default_rng(seed)
  values = rng.integers(2**seen.num_bits, size=count)
  rows = seen.draw(values, rng)
  words = [f'{value:0{seen.num_bits}b}' for value in values]
  return float(
    np.mean(
      [_read(seen, row) == word for row, word in zip(rows, words, strict=True)]
    )
  )


def _read(seen: 'glimpses.Glimpses', rows: np.ndarray) -> str | None:
  """The first message that it reads of one track (frames, 4)."""
  camera = seen.agreement.camera
  middle_px = np.array(camera.size) / 2
  places_px = middle_px + rows[:, :2] * (1, -1) * camera.size[0] / 2
  places_px[rows[:, 2] == 0] = np.nan
  reader = tracks.make(RECEIVER, seen.agreement)
  for (x_px, y_px), time_s in zip(places_px, rows[:, 3].cumsum(), strict=True):
    for event in receiver.step(reader, tracks.place(x_px, y_px), float(time_s)):
      if event.message is not None:
        return event.message.bits
  return None
