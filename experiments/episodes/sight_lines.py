"""Where the performer would be in each observer's picture, by geometry alone.

No simulator takes part. The dance, the places, the hover and what the sensor
loses are drawn from the scenario's seed as an environment draws them, so that
an episode here is the episode that would be rendered. What only pictures show,
where a tracker believes the performer to be, is not here.
"""

from collections.abc import Iterator
import dataclasses
import math

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.arenas import bounds, layouts
from waggle_tasks.entities import feed
from waggle_tasks.protocol import minimum_jerk, schedule

_BRAKE_S = 0.8  # As a performer that is stopped.
_BLACK = 0  # What comes of a frame's number in a black picture.


@dataclasses.dataclass(frozen=True, eq=False)
class Sight:
  """What one observer's camera would see of the performer.

  Attributes:
    name: The observer.
    distance_m: How far it stands from the performer, on the floor.
    angle_deg: From where it looks, degrees from the front.
    places_px: (T, 2) the performer's centre, x right and y down, as it stands
      before the background that was there at first.
    inside: (T,) whether that is in the picture.
    scale_px: Pixels of a metre at the performer's place.
    come: (T,) the frame whose picture comes in each frame; -1 for a black one.
    times_s: (T,) the time that it is told to be of.
  """

  name: str
  distance_m: float
  angle_deg: float
  places_px: np.ndarray
  inside: np.ndarray
  scale_px: float
  come: np.ndarray
  times_s: np.ndarray

  def moved_px(self, frame: int, home: int = 0) -> float:
    """How far the target is in a frame from where it was in another."""
    places_px = self.places_px[max(frame, 0)], self.places_px[home]
    return math.dist(*places_px)

  def images(self) -> Iterator[tuple[float, int]]:
    """The times and the frames of images that come, -1 for black ones."""
    last_s = -math.inf
    for time_s, frame in zip(self.times_s, self.come, strict=True):
      if time_s > last_s:
        yield float(time_s), int(frame)
        last_s = time_s


def of(scene: scenario.Scenario) -> list[Sight]:
  """What every observer's camera would see of a scenario's performer."""
  agreed = scene.agreement
  random_state = np.random.RandomState(scene.seed)
  poses = scene.poses()
  homes = dict(
    zip(
      poses,
      layouts.jittered([*poses.values()], scene.jitter_m, random_state),
      strict=True,
    )
  )
  times_s = np.arange(agreed.frames(scene.episode_s) + 1) * agreed.frame_s
  drift, sways = scene.drift, {}
  for name, home in homes.items():
    draw = drift.performer if name == 'performer' else drift.observer
    sways[name] = draw(random_state, home.yaw_rad, agreed.rate_hz)
  sways_m = {
    name: np.array([sway.at(each)[0] for each in times_s])
    if drift.near_m
    else np.zeros((len(times_s), 4))
    for name, sway in sways.items()
  }
  places_m = _dance_m(scene, homes['performer'], times_s)
  places_m += sways_m['performer'][:, :3]
  feeds = [
    None if chosen.is_clean else feed.Feed(
      dataclasses.replace(chosen, noise_sigma=0.0), random_state, agreed
    )
    for chosen in scene.sensors
  ]  # fmt: skip
  names = [name for name in homes if name != 'performer']
  return [
    _sight(scene, name, homes, places_m, sways_m[name], coming, times_s)
    for name, coming in zip(names, feeds, strict=True)
  ]


def _dance_m(
  scene: scenario.Scenario, home: layouts.Pose, times_s: np.ndarray
) -> np.ndarray:
  """(T, 3) where the performer is, before it drifts."""
  performance, axes = scene.performance, schedule.axes(home.yaw_rad)
  danced, stop_s = performance.schedule, performance.stop_s
  out = np.tile(np.array(home.position_m), (len(times_s), 1))
  moving = np.minimum(times_s, stop_s)
  for slot in danced.slots:
    begin, end = np.searchsorted(moving, [slot.begin_s, slot.end_s])
    for row in range(begin, end):
      offset = slot.gesture.motion(moving[row] - slot.begin_s)[0]
      out[row] = home.position_m + offset @ axes[: len(offset)]
    rest = slot.gesture.end_m
    out[end:] = home.position_m + rest @ axes[: len(rest)]
  motion = danced.motion(stop_s)
  for late in np.flatnonzero(times_s > stop_s):
    offset, *_ = minimum_jerk.to_rest(*motion, times_s[late] - stop_s, _BRAKE_S)
    out[late] = home.position_m + offset @ axes[: len(offset)]
  return out


def _sight(
  scene: scenario.Scenario,
  name: str,
  homes: dict[str, layouts.Pose],
  places_m: np.ndarray,  # (T, 3)
  sway_m: np.ndarray,  # (T, 4)
  coming: feed.Feed | None,
  times_s: np.ndarray,  # (T,)
) -> Sight:
  home, camera = homes[name], scene.agreement.camera
  cosine, sine = math.cos(home.yaw_rad), math.sin(home.yaw_rad)
  ahead = np.array([cosine, sine, 0.0])
  axes = np.array([[sine, -cosine, 0.0], [0.0, 0.0, -1.0], ahead])
  eye_m = np.array(home.position_m) + scene.eye_offset_m * ahead
  off_m = (places_m - eye_m - sway_m[:, :3]) @ axes.T  # right, down, ahead
  with np.errstate(divide='ignore', invalid='ignore'):
    places_px = camera.focal_px * off_m[:, :2] / off_m[:, 2:]
  # The tracker holds the background in its place, so what is left of an
  # observer's sway is how much nearer than the wall the performer is.
  behind_px = camera.focal_px * (sway_m[:, :3] @ axes[:2].T)
  places_px += behind_px / _wall_m(eye_m, ahead)
  places_px += np.array(camera.size) / 2
  inside = off_m[:, 2] > 0
  inside &= ((places_px > 0) & (places_px < camera.size)).all(axis=1)
  place_m = np.array(home.position_m) - homes['performer'].position_m
  come, told_s = _coming(coming, times_s)
  return Sight(
    name,
    float(math.hypot(*place_m[:2])),
    math.degrees(math.atan2(place_m[0], -place_m[1])),
    places_px,
    inside,
    float(camera.focal_px / off_m[0, 2]),
    come,
    told_s,
  )


def _wall_m(eye_m: np.ndarray, ahead: np.ndarray) -> float:
  """How far the wall is that an eye looks at, (3,) each."""
  sides_m = np.array([bounds.HALF_WIDTH_M, bounds.HALF_DEPTH_M])
  with np.errstate(divide='ignore'):
    ways_m = (sides_m - eye_m[:2] * np.sign(ahead[:2])) / np.abs(ahead[:2])
  return float(ways_m.min())


def _coming(
  coming: feed.Feed | None, times_s: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
  """(T,) the frame whose picture comes, and (T,) the time it is told of.

  Pictures of a single pixel, which is the number of their frame, go through
  what the sensor does to those of the camera.
  """
  if coming is None:
    return np.arange(len(times_s)), times_s
  come, told_s = [], []
  for frame, time_s in enumerate(times_s):
    coming.advance(float(time_s))
    picture = np.full((1, 1, 3), frame + 1, np.int32)
    come.append(int(coming.image(picture)[0, 0, 0]) - 1)
    told_s.append(coming.time_s)
  return np.array(come), np.array(told_s)
