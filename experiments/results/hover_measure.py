"""What a hover does, as it was measured: medians over windows of 4 s.

A window's mean is removed; what is told of it are the root mean square of
place, attitude and speed, and that of each band, of a spectrum by Hann.
"""

from collections.abc import Mapping, Sequence
import itertools

import numpy as np

from waggle_tasks.tasks import hover, hover_presets

AXES = 'x', 'y', 'z', 'roll', 'pitch', 'yaw'
BANDS = hover_presets.BANDS
WINDOW_S = 4.0
EDGES_HZ = hover.EDGES_HZ[1:]


def signal(
  spectrum: hover.Spectrum, seed: int, seconds: float, rate_hz: float = 25.0
) -> tuple[np.ndarray, np.ndarray]:
  """One vehicle's hover, once it has grown.

  Args:
    spectrum: How strong it is in each band.
    seed: What it is drawn from.
    seconds: How long it is.
    rate_hz: How often it is looked at.

  Returns:
    (T, 6) x, y and z in mm, roll, pitch and yaw in degrees; (T, 3) their
    speeds in mm/s.
  """
  drawn = hover.Hover(spectrum, 1.0, np.random.RandomState(seed))
  times_s = hover.GROWTH_S + np.arange(round(seconds * rate_hz)) / rate_hz
  places = np.stack([drawn.place(t)[:2] for t in times_s]) * 1000  # (T, 2, 3)
  attitudes = np.stack([drawn.attitude(t)[0] for t in times_s])  # (T, 3)
  moved = np.concatenate([places[:, 0], np.degrees(attitudes)], axis=1)
  return moved, places[:, 1]


def figures(
  spectrum: hover.Spectrum, seeds: int = 8, seconds: float = 80.0
) -> Mapping[str, hover_presets.Figures]:
  """What windows of several signals show, as a preset's source has it.

  Args:
    spectrum: What the signals are drawn from.
    seeds: How many signals there are.
    seconds: How long each of them is.
  """
  rate_hz = 25.0
  drawn = [signal(spectrum, each, seconds, rate_hz) for each in range(seeds)]
  size = frames(rate_hz)
  moved, speeds = (
    np.concatenate([each[part] for each in drawn]).reshape(-1, size, columns)
    for part, columns in ((0, 6), (1, 3))
  )
  return of_windows(AXES, moved, speeds, rate_hz)


def frames(rate_hz: float) -> int:
  """How many samples a window has."""
  return round(WINDOW_S * rate_hz)


def of_windows(
  axes: Sequence[str],
  moved: np.ndarray,  # (N, T, K)
  speeds: np.ndarray,  # (N, T, S)
  rate_hz: float,
) -> Mapping[str, hover_presets.Figures]:
  """What windows show, as a preset's source has it: by axis, medians.

  Args:
    axes: Names of the K axes.
    moved: N windows of T samples, see `frames`, in mm or degrees.
    speeds: The speeds in mm/s along the first S axes.
    rate_hz: How many samples there are in a second.
  """
  moved = moved - moved.mean(axis=1, keepdims=True)
  speeds = speeds - speeds.mean(axis=1, keepdims=True)
  size = moved.shape[1]
  window = np.hanning(size)[:, None]
  waves = np.fft.rfft(moved * window, axis=1)
  power = 2 * np.abs(waves) ** 2 / (window**2).sum() / size
  hz = np.fft.rfftfreq(size, 1 / rate_hz)
  out: dict[str, dict[str, float]] = {
    axis: {'rms': _median(rms)}
    for axis, rms in zip(axes, (moved**2).mean(axis=1).T, strict=True)
  }
  for axis, rms in zip(axes, (speeds**2).mean(axis=1).T, strict=False):
    out[axis]['speed'] = _median(rms)
  edges = itertools.pairwise(EDGES_HZ)
  for name, (low, high) in zip(BANDS, edges, strict=True):
    inside = power[:, (hz > low) & (hz <= high)].sum(axis=1)
    for axis, each in zip(axes, inside.T, strict=True):
      out[axis][name] = _median(each)
  return out


def _median(powers: np.ndarray) -> float:
  return float(np.median(np.sqrt(powers)))
