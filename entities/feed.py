"""How a camera's pictures come to an observer: spoilt, late, or not at all."""

import collections
import dataclasses

import numpy as np

from waggle_tasks import eyes, sensor
from waggle_tasks.entities import codecs, corruptors, lenses, sensors
from waggle_tasks.protocol import agreement as agreement_lib


@dataclasses.dataclass(eq=False)
class _Picture:
  """What the camera took in one frame, once somebody asks; else empty."""

  pixels: np.ndarray = dataclasses.field(default_factory=lambda: np.empty(0))


@dataclasses.dataclass(frozen=True, eq=False)
class _Message:
  """A picture and the time that it is told to be of."""

  picture: _Picture
  time_s: float


class Feed:
  """The images and times of one observer in one episode.

  `image` and `time_s` are of the message that `advance` chose for the frame, so
  that they agree.
  """

  def __init__(
    self,
    chosen: sensor.Sensor,
    random_state: np.random.RandomState,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    eye: eyes.Eye = eyes.Eye(),
  ) -> None:
    """Makes the feed, before the first frame.

    Args:
      chosen: What spoils it.
      random_state: What its own draws begin with.
      agreement: What both sides know: the camera and the rate.
      eye: The camera, beyond that.

    Raises:
      EyeError: if its pictures cannot be coded here.
    """
    seed = int(random_state.randint(2**32, dtype=np.uint32))
    # Each kind draws from its own, so that none of them changes another.
    light, noise, self._draws, shaking, pixels = (
      np.random.RandomState([seed, kind]) for kind in range(5)
    )
    self._projection: lenses.Projection | None = None
    self._sensor: sensors.Sensor | None = None
    self._codec: codecs.Codec | None = None
    if not eye.is_ideal:
      seen_with, frame_s = agreement.camera, agreement.frame_s
      self._projection = lenses.Projection(seen_with, eye, shaking)
      self._sensor = sensors.Sensor(eye, seen_with, frame_s, pixels)
      self._codec = codecs.make(eye, seen_with)
    self._chosen, self._agreement = chosen, agreement
    self._light = corruptors.Light(chosen, light, agreement)
    self._blur = corruptors.Blur(chosen.exposure_s / agreement.frame_s)
    self._noise = None
    if chosen.noise_sigma or chosen.photons:
      self._noise = corruptors.SensorNoise(
        chosen.noise_sigma, chosen.photons, agreement.camera.shape, noise
      )
    self._frame = self._exposed_frame = -1
    # What is on its way, the oldest first; the first one never waits.
    self._sent: collections.deque[_Message] = collections.deque(
      maxlen=chosen.late_frames + 1
    )
    self._taken = _Picture()
    self._delivered = _Message(self._taken, 0.0)

  def advance(self, time_s: float) -> None:
    """Begins a frame and decides what comes in it.

    Args:
      time_s: The time of the picture that is taken now.
    """
    self._frame += 1
    chosen = self._chosen
    repeats, drops = self._draws.random_sample(2) < (
      chosen.repeated_share,
      chosen.dropped_share,
    )
    frozen = self._during(chosen.freeze_s, chosen.freeze_length_s, 1)
    if not (repeats or frozen):
      self._taken = _Picture()
    self._sent.append(_Message(self._taken, time_s))
    if not (self._frame and drops):
      self._delivered = self._sent[0]

  def image(self, picture: np.ndarray) -> np.ndarray:  # (H, W, 3) uint8
    """Takes this frame's picture and returns the one that comes."""
    if self._exposed_frame < self._frame:  # Composer may ask again.
      self._exposed_frame = self._frame
      if self._projection is None or self._sensor is None:
        image, exposure = picture.copy(), 1.0
      else:
        time_s = self._frame * self._agreement.frame_s
        image = self._projection.picture(picture, time_s)
        exposure = self._sensor.gain
      self._light(image, self._frame, exposure)
      self._blur(image)
      if not self._taken.pixels.size:
        self._taken.pixels = self._read_out(image)
    # Of a frame in which nobody asked there is no picture but the present one.
    come = self._delivered.picture.pixels
    return come if come.size else self._taken.pixels

  @property
  def time_s(self) -> float:
    """The time of the image that comes in this frame."""
    return self._delivered.time_s

  def _read_out(self, image: np.ndarray) -> np.ndarray:
    chosen = self._chosen
    if self._sensor is not None:
      image = self._sensor.picture(image)
    if self._noise is not None:
      self._noise(image)
    if self._is_black():
      corruptors.blacken(image, chosen.blackout_share)
    return image if self._codec is None else self._codec.picture(image)

  def _is_black(self) -> bool:
    chosen, frame_s = self._chosen, self._agreement.frame_s
    begin_s, every_s = chosen.blackout_s, chosen.blackout_every_s
    if every_s:  # As of the last begin, which is rounded to a frame.
      past = (self._frame * frame_s + frame_s / 2 - begin_s) // every_s
      begin_s += every_s * max(0.0, past)
    return self._during(begin_s, chosen.blackout_length_s)

  def _during(self, begin_s: float, length_s: float, after: int = 0) -> bool:
    """Whether this frame is in a stretch, or in what follows its first."""
    frames = self._agreement.frames
    begin = frames(begin_s) + after
    return begin <= self._frame < frames(begin_s + length_s)
