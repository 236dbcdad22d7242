"""Tracks as a good tracker would give them, by the pinhole model alone."""

from collections.abc import Iterator, Sequence

import numpy as np

from waggle_tasks.agents import receiver, tracks
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import performance

AFTER_S = 4.0  # What is seen after a dance.
# What a camera may do to the right and down of its picture.
VIEWS = {
  'upright': ((1, 0), (0, 1)),
  'behind': ((-1, 0), (0, 1)),
  'upside down': ((-1, 0), (0, -1)),
  'upside down and mirrored': ((1, 0), (0, -1)),
  'on its side': ((0, -1), (1, 0)),
}


def seen(
  agreed: agreement_lib.Agreement,
  flown: performance.Performance,
  angle_deg: float = 20.0,
  distance_m: float = 1.3,
  view: str = 'upright',
  rate_hz: float = 25.0,
  noise_px: float = 0.2,
) -> tuple[np.ndarray, np.ndarray]:
  """Times (T,) and places in pixels (T, 2) of a dance."""
  schedule = flown.schedule
  times_s = np.arange(0, schedule.end_s + AFTER_S, 1 / rate_hz)
  ways_m = np.array([schedule.motion(float(t))[0][:2] for t in times_s])
  angle = np.radians(angle_deg)
  away_m = distance_m - ways_m[:, 0] * np.sin(angle)
  offsets_m = np.stack([ways_m[:, 0] * np.cos(angle), -ways_m[:, 1]], axis=1)
  noise = np.random.RandomState(0).normal(0, noise_px, ways_m.shape)
  places = agreed.camera.focal_px * offsets_m / away_m[:, None] + noise
  middle = np.array(agreed.camera.size) / 2
  return times_s, places @ np.array(VIEWS[view]).T + middle


def read(
  name: str,
  agreed: agreement_lib.Agreement,
  rows: tuple[np.ndarray, np.ndarray],
) -> list[receiver.Event]:
  """What a receiver confirms of a track; NaN is where nothing was seen."""
  work = tracks.make(name, agreed)
  return [
    event
    for time_s, (x, y) in zip(*rows, strict=True)
    for event in receiver.step(work, tracks.place(x, y), float(time_s))
  ]


def said(events: Sequence[receiver.Event]) -> str | None:
  """The bits of the first message."""
  return next(_bits(events), None)


def _bits(events: Sequence[receiver.Event]) -> Iterator[str]:
  return (event.message.bits for event in events if event.message)
