"""Which way to go: reciprocal velocity obstacles, with passing on the right.

Each vehicle tries velocities, and takes the one that is nearest to what it
wants and leads to no early meeting (van den Berg, Lin and Manocha, Reciprocal
velocity obstacles for real-time multi-agent navigation, ICRA 2008,
doi:10.1109/ROBOT.2008.4543489). A neighbour that yields is taken to do half of
what is needed. Ways to the left and being slow cost more, so that two that meet
head on both go right, many turn about each other, and nobody waits for ever:
the right-hand rule against deadlocks of Zhou and others, see `cells`.

Rows are vehicles, each with what it alone knows.
"""

import numpy as np

from waggle_tasks.tasks import cells

_SOONEST_S = 0.05
# Costs beside how far a velocity is from the wanted one, in greatest speeds.
_LEFT = 0.15  # Of going left.
_STILL = 0.5  # Of being slower than wanted.
_CHANGE = 0.1  # Of another velocity than now.
_ANGLES = np.radians(np.arange(0, 360, 15))
_SPEEDS = np.array([1.0, 0.6, 0.3])


def choose(
  wanted_mps: np.ndarray,  # (N, 3)
  velocities_mps: np.ndarray,  # (N, 3)
  apart_m: np.ndarray,  # (N, M, 3)
  their_mps: np.ndarray,  # (N, M, 3)
  yields: np.ndarray,  # (N, M)
  spacings_m: np.ndarray,  # (N, M)
  horizons_s: np.ndarray,  # (N, M)
  speed_mps: float,
) -> np.ndarray:  # (N, 3)
  """The velocity that each vehicle should have.

  Args:
    wanted_mps: What it would fly if nobody were in its way.
    velocities_mps: What it flies.
    apart_m: Where each neighbour is, from it.
    their_mps: How each neighbour flies.
    yields: Whether a neighbour avoids as well.
    spacings_m: How far it would stay away from each.
    horizons_s: Meetings later than this are not minded.
    speed_mps: Its greatest speed.
  """
  tried = _candidates(wanted_mps, speed_mps)  # (N, C, 3)
  shares = np.where(yields, 2.0, 1.0)[:, None, :, None]
  own, straight = velocities_mps[:, None], wanted_mps[:, None]
  closing = own[:, None] + shares * (tried - own)[:, :, None]
  times_s = meetings_s(
    apart_m[:, None], closing - their_mps[:, None], spacings_m[:, None]
  )  # (N, C, M)
  urgent = 1 / np.maximum(times_s, _SOONEST_S) - 1 / horizons_s[:, None]
  speeds, wanted = cells.length(tried), cells.length(straight)
  left = straight[..., 0] * tried[..., 1] - straight[..., 1] * tried[..., 0]
  left = np.maximum(left / np.maximum(wanted * speeds, 1e-9), 0.0)
  cost = (
    cells.length(tried - straight) / speed_mps
    + _STILL * np.maximum(wanted - speeds, 0.0) / speed_mps
    + _CHANGE * cells.length(tried - own) / speed_mps
    + _LEFT * left
    + urgent.max(axis=2, initial=0.0)
  )
  return tried[np.arange(len(tried)), cost.argmin(axis=1)]


def meetings_s(
  apart_m: np.ndarray,  # (..., 3)
  closing_mps: np.ndarray,  # (..., 3)
  spacings_m: np.ndarray,  # (...)
) -> np.ndarray:  # (...)
  """When two come nearer than a spacing; infinite for never, 0 for already.

  Who is nearer already, and comes no nearer, meets nobody.
  """
  speeds = (closing_mps * closing_mps).sum(axis=-1)
  along = (apart_m * closing_mps).sum(axis=-1)
  beyond = (apart_m * apart_m).sum(axis=-1) - spacings_m**2
  inner = along * along - speeds * beyond
  meets = (inner > 0) & (along > 0)
  root = np.sqrt(np.where(meets, inner, 0.0))
  times_s = (along - root) / np.maximum(speeds, 1e-12)
  return np.where(meets, np.maximum(times_s, 0.0), np.inf)


def _candidates(wanted_mps: np.ndarray, speed_mps: float) -> np.ndarray:
  """Velocities (N, C, 3): the wanted one, rest, and others all around it."""
  heading = np.arctan2(wanted_mps[:, 1], wanted_mps[:, 0])
  angles = heading[:, None, None] + _ANGLES[:, None]  # (N, A, 1)
  speeds = speed_mps * _SPEEDS * np.ones_like(angles)
  climb = np.broadcast_to(wanted_mps[:, None, 2:], speeds.shape)
  around = np.stack(
    [speeds * np.cos(angles), speeds * np.sin(angles), climb], axis=-1
  ).reshape(len(wanted_mps), -1, 3)
  first = np.stack([wanted_mps, np.zeros_like(wanted_mps)], axis=1)
  return np.concatenate([first, around], axis=1)
