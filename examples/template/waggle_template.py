"""A package that adds a receiver, a language, a layout and a scenario."""

import dataclasses

import cv2
import numpy as np

import waggle_tasks
from waggle_tasks import layouts
from waggle_tasks.agents import joint_receiver, receiver
from waggle_tasks.protocol import agreement, languages

LEISURELY = dataclasses.replace(languages.LANGUAGES['swift'], pause_s=2.0)
FAR = waggle_tasks.Scenario(observers=1, distance_m=2.5)


@dataclasses.dataclass(frozen=True)
class Numbers:
  """How strong the blur is."""

  sigma_px: float = 0.8


class Smooth(receiver.Receiver):
  """Blurs images, so that their noise is less, and reads them as `joint`."""

  DEFAULT = Numbers()

  def __init__(self, agreed: agreement.Agreement, config: Numbers) -> None:
    self._reader, self._config = joint_receiver.JointReceiver(agreed), config

  def step(self, image: np.ndarray, time_s: float) -> tuple:
    """See the base class."""
    smooth = cv2.GaussianBlur(image, (0, 0), self._config.sigma_px)
    events = self._reader.step(smooth, time_s)
    self.track = self._reader.track
    return events


class Stairs:
  """Observers side by side, each further away than the one before."""

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    """Where they stand."""
    steps = [(0.7 * number, -1.3 - 0.2 * number) for number in range(count)]
    return tuple(layouts.facing_performer(*step) for step in steps)
