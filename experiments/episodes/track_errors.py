"""The errors of a tracker: fitted to a rendered broadcast, and drawn anew."""

from collections.abc import Sequence

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import ladder_table, sight_lines

_FEWEST = 10  # Images that tell of errors.
_RANDOM = np.random.Generator
# Of a target that is never found: it never moves far enough.
_NEVER = ladder_table.Track(
  (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), 1.0, 1.0, 1e9
)


def fit(
  sight: sight_lines.Sight,
  frames: Sequence[int],
  centres_px: np.ndarray,  # (K, 2)
  valid: np.ndarray,  # (K,)
  moved_px: float,
) -> ladder_table.Track | None:
  """What a tracker did in one broadcast; None where it hardly saw anything.

  Args:
    sight: Where the target was.
    frames: The frames that it was shown, black ones apart, since the target
      had left its place.
    centres_px: Where it believed the target to be in each.
    valid: In which it saw the target.
    moved_px: How far the target had moved when it was found.
  """
  rows = np.asarray(frames, int)
  able = sight.inside[rows]
  rows, centres_px, valid = rows[able], centres_px[able], valid[able]
  if valid.sum() < _FEWEST:
    return None
  true_px = sight.places_px[rows[valid]]
  off_px = centres_px[valid] - true_px
  height_px = true_px[:, 1] - sight.places_px[0, 1]
  table = np.stack([np.ones(len(height_px)), height_px], axis=1)
  found, *_ = np.linalg.lstsq(table, off_px, rcond=None)
  left_px = off_px - table @ found
  spread_px = left_px.std(axis=0)
  memory = (left_px[1:] * left_px[:-1]).mean(axis=0)
  memory /= np.maximum(spread_px**2, 1e-9)
  lost = 1 - valid.mean()
  begins = int((~valid[1:] & valid[:-1]).sum()) + int(not valid[0])
  run = int((~valid).sum()) / max(begins, 1)
  return ladder_table.Track(
    _pair(found[0]), _pair(found[1]), _pair(spread_px),
    _pair(np.clip(memory, -0.99, 0.99)), round(float(lost), 4),
    round(float(run), 2), round(moved_px, 2),
  )  # fmt: skip


def _pair(values: np.ndarray) -> tuple[float, float]:
  x, y = (round(float(each), 4) for each in values)
  return x, y


def cells(
  table: ladder_table.Table,
  scene: scenario.Scenario,
  distance_m: float,
  angle_deg: float,
) -> list[tuple[float, ladder_table.Cell]]:
  """The measured cells about an observer's place, with weights that sum to 1.

  Less noise than was measured is as often as noisy as it is strong.

  Raises:
    LadderError: if nothing was measured there.
  """
  sigma, most = scene.sensor.noise_sigma, ladder_table.NOISE_SIGMA
  hovers = scene.drift.performer_hover != 'none'
  if sigma > most or (sigma and hovers):
    raise ladder_table.LadderError(
      f'`noise_sigma` must be 0 to {most:g}, and 0 where vehicles hover, at'
      f" fidelity 'tracks': got {sigma:g}"
    )
  conditions = {ladder_table.MOCAP: 1.0} if hovers else {
    ladder_table.CALM: 1 - sigma / most, ladder_table.NOISE: sigma / most
  }  # fmt: skip
  return [
    (share * weight, cell)
    for condition, share in conditions.items()
    if share
    for weight, cell in table.about(condition, distance_m, angle_deg)
  ]


def pick(
  table: ladder_table.Table,
  scene: scenario.Scenario,
  sight: sight_lines.Sight,
  rng: _RANDOM,
) -> tuple[ladder_table.Track, float]:
  """The errors of one measured broadcast, of the cells about a sight.

  In some the target was never found.

  Returns:
    The errors, and pixels there over those at the measured place.

  Raises:
    LadderError: if nothing was measured there.
  """
  about = cells(table, scene, sight.distance_m, sight.angle_deg)
  weights = np.array([weight for weight, _ in about])
  _, cell = about[rng.choice(len(about), p=weights / weights.sum())]
  number = int(rng.integers(cell.sent))
  track = cell.tracks[number] if number < len(cell.tracks) else _NEVER
  return track, cell.distance_m / sight.distance_m


def draw(
  sight: sight_lines.Sight,
  track: ladder_table.Track,
  scale: float,
  rng: _RANDOM,
) -> tuple[np.ndarray, np.ndarray]:
  """(T, 2) where a tracker sees the target, and (T,) whether it does.

  Args:
    sight: Where the target is.
    track: The errors.
    scale: By how much they are multiplied.
    rng: What is drawn from.
  """
  from scipy import signal  # It takes seconds, which others need not wait.

  count = len(sight.places_px)
  height_px = sight.places_px[:, 1] - sight.places_px[0, 1]
  places_px = sight.places_px + scale * np.array(track.bias_px)
  places_px = places_px + height_px[:, None] * track.slope
  for axis in (0, 1):
    memory = track.memory[axis]
    fresh = rng.normal(size=count) * np.sqrt(1 - memory**2)
    fresh[0] = rng.normal()
    noise = signal.lfilter([1.0], [1.0, -memory], fresh)
    places_px[:, axis] += scale * track.spread_px[axis] * noise
  return places_px, sight.inside & ~_losses(track, count, rng)


def _losses(track: ladder_table.Track, count: int, rng: _RANDOM) -> np.ndarray:
  """(T,) where the target is lost: runs of geometric lengths."""
  out = np.zeros(count, bool)
  if not track.lost:
    return out
  run = max(track.run, 1.0)
  gap = max(run * (1 - track.lost) / max(track.lost, 1e-9), 1.0)
  place, lost = 0, bool(rng.random() < track.lost)
  while place < count:
    length = int(rng.geometric(1 / (run if lost else gap)))
    out[place : place + length] = lost
    place, lost = place + length, not lost
  return out
