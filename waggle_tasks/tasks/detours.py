"""The way round those who stay where they are, as a taut string would lie.

Each vehicle that stays is a ring of points. Ways lead from ring to ring, never
nearer to any of them than the rings or the way's own ends are; the shortest one
is flown (Dijkstra). Only those that are in the way are looked at.
"""

import heapq
import math

import numpy as np

_POINTS = 12  # Of a ring.
_ANGLES = 2 * math.pi / _POINTS * np.arange(_POINTS)
_RING = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)], axis=1)
_BEYOND = 1.001 / math.cos(math.pi / _POINTS)  # So that its chords are clear.
_MIDDLE = 0.3  # Of a spacing.
_SAME_M = 1e-3


def free_m(
  goal_m: np.ndarray,  # (D,)
  begin_m: np.ndarray,  # (D,)
  stayers_m: np.ndarray,  # (M, D)
  spacing_m: float,
) -> np.ndarray:  # (D,)
  """The place nearest to a goal that is free; the goal itself if it is.

  Of a goal near the middle of somebody who stays it is the place on the side of
  the begin: which one is nearest would be a matter of chance there.

  Args:
    goal_m: Where a vehicle should be.
    begin_m: Where it comes from: of equal places the nearest one is taken.
    stayers_m: Where others stay.
    spacing_m: How far from them a place is free.

  Returns:
    (D,) at the height of the goal; the goal itself where nothing is free.
  """
  goal, begin, stayers = goal_m[:2], begin_m[:2], stayers_m[:, :2]
  away_m = np.linalg.norm(stayers - goal, axis=1)
  if (away_m >= spacing_m).all():
    return goal_m
  if away_m.min() < _MIDDLE * spacing_m:
    middle = stayers[away_m.argmin()]
    back = begin - middle
    to_begin = back / max(np.linalg.norm(back), _SAME_M)
    goal = middle + _MIDDLE * spacing_m * to_begin
  near = stayers[away_m < 3 * spacing_m]
  from_m = goal - near
  from_m /= np.maximum(np.linalg.norm(from_m, axis=1), _SAME_M)[:, None]
  places = np.concatenate([near + spacing_m * from_m, *_rings(near, spacing_m)])
  clear_m = np.linalg.norm(places[:, None] - stayers, axis=2).min(axis=1)
  places = places[clear_m >= spacing_m - 1e-9]
  if not len(places):
    return goal_m
  far_m = np.linalg.norm(places - goal, axis=1)
  back_m = np.linalg.norm(places - begin, axis=1)
  best = min(range(len(places)), key=lambda k: (round(far_m[k], 6), back_m[k]))
  return np.append(places[best], goal_m[2:])


def way(
  begin_m: np.ndarray,  # (2,)
  goal_m: np.ndarray,  # (2,)
  stayers_m: np.ndarray,  # (M, 2)
  spacing_m: float,
) -> list[np.ndarray]:
  """The corners of the shortest way from a place to a goal, the goal last.

  Where there is no way it is the straight one.

  Args:
    begin_m: Where it begins.
    goal_m: Where it leads to.
    stayers_m: Where others stay.
    spacing_m: How far from them it leads, but for its ends.
  """
  if not len(stayers_m):
    return [goal_m]

  def meets(corners: list[np.ndarray]) -> np.ndarray:
    """Whom a way comes too near to, (M,)."""
    legs = np.stack([[begin_m, *corners[:-1]], corners], axis=1)  # (L, 2, 2)
    met = blocked(legs[:, 0], legs[:, 1], stayers_m, spacing_m)
    return np.any(met, axis=0)

  known = meets([goal_m])
  if not known.any():
    return [goal_m]
  while True:
    around = stayers_m[known]
    rings = np.concatenate(_rings(around, spacing_m * _BEYOND))
    away_m = np.linalg.norm(rings[:, None] - stayers_m, axis=2).min(axis=1)
    nodes = np.stack([begin_m, goal_m, *rings[away_m >= spacing_m]])
    found = _shortest(nodes, around, spacing_m)
    if found is None and known.all():
      return [goal_m]
    met = ~known if found is None else meets(found) & ~known
    if found is not None and not met.any():
      return found
    known |= met


def blocked(
  begins_m: np.ndarray,  # (L, 2)
  ends_m: np.ndarray,  # (L, 2)
  stayers_m: np.ndarray,  # (M, 2)
  spacing_m: float,
) -> np.ndarray:  # (L, M)
  """Which legs come nearer to whom than a spacing, and than their ends are."""
  legs, to = ends_m - begins_m, stayers_m - begins_m[:, None]  # (L, M, 2)
  squared = np.maximum((legs * legs).sum(axis=1), 1e-12)[:, None]
  share = np.clip((to * legs[:, None]).sum(axis=2) / squared, 0.0, 1.0)
  near_m = np.linalg.norm(to - share[..., None] * legs[:, None], axis=2)
  ends = np.minimum(
    np.linalg.norm(to, axis=2),
    np.linalg.norm(stayers_m - ends_m[:, None], axis=2),
  )
  return near_m < np.minimum(spacing_m, ends) - 1e-6


def _rings(middles_m: np.ndarray, radius_m: float) -> list[np.ndarray]:
  return [middle + radius_m * _RING for middle in middles_m]


def _shortest(
  nodes: np.ndarray, stayers_m: np.ndarray, spacing_m: float
) -> list[np.ndarray] | None:
  """The nodes of the shortest way from the first to the second."""
  count = len(nodes)
  one, other = (each.ravel() for each in np.indices((count, count)))
  shut = blocked(nodes[one], nodes[other], stayers_m, spacing_m).any(axis=1)
  lengths = np.linalg.norm(nodes[one] - nodes[other], axis=1)
  lengths = np.where(shut, np.inf, lengths).reshape(count, count)
  reached, before = np.full(count, np.inf), np.zeros(count, int)
  reached[0] = 0.0
  queue: list[tuple[float, int]] = [(0.0, 0)]
  while queue:
    length, node = heapq.heappop(queue)
    if node == 1:
      return _back(nodes, before)
    if length > reached[node]:
      continue
    for there in np.flatnonzero(length + lengths[node] < reached - 1e-12):
      reached[there] = length + lengths[node, there]
      before[there] = node
      heapq.heappush(queue, (float(reached[there]), int(there)))
  return None


def _back(nodes: np.ndarray, before: np.ndarray) -> list[np.ndarray]:
  node, out = 1, []
  while node != 0:
    out.append(nodes[node])
    node = int(before[node])
  return out[::-1]
