"""Ways to spoil images that were taken before: losses of sight, and the rest.

A loss hides everything for a while; the others last. Each is a generator over
images and times, and draws what it needs from the numbers that it is given.
Half of the losses begin in a rest and last about as long as some gestures with
their pauses, as those are what may make a message of what was none.
"""

from collections.abc import Callable
import dataclasses

import cv2
import numpy as np

from waggle_tasks.experiments.episodes.tape import Stream
from waggle_tasks.protocol import agreement as agreement_lib

Spoiler = Callable[[Stream], Stream]
_SHORTEST_S, _LONGEST_S = 0.2, 40.0
_LONGEST_SLOTS = 4  # The same in a language without long pauses.
_MOST_LOSSES = 3
_LASTING_SHARE = 0.3  # Of all exposures; receivers are slow in some.
_WHOLE = 250  # Of light, in a table of whole numbers.
_POOL = 2  # A pool of noise is so many times as wide and high as an image.


@dataclasses.dataclass(frozen=True)
class Loss:
  """A time without sight.

  Attributes:
    kind: One of `LOSSES`.
    begin_s: When it begins.
    length_s: How long it lasts.
  """

  kind: str
  begin_s: float
  length_s: float

  def __call__(self, stream: Stream) -> Stream:
    """The images with the loss."""
    hide, last = LOSSES[self.kind], None
    for image, time_s in stream:
      if not self.begin_s <= time_s < self.begin_s + self.length_s:
        last = None
        yield image, time_s
        continue
      if last is None:
        last = hide(image)
      if last is not None:
        yield last, time_s


