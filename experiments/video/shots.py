"""The pictures of the documentation that are taken in flight."""

from collections.abc import Mapping, Sequence

import cv2
import numpy as np

from waggle_tasks import scenario
from waggle_tasks.agents import receivers
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import episode, moves, traces
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import film, layout, lens, page, pen
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol.symbols import MOTIONS

_TIME_S = 78.6  # Of the composite: in the last bit, with the others read.
_OBSERVER = 1  # The one in the middle of three, from 0.
_EXPOSURES = 9  # Of the performer on its way through a gesture.
_CHANGED = 12  # Grey levels by which it differs from the room.
_CROP = layout.Rect(100, 12, 440, 346)  # Of its image: where gestures are.
_GAP, _TITLE = 8, 30


class Shots:
  """An onlooker that keeps what the pictures show.

  Attributes:
    composite: (H, W, 3) uint8 RGB, a picture of the composite video.
    images: By frame number, what one observer saw, (H, W, 3) uint8 RGB.
  """

  def __init__(self, scene: scenario.Scenario) -> None:
    """Makes the onlooker of an episode that has not begun."""
    self._lens = lens.Lens(scene)
    self._names = tuple(layouts.names(scene.observers))
    self._page = film.composite(scene, self._names)
    self._at = scene.agreement.frames(_TIME_S)
    self._wanted = {
      frame
      for gesture in firsts(
        moves.sent(scene.performance, scene.agreement, scene.episode_s)
      )
      for frame in exposures(gesture, scene.agreement)
    }
    self.composite: np.ndarray | None = None
    self.images: dict[int, np.ndarray] = {}

  def __call__(self, step: episode.Step) -> None:
    """Keeps what belongs to this frame."""
    self._lens.note(step)
    frame = self._lens.frame
    if frame == self._at:
      now = self._lens.moment(self._names, self._lens.shared())
      self.composite = self._page.draw(now).copy()
    if frame in self._wanted:
      seen = step.timestep.observation[_OBSERVER]
      self.images[frame] = seen['camera'].copy()


def firsts(sent: Sequence[moves.Sent]) -> list[moves.Sent]:
  """The first time that each gesture is flown, in the alphabet's order."""
  return [
    next(each for each in sent if each.symbol is symbol) for symbol in MOTIONS
  ]


def exposures(
  gesture: moves.Sent, agreement: agreement_lib.Agreement
) -> list[int]:
  """The frames in which the performer is shown on its way."""
  times_s = np.linspace(gesture.begin_s, gesture.end_s, 2 * _EXPOSURES - 1)
  return [agreement.frames(time_s) for time_s in times_s]


def take(receiver_name: str) -> dict[str, np.ndarray]:  # (H, W, 3) uint8 each
  """Flies the default broadcast and returns pictures by the names of files.

  Args:
    receiver_name: Whose observers are shown.

  Raises:
    ReceiverError: if it is not known.
  """
  scene = scenario.Scenario()
  shots = Shots(scene)
  receivers.make(receiver_name, scene.agreement)
  flown = rollout_lib.run(scene, receiver_name, [shots])
  sent = moves.sent(scene.performance, scene.agreement, scene.episode_s)
  trace = [*flown.traces.values()][_OBSERVER]
  return {
    'composite.png': np.asarray(shots.composite),
    'gestures.png': gestures(
      firsts(sent), shots.images, trace, scene.agreement
    ),
  }


def gestures(
  sent: Sequence[moves.Sent],
  images: Mapping[int, np.ndarray],
  trace: traces.Trace,
  agreement: agreement_lib.Agreement,
) -> np.ndarray:  # (H, W, 3) uint8
  """The gestures in two rows of two.

  Args:
    sent: One of each.
    images: By frame number, what an observer saw.
    trace: What its receiver made of it.
    agreement: What both sides know: the rate.
  """
  step = layout.Rect(0, 0, _CROP.width + _GAP, _CROP.height + _TITLE + _GAP)
  canvas = np.zeros(
    (2 * step.height + _GAP, 2 * step.width + _GAP, 3), np.uint8
  )
  pen.fill(canvas, layout.Rect(0, 0, *canvas.shape[1::-1]), page.GROUND)
  for number, gesture in enumerate(sent):
    left = _GAP + number % 2 * step.width
    top = _GAP + number // 2 * step.height
    during = (trace.times_s >= gesture.begin_s) & (
      trace.times_s <= gesture.end_s
    )
    picture = _exposed(
      [images[frame] for frame in exposures(gesture, agreement)],
      trace.centre_px[during],
    )
    place = layout.Rect(left, top + _TITLE, _CROP.width, _CROP.height)
    canvas[place.slices] = picture[_CROP.slices]
    middle, colour = top + _TITLE // 2, palette.SYMBOLS[gesture.symbol]
    pen.chip(canvas, str(gesture.symbol), left, middle, 18, colour)
  return canvas


def _exposed(images: Sequence[np.ndarray], track_px: np.ndarray) -> np.ndarray:
  """One picture of a room, a track, and what was in the room at any time."""
  stack = np.stack(images)  # (K, H, W, 3)
  room = np.median(stack, axis=0).astype(np.uint8)
  out = room.copy()
  pen.outline(out, track_px, palette.YELLOW, 1)
  for image in stack:
    there = (cv2.absdiff(image, room) > _CHANGED).any(axis=2)
    out[there] = image[there]
  return out
