"""Pixels and light that lie: the rendered dance is read all the same."""

from collections.abc import Callable

import cv2
import numpy as np
import pytest

from waggle_tasks.agents import receivers
from waggle_tasks.experiments.episodes import tape
from waggle_tasks.experiments.studies import spoilers
from waggle_tasks.protocol import agreement

WANTED = ['NULL', 'START', 'NULL', '0', 'NULL']
Change = Callable[[np.ndarray, float], np.ndarray | None]


@pytest.fixture
def read(clip: object, agreed: agreement.Agreement) -> Callable[..., list[str]]:
  """What a receiver confirms in the clip's pictures, spoilt."""

  def run(spoiler: spoilers.Spoiler, name: str = 'view_bank') -> list[str]:
    reader = receivers.make(name, agreed)
    stream = zip(clip.images, clip.times_s, strict=True)
    return [
      str(event.symbol)
      for image, time_s in spoiler(stream)
      for event in reader.step(image, time_s)
    ]

  return run


def each(change: Change) -> spoilers.Spoiler:
  """Changes each image by itself; None for none."""

  def spoil(stream: tape.Stream) -> tape.Stream:
    for image, time_s in stream:
      changed = change(image, time_s)
      if changed is not None:
        yield changed, time_s

  return spoil


def lit(gain: Callable[[float], np.ndarray | float]) -> spoilers.Spoiler:
  """Light that changes by (480 or 1, 640 or 1, 3 or 1) gains of a time."""

  def change(image: np.ndarray, time_s: float) -> np.ndarray:
    gains = np.broadcast_to(np.float32(gain(time_s)), image.shape)
    return cv2.multiply(image, gains.copy(), dtype=cv2.CV_8U)

  return each(change)


def bad_pixels(share: float, for_good: bool) -> spoilers.Spoiler:
  rng = np.random.RandomState(1)
  count = int(share * 640 * 480)
  values = rng.choice(np.array([0, 255], np.uint8), (count, 1))
  places = rng.randint(0, 640 * 480, count)

  def change(image: np.ndarray, time_s: float) -> np.ndarray:
    out = image.copy()
    where = places if for_good else rng.randint(0, 640 * 480, count)
    out.reshape(-1, 3)[where] = values
    return out

  return each(change)


def correlated(sigma: float, rows: int, columns: int) -> spoilers.Spoiler:
  """Noise that is the same in cells of so many rows and columns."""
  rng = np.random.RandomState(2)

  def change(image: np.ndarray, time_s: float) -> np.ndarray:
    noise = rng.normal(0, sigma, (480 // rows, 640 // columns, 1))
    noise = noise.repeat(rows, axis=0).repeat(columns, axis=1).repeat(3, axis=2)
    return cv2.add(image, noise, dtype=cv2.CV_8U)

  return each(change)


def coarse(side: int) -> spoilers.Spoiler:
  """A picture of larger pixels than its own."""
  small = 640 // side, 480 // side

  def change(image: np.ndarray, time_s: float) -> np.ndarray:
    seen = cv2.resize(image, small, interpolation=cv2.INTER_AREA)
    return cv2.resize(seen, (640, 480), interpolation=cv2.INTER_NEAREST)

  return each(change)


def gone(begins_s: tuple[float, ...], length_s: float) -> spoilers.Spoiler:
  """Images that are lost in bursts."""

  def change(image: np.ndarray, time_s: float) -> np.ndarray | None:
    lost = any(0 <= time_s - begin_s < length_s for begin_s in begins_s)
    return None if lost else image

  return each(change)


def wave(share: float, period_s: float, time_s: float) -> float:
  return share * float(np.sin(2 * np.pi * time_s / period_s))


ROWS = np.linspace(0, 1, 480)[:, None, None]
COLUMNS = np.linspace(0, 1, 640)[None, :, None]


def shadow(time_s: float) -> np.ndarray:
  middle = (0.1 * time_s) % 1.6 - 0.3
  return 1 - 0.1 * np.exp(-(((COLUMNS - middle) / 0.15) ** 2) / 2)


def half(share: float, time_s: float) -> np.ndarray:
  """One half of the picture in another light, from a hard edge on."""
  share *= float(np.clip((time_s - 4.0) / 8.0, 0, 1))
  return 1 + share / (1 + np.exp((COLUMNS - 0.5) / 0.02))


SPOILERS = {
  'one pixel in two thousand for a moment': bad_pixels(0.0005, False),
  'one in a hundred for a moment': bad_pixels(0.01, False),
  'one in a hundred for good': bad_pixels(0.01, True),
  'white balance of 3 %': lit(
    lambda t: 1 + wave(0.03, 40, t) * np.array([1, 0, -1])
  ),
  'white balance of 15 %': lit(
    lambda t: 1 + wave(0.15, 25, t) * np.array([1, 0, -1])
  ),
  'slow light of 5 %': lit(lambda t: 1 + wave(0.05, 10, t)),
  'fast light of 10 %': lit(lambda t: 1 + wave(0.1, 1.3, t)),
  'light of 12 % from one side': lit(lambda t: 1 + wave(0.12, 20, t) * COLUMNS),
  'bands of a lamp of 3 %': lit(
    lambda t: 1 + 0.03 * np.sin(2 * np.pi * (4 * ROWS + 0.7 * t))
  ),
  'a soft shadow of 10 %': lit(shadow),
  'a half that is 20 % brighter': lit(lambda t: half(0.2, t)),
  'a half that is 20 % darker': lit(lambda t: half(-0.2, t)),
  'noise along rows': correlated(3.0, 1, 640),
  'noise along columns': correlated(3.0, 480, 1),
  'noise in blocks': correlated(4.0, 8, 8),
  'pixels twice as large': coarse(2),
  'pixels four times as large': coarse(4),
}
# Of each kind one that others hardly say more than.
TELLING = (
  'one in a hundred for a moment', 'white balance of 15 %',
  'light of 12 % from one side', 'a half that is 20 % darker',
  'noise in blocks', 'pixels four times as large',
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
  'name',
  [
    pytest.param(name, marks=[pytest.mark.long] * (name not in TELLING))
    for name in SPOILERS
  ],
)
def test_pictures_that_lie_are_read(
  name: str, read: Callable[..., list[str]]
) -> None:
  assert read(SPOILERS[name]) == WANTED


@pytest.mark.parametrize('receiver', ['klt', 'view_bank'])
def test_bursts_of_lost_images_cost_nothing(
  receiver: str, read: Callable[..., list[str]]
) -> None:
  begins_s = tuple(np.arange(0.5, 15.0, 1.9))
  assert read(gone(begins_s, 0.2), receiver) == WANTED


@pytest.mark.long
@pytest.mark.parametrize('name', spoilers.LASTING)
def test_what_is_drawn_for_replays_can_be_read(
  name: str, read: Callable[..., list[str]]
) -> None:
  assert read(spoilers.LASTING[name](np.random.RandomState(5))) == WANTED
