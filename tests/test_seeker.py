"""The receiver that finds a dancer anywhere in the picture."""

from collections.abc import Callable
import dataclasses
import math

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import scenario, sensor
from waggle_tasks.agents import group, receivers
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import camera, lens

Load = Callable[..., composer.Environment]
Film = Callable[[composer.Environment], np.ndarray]
FLOWN = {'observers': 1, 'language': 'swift', 'duration_s': 7.4}
AGREED = scenario.Scenario(**FLOWN).agreement
FACED = slice(215, 265), slice(275, 365)  # Rows and columns of who is faced.


def read(images: np.ndarray, name: str = 'seeker') -> list[str]:
  """The messages of (T, 480, 640, 3) images."""
  reader = receivers.make(name, AGREED)
  events = [
    event
    for number, image in enumerate(images)
    for event in reader.step(image, 0.04 * number)
  ]
  return [event.message.bits for event in events if event.message]


@pytest.mark.parametrize(
  'place',
  [
    {'aside_deg': 12.0, 'above_m': -0.3, 'bearing_deg': 40.0},
    pytest.param({'aside_deg': 5.0}, marks=pytest.mark.slow),
    pytest.param({'aside_deg': -20.0}, marks=pytest.mark.slow),
    pytest.param({'above_m': 0.5}, marks=pytest.mark.slow),
    pytest.param({'above_m': -0.5}, marks=pytest.mark.slow),
    pytest.param(
      {'aside_deg': 10.0, 'sensor': sensor.Sensor(noise_sigma=10.0)},
      marks=pytest.mark.slow,
    ),
  ],
)
def test_a_dancer_is_read_wherever_it_is_unless_somebody_is_faced(
  load: Load, film: Film, place: dict
) -> None:
  (images,) = film(load(payload='101101', **FLOWN, **place))
  assert read(images) == ['101101']
  (faced,) = film(load(**FLOWN | {'duration_s': 0.1}))
  images[:, *FACED] = faced[0][FACED]  # Who hovers, and says nothing.
  assert read(images) == []


@pytest.mark.slow
@pytest.mark.parametrize('late', [-10, 0, 10])
def test_of_two_dancers_the_one_nearer_to_the_middle_is_read(
  load: Load, film: Film, late: int
) -> None:
  def flown(bits: str, aside_deg: float) -> np.ndarray:
    (images,) = film(load(payload=bits, aside_deg=aside_deg, **FLOWN))
    return images

  near, far, middle = (
    flown(*each) for each in (('010011', 9.0), ('110100', -16.0), ('001110', 0))
  )
  far = far[np.clip(np.arange(len(far)) - late, 0, len(far) - 1)]
  left = slice(140, 260)
  for images, expected in ((near, '010011'), (middle, '001110')):
    both = images.copy()
    both[:, :, left] = far[:, :, left]
    assert read(far) == ['110100']
    assert read(both) == [expected]


@dataclasses.dataclass(frozen=True)
class Above:
  """An observer at a height of its own."""

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    return (layouts.Pose((0.0, -1.3, 1.5), math.pi / 2),) * count


def test_observers_hover_and_face_as_they_are_told() -> None:
  def pose(**changes: object) -> layouts.Pose:
    return scenario.Scenario(observers=1, **changes).poses()['observer_1']

  usual = pose()
  moved = pose(above_m=-0.4, aside_deg=20.0)
  assert moved.position_m == pytest.approx((0.0, -1.3, 0.9))
  assert moved.yaw_rad - usual.yaw_rad == pytest.approx(math.radians(20))
  assert pose(layout=Above(), above_m=0.2).position_m[2] == pytest.approx(1.7)
  assert usual == pose(above_m=0.0)


@pytest.mark.parametrize(
  'bent',
  [
    camera.Camera(lens=lens.Lens('brown', k1=-0.1)),
    camera.Camera(pitch_deg=5.0),
  ],
)
def test_a_camera_that_bends_lines_or_is_not_level_is_refused(
  bent: camera.Camera,
) -> None:
  agreed = dataclasses.replace(AGREED, camera=bent)
  with pytest.raises(group.ReceiverError, match='a level camera') as caught:
    receivers.make('seeker', agreed)
  told = str(caught.value)
  assert f'`pitch_deg` {bent.pitch_deg:g}' in told
  assert len(told) < 250
