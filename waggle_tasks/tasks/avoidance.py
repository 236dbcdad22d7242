"""The law by which vehicles keep away from each other, each by itself."""

import dataclasses

import numpy as np

from waggle_tasks.tasks import cells, detours, headings

_CLOSING_S = 0.3
_MARGIN_M = 0.02
_STEPS = np.array([1.0, 0.5])
_ANGLES = np.radians(np.arange(0, 360, 30))


@dataclasses.dataclass(frozen=True)
class Law:
  spacing_m: float
  speed_mps: float
  acceleration_mps2: float
  low_m: tuple[float, float, float]
  high_m: tuple[float, float, float]


def step(law, places, velocities, goals, others, their, yields, frame_s):
  """Next velocities (N, 3)."""
  a = law.acceleration_mps2
  most = a * frame_s
  wanted, left, stay = wish(law, places, goals, others, their, yields)
  apart = others - places[:, None]
  goal = headings.choose(
    wanted, velocities, apart, their, yields,
    np.where(stay, law.spacing_m, law.spacing_m+_MARGIN_M),
    np.where(stay, 0.5, np.minimum(3.0, left[:,None]/law.speed_mps+.3)), law.speed_mps,
  )
  stops = cells.stops_m(places, velocities, a)
  walls = cells.joined(
    cells.between(
      (places, stops), (others, cells.stops_m(others, their, a)), yields,
      law.spacing_m,
    ),
    cells.box(
      np.array(law.low_m), np.array(law.high_m),
      np.stack([places, stops], axis=1),
    ),
  )
  tried = _tried(velocities, goal, most)
  ends = places[:, None] + (velocities[:, None] + tried) * (frame_s / 2)
  fits = walls.hold(ends) & walls.hold(cells.stops_m(ends, tried, a))
  fits &= cells.length(tried) <= law.speed_mps + 1e-9
  fits[:, 0] = True  # Braking always fits
  off = np.where(fits, cells.length(tried - goal[:, None]), np.inf)
  return tried[np.arange(len(tried)), off.argmin(axis=1)]


def wish(law, places, goals, others, their, yields):
  plan = law.spacing_m + 2*_MARGIN_M
  stay = ~yields & (cells.length(their) < .05)
  out = np.zeros_like(places); left=np.zeros(len(out))
  for i in range(len(places)):
    far = others[i][stay[i]]
    g = detours.free_m(goals[i], places[i], far, law.spacing_m+.001)
    corners = detours.way(places[i,:2], g[:2], far[:,:2], plan)
    d = corners[0]-places[i,:2]
    dist = np.linalg.norm(d)
    pts=np.stack(corners); dist_all = dist+np.linalg.norm(np.diff(pts,axis=0),axis=1).sum()
    dist_all=np.hypot(dist_all, g[2]-places[i,2])
    left[i]=dist_all
    speed=min(law.speed_mps, dist_all/_CLOSING_S, np.sqrt(dist_all*law.acceleration_mps2))
    # vertical
    dz=(g[2]-places[i,2])*(dist/max(dist_all,1e-9)) if len(corners)>1 else g[2]-places[i,2]
    vec=np.array([*d,dz]); 
    out[i]=vec*speed/max(np.linalg.norm(vec),1e-9)
  return out, left, stay


def _tried(velocities, goal, most):
  speed = cells.length(velocities)
  brake = velocities * (np.maximum(speed - most, 0) / np.maximum(speed, 1e-9))[:, None]
  change = goal - velocities
  size = cells.length(change)
  best = velocities + change * (np.minimum(size, most) / np.maximum(size, 1e-9))[:, None]
  heading = np.arctan2(change[:, 1], change[:, 0])[:, None, None] + _ANGLES[:, None]
  steps = most * _STEPS * np.ones_like(heading)
  around = np.stack([steps * np.cos(heading), steps * np.sin(heading), 0 * steps], -1)
  around = velocities[:, None] + around.reshape(len(velocities), -1, 3)
  return np.concatenate([brake[:, None], best[:, None], velocities[:, None], around], axis=1)
