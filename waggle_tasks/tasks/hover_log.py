"""The hover of a log of one's own, as a spectrum that can be flown."""

import numpy as np

from waggle_tasks.tasks import hover

SHORTEST_S = 20.0  # To show waves that take several seconds.
_SLOWEST_HZ = 2 * hover.EDGES_HZ[-1]  # Of a log that shows the fastest band.
# A link may lose a sample or two; what happened in a longer time is not known.
_GAP_SAMPLES = 3.5
# Longer parts would show what a hover does once: its slowest wave is of 50 s.
_PART_S = 1 / hover.EDGES_HZ[0]
_DECIMALS = 4  # Of a millimetre and of a degree.


class LogError(hover.HoverError):
  """A log from which no hover can be taken."""


def spectrum(
  time_s: np.ndarray,  # (T,)
  position_m: np.ndarray,  # (T, 3)
  roll_pitch_yaw_deg: np.ndarray,  # (T, 3)
) -> hover.Spectrum:
  """How strong a log's hover is in each band.

  Args:
    time_s: When each line was taken; at least 20 s, at 20 Hz or faster.
    position_m: World x, y and z.
    roll_pitch_yaw_deg: Attitude in degrees.

  Raises:
    LogError: naming what is wrong with the log.
  """
  times = _times(time_s)
  columns = [
    _columns(name, values, len(times))
    for name, values in (
      ('position_m', position_m),
      ('roll_pitch_yaw_deg', roll_pitch_yaw_deg),
    )
  ]
  moved = np.concatenate(columns, axis=1)  # (T, 6)
  moved[:, 3:] = np.unwrap(moved[:, 3:], period=360.0, axis=0)
  step_s = np.median(np.diff(times))
  even = np.arange(times[0], times[-1], step_s)
  moved = np.stack([np.interp(even, times, each) for each in moved.T], axis=1)
  rms = np.round(_bands(moved * ([1000] * 3 + [1] * 3), step_s), _DECIMALS)
  try:
    return hover.Spectrum(*map(tuple, rms.tolist()))
  except hover.HoverError as error:
    raise LogError(f'a log must be of a vehicle that hovers: {error}') from None


def _times(time_s: np.ndarray) -> np.ndarray:
  """Refuses times that are too short, too slow, or have gaps."""
  times = _numbers('time_s', time_s)
  if times.ndim != 1 or len(times) < 2:
    raise LogError(f'`time_s` must be (T,) numbers: got {times.shape}')
  steps = np.diff(times)
  if (steps <= 0).any():
    line = int(np.argmax(steps <= 0)) + 1
    raise LogError(
      f'`time_s` must rise: got {times[line]:g} after {times[line - 1]:g} s,'
      f' sample {line}'
    )
  length_s = times[-1] - times[0]
  if length_s < SHORTEST_S:
    raise LogError(
      f'`time_s` must be at least {SHORTEST_S:g} s of hover: got'
      f' {length_s:.3g} s'
    )
  usual = float(np.median(steps))
  if usual > 1 / _SLOWEST_HZ + 1e-6:
    raise LogError(
      f'`time_s` must have at least {_SLOWEST_HZ:g} samples a second: got'
      f' {1 / usual:.3g}'
    )
  if (steps > _GAP_SAMPLES * usual).any():
    worst = int(np.argmax(steps))
    raise LogError(
      f'`time_s` must have no gap: got {steps[worst]:.3g} s without a sample'
      f' after {times[worst]:g} s'
    )
  return times


def _columns(name: str, values: np.ndarray, count: int) -> np.ndarray:
  array = _numbers(name, values)
  if array.shape != (count, 3):
    raise LogError(
      f'`{name}` must be ({count}, 3) numbers, a line for each of `time_s`:'
      f' got {array.shape}'
    )
  if not np.ptp(array, axis=0).any():  # Of a link that did not carry it.
    raise LogError(
      f'`{name}` must change, as it does in any hover: got {array[0].tolist()}'
      f' in all {count} samples'
    )
  return array


def _numbers(name: str, values: np.ndarray) -> np.ndarray:
  try:
    array = np.array(values, dtype=float)
  except (TypeError, ValueError):
    raise LogError(f'`{name}` must be numbers: got {values!r}') from None
  if not np.isfinite(array).all():
    first = tuple(np.argwhere(~np.isfinite(array))[0].tolist())
    raise LogError(
      f'`{name}` must be finite numbers: got {array[first]} in sample'
      f' {first[0]}'
    )
  return array


def _bands(
  moved: np.ndarray,  # (T, 6)
  step_s: float,
) -> np.ndarray:  # (6, B)
  """Root mean square in each band, over parts that overlap by half."""
  size = min(len(moved), round(_PART_S / step_s))
  starts = np.arange(0, len(moved) - size + 1, max(1, size // 2))
  window = np.hanning(size)[:, None]
  powers = []
  for start in starts:
    part = moved[start : start + size]
    waves = np.fft.rfft((part - part.mean(axis=0)) * window, axis=0)
    powers.append(2 * np.abs(waves) ** 2 / (window**2).sum() / size)
  power = np.mean(powers, axis=0)
  hz = np.fft.rfftfreq(size, step_s)
  return np.sqrt(
    [
      power[(hz >= low) & (hz < high)].sum(axis=0)
      for low, high in zip(hover.EDGES_HZ, hover.EDGES_HZ[1:], strict=False)
    ]
  ).T