def _covered(image: np.ndarray) -> np.ndarray:
  """A board before the middle."""
  out = image.copy()
  height, width = image.shape[:2]
  out[height // 6 : -height // 6, width // 6 : -width // 6] = (96, 64, 40)
  return out


def _noise(image: np.ndarray) -> np.ndarray:
  rng = np.random.RandomState(int(image[0, 0, 0]))
  return rng.randint(0, 256, image.shape).astype(np.uint8)


# What is seen instead of images, by their first; None for no images at all.
LOSSES: dict[str, Callable[[np.ndarray], np.ndarray | None]] = {
  'black': np.zeros_like,
  'white': lambda image: np.full_like(image, 255),
  'covered': _covered,
  'defocused': lambda image: cv2.GaussianBlur(image, (0, 0), 25.0),
  'noise': _noise,
  'frozen': np.copy,
  'missing': lambda image: None,
}


def _grain(rng: np.random.RandomState) -> Spoiler:
  sigma = rng.uniform(2.0, 15.0)

  def spoil(stream: Stream) -> Stream:
    pool = None
    for image, time_s in stream:
      height, width = image.shape[:2]
      if pool is None:
        size = _POOL * height, _POOL * width, 3
        noise = rng.normal(0.0, sigma, size)
        # Apart, as whole numbers of one byte are added many times as fast.
        pool = [
          np.clip(each, 0, 255).astype(np.uint8) for each in (noise, -noise)
        ]
      top, left = rng.randint(height), rng.randint(width)
      more, less = (
        each[top : top + height, left : left + width] for each in pool
      )
      yield cv2.subtract(cv2.add(image, more), less), time_s

  return spoil


def _speckles(rng: np.random.RandomState) -> Spoiler:
  share = 10 ** rng.uniform(-4, -2)

  def spoil(stream: Stream) -> Stream:
    for image, time_s in stream:
      out = image.copy()
      flat = out.reshape(-1, 3)
      count = int(share * len(flat))
      values = rng.choice(np.array([0, 255], np.uint8), (count, 1))
      flat[rng.randint(0, len(flat), count)] = values
      yield out, time_s

  return spoil


def _colour(rng: np.random.RandomState) -> Spoiler:
  shares, period_s = rng.uniform(-0.15, 0.15, 3), rng.uniform(5.0, 60.0)

  def spoil(stream: Stream) -> Stream:
    levels = np.arange(256)[:, None]
    for image, time_s in stream:
      gains = 1 + shares * np.sin(2 * np.pi * time_s / period_s)
      table = np.clip(np.rint(levels * gains), 0, 255).astype(np.uint8)
      yield cv2.LUT(image, table[:, None]), time_s

  return spoil


def _shadow(rng: np.random.RandomState) -> Spoiler:
  depth, width = rng.uniform(0.03, 0.2), rng.uniform(0.1, 0.4)
  share_s = rng.uniform(0.02, 0.3)  # Of the picture's width, in a second.

  def spoil(stream: Stream) -> Stream:
    for image, time_s in stream:
      columns = np.linspace(0, 1, image.shape[1])
      middle = (share_s * time_s) % (1 + 6 * width) - 3 * width
      dark = 1 - depth * np.exp(-(((columns - middle) / width) ** 2) / 2)
      row = np.repeat(np.rint(_WHOLE * dark), 3).astype(np.uint8)
      factor = np.tile(row, (len(image), 1)).reshape(image.shape)
      yield cv2.multiply(image, factor, scale=1 / _WHOLE), time_s

  return spoil


def _rows(rng: np.random.RandomState) -> Spoiler:
  sigma = rng.uniform(1.0, 5.0)

  def spoil(stream: Stream) -> Stream:
    for image, time_s in stream:
      noise = rng.normal(0.0, sigma, (len(image), 1, 1)).astype(np.int16)
      noise = np.broadcast_to(noise, image.shape)
      yield cv2.add(image, noise, dtype=cv2.CV_8U), time_s

  return spoil


def _bursts(rng: np.random.RandomState) -> Spoiler:
  share, length = rng.uniform(0.02, 0.3), rng.randint(1, 12)

  def spoil(stream: Stream) -> Stream:
    left = 0
    for image, time_s in stream:
      if not left and rng.rand() < share / length:
        left = length
      left = max(left - 1, 0)
      if not left:
        yield image, time_s

  return spoil


def _copies(rng: np.random.RandomState) -> Spoiler:
  share = rng.uniform(0.1, 0.7)

  def spoil(stream: Stream) -> Stream:
    last = None
    for image, time_s in stream:
      if last is None or rng.rand() >= share:
        last = image.copy()
      yield last, time_s

  return spoil


def _rarely(rng: np.random.RandomState) -> Spoiler:
  every = rng.randint(2, 4)

  def spoil(stream: Stream) -> Stream:
    for number, each in enumerate(stream):
      if number % every == 0:
        yield each

  return spoil


# What lasts, by name.
LASTING: dict[str, Callable[[np.random.RandomState], Spoiler]] = {
  'grain': _grain,
  'speckles': _speckles,
  'colour': _colour,
  'shadow': _shadow,
  'rows': _rows,
  'bursts': _bursts,
  'copies': _copies,
  'rarely': _rarely,
}


@dataclasses.dataclass(frozen=True, eq=False)
class Spoiling:
  """All that happens to the images of one exposure.

  Attributes:
    losses: The times without sight.
    lasting: The name of what lasts; empty for nothing.
    spoilers: Losses and what lasts, in the order in which they act.
  """

  losses: tuple[Loss, ...]
  lasting: str
  spoilers: tuple[Spoiler, ...]

  @property
  def name(self) -> str:
    """As text, such as 'grain, black 12.0-20.5 s'."""
    times = (
      f'{each.kind} {each.begin_s:.1f}-{each.begin_s + each.length_s:.1f} s'
      for each in self.losses
    )
    return ', '.join(filter(None, (self.lasting, *times)))

  def __call__(self, stream: Stream) -> Stream:
    """The spoilt images, each valid until the next is asked for."""
    for spoiler in self.spoilers:
      stream = spoiler(stream)
    return stream


def draw(
  seed: int, agreed: agreement_lib.Agreement, length_s: float
) -> Spoiling:
  """Draws what happens to one exposure.

  Args:
    seed: Each gives another one.
    agreed: What both sides know: losses are made for its pauses.
    length_s: How long the flight lasts.
  """
  rng = np.random.RandomState(seed)
  name = rng.choice([*LASTING]) if rng.rand() < _LASTING_SHARE else ''
  first = (LASTING[name](rng),) if name else ()
  fewest = 0 if name else 1  # An exposure that is not spoilt is no other one.
  losses = tuple(
    _loss(rng, agreed, length_s)
    for _ in range(rng.randint(fewest, _MOST_LOSSES + 1))
  )
  return Spoiling(losses, str(name), (*first, *losses))


def _loss(
  rng: np.random.RandomState, agreed: agreement_lib.Agreement, length_s: float
) -> Loss:
  kind = str(rng.choice([*LOSSES]))
  pause_s, slot_s, longest_s = _pace(agreed)
  if rng.rand() < 0.5:
    long = np.exp(rng.uniform(np.log(_SHORTEST_S), np.log(longest_s)))
    return Loss(kind, float(rng.uniform(0, length_s)), float(long))
  slots = rng.randint(0, int(length_s / slot_s) + 1)
  rest_s = agreed.pauses.initial_hover_s + slots * slot_s - pause_s
  begin_s = rest_s + rng.uniform(-0.2, 1.0) * pause_s
  long = rng.randint(1, 4) * slot_s + rng.uniform(-1.2, 0.5) * pause_s
  return Loss(kind, float(begin_s), float(max(long, _SHORTEST_S)))


def _pace(agreed: agreement_lib.Agreement) -> tuple[float, float, float]:
  """How long a pause, a motion with its pause, and the longest loss are, s."""
  if agreed.language is None:
    pause_s = agreed.pauses.pause_s
    slot_s = agreed.codebook.gestures[0].duration_s + pause_s
    return pause_s, slot_s, _LONGEST_S
  alphabet = agreed.language.alphabet
  pause_s = max(alphabet.rest_s, alphabet.slot_s / 4)
  return pause_s, alphabet.slot_s, _LONGEST_SLOTS * alphabet.slot_s
