"""What both sides know is one value: rate, height and camera included."""

from collections.abc import Callable
import dataclasses
import json
import math
import pathlib
import re

import numpy as np
import pytest

import waggle_tasks
from waggle_tasks import errors, layouts, receivers, registry
from waggle_tasks import sensor as sensor_lib
from waggle_tasks.agents import navigator
from waggle_tasks.experiments.record import archive, nulls, reach, writer
from waggle_tasks.experiments.video import film, layout
from waggle_tasks.protocol import gestures, timing

Scenario, Agreement = waggle_tasks.Scenario, waggle_tasks.Agreement


@pytest.mark.slow
def test_another_camera_at_another_rate_and_height_is_read_and_flown(
  short: dict[str, object],
) -> None:
  fields = short | {
    'observers': 1,
    'rate_hz': 50,
    'hover_height_m': 1.6,
    'camera_width_px': 320,
    'camera_height_px': 240,
    'camera_fovy_deg': 33.0,
  }
  agreed = Scenario(**fields).agreement
  team = waggle_tasks.Team(1, agreement=agreed)
  other = receivers.make('view_bank', agreed)
  environment = waggle_tasks.load('broadcast', **fields)
  timestep, seen, rewards = environment.reset(), [], []
  while not timestep.last():
    (now,) = timestep.observation
    assert now['camera'].shape == agreed.camera.shape == (240, 320, 3)
    if not any(event.message for event in seen):
      seen += other.step(now['camera'], float(now['time_s']))
    timestep = environment.step(team.step(timestep.observation))
    rewards += timestep.reward
  (place_m,) = (each['position_m'] for each in timestep.observation)
  environment.close()
  assert seen[-1].message.bits == '000010'
  assert sum(rewards) == 1
  np.testing.assert_allclose(place_m, [0.0, -0.9, 1.6], atol=0.002)


@pytest.mark.slow
@pytest.mark.parametrize('rate_hz', [12.5, 125])
def test_a_message_is_flown_to_the_agreed_height_at_any_rate(
  load: Callable[..., registry.composer.Environment], rate_hz: float
) -> None:
  scene = Scenario(
    observers=1,
    rate_hz=rate_hz,
    hover_height_m=2.5,
    codebook=gestures.v_codebook(0.03, 0.18, duration_s=1.2),
    pauses=timing.Timing(0.2, 0.0, 0.1, 0.0),
  )
  names = [field.name for field in dataclasses.fields(scene)]
  environment = load(
    cameras=False, **{name: getattr(scene, name) for name in names}
  )
  pilot = navigator.Navigator(scene.agreement)
  timestep, rewards = environment.reset(), []
  while not timestep.last():
    (seen,) = timestep.observation
    time_s, place_m = float(seen['time_s']), seen['position_m']
    if time_s >= scene.performance.end_s and pilot.target_m is None:
      pilot.accept(navigator.Command(scene.message, 'sent'), place_m, time_s)
    timestep = environment.step([pilot.step(place_m, time_s).to_array()])
    rewards += timestep.reward
  assert sum(rewards) == 1
  assert timestep.discount == 1
  assert environment.control_timestep() == pytest.approx(1 / rate_hz)
  np.testing.assert_allclose(place_m, [0.0, -0.9, 2.5], atol=0.001)


def test_the_defaults_are_those_of_the_paper() -> None:
  agreed = Scenario().agreement
  assert agreed == Agreement()
  assert (agreed.rate_hz, agreed.frame_s) == (25.0, 0.04)
  assert agreed.hover_height_m == 1.3
  assert agreed.camera.size == (640, 480)
  assert agreed.camera.fovy_deg == 60.0
  assert [agreed.frames(each) for each in (0.04, 0.68, 26.0)] == [1, 17, 650]
  assert Agreement(rate_hz=50).frames(0.68) == 34


@pytest.mark.parametrize('rate_hz', [10, 12.5, 31.25, 50, 62.5, 125])
def test_a_rate_is_a_whole_number_of_physics_steps(rate_hz: float) -> None:
  assert Agreement(rate_hz=rate_hz).frame_s * 250 == pytest.approx(
    round(250 / rate_hz)
  )


def test_a_rounded_rate_is_the_exact_one() -> None:
  assert Scenario(rate_hz=35.714286).rate_hz == 250 / 7


TALL = gestures.v_codebook(0.3, 2.0, duration_s=30.0)
DEEP = gestures.v_codebook(1.0, 0.6, duration_s=30.0)


@pytest.mark.parametrize(
  ('fields', 'error'),
  [
    ({'rate_hz': 30}, '`rate_hz` must be 250 over a whole number, .* 0.004 s,'),
    ({'rate_hz': 30}, 'such as 27.7778 or 31.25: got 30'),
    ({'rate_hz': 5}, '`rate_hz` must be between 10 and 125: got 5'),
    ({'rate_hz': 250}, '`rate_hz` must be between 10 and 125: got 250'),
    ({'rate_hz': math.nan}, '`rate_hz` must be a finite number: got nan'),
    ({'rate_hz': '50'}, "`rate_hz` must be a finite number: got '50'"),
    ({'hover_height_m': 0.2}, '`hover_height_m` must be between 0.5 and 5.5'),
    ({'hover_height_m': 7}, '`hover_height_m` must be between 0.5 and 5.5'),
    ({'hover_height_m': None}, '`hover_height_m` must be a finite number'),
    (
      {'hover_height_m': 1.05, 'codebook': DEEP},
      '`hover_height_m` must be at least 1.1, so that gestures stay 0.1 m above'
      ' the floor: got 1.05',
    ),
    (
      {'hover_height_m': 5.2, 'codebook': TALL},
      '`hover_height_m` must be at most 4.9, so that gestures stay 0.1 m under'
      ' the ceiling: got 5.2',
    ),
    ({'camera_width_px': 32}, '`camera_width_px` must be between 64 and 2048'),
    ({'camera_height_px': 4e3}, '`camera_height_px` must be an integer'),
    ({'camera_fovy_deg': 180}, '`camera_fovy_deg` must be between 10 and 120'),
    (
      {'rate_hz': 50, 'sensor': sensor_lib.Sensor(exposure_s=0.03)},
      '`exposure_s` must be at most 0.02 s, .* at 50 Hz: got 0.03',
    ),
    (
      {'rate_hz': 12.5, 'duration_s': 0.05},
      '`duration_s` must be .* 0.08',
    ),
  ],
)
def test_what_cannot_be_flown_is_refused_with_its_rule(
  fields: dict[str, object], error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=error):
    Scenario(**fields)


@dataclasses.dataclass(frozen=True)
class Steps:
  """Each observer higher than the last, and one at the height of all."""

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    usual = layouts.facing_performer(0.0, -1.3)
    own = [
      layouts.Pose((k - 3.0, -1.3, 1.0 + 0.5 * k), math.pi / 2)
      for k in range(1, count - 1)
    ]
    lifted = dataclasses.replace(usual, position_m=(1.5, -1.3, 1.5))
    return (*own, lifted, usual)


def test_who_has_a_height_of_its_own_keeps_it() -> None:
  scene = Scenario(observers=4, layout=Steps(), hover_height_m=2.0)
  heights_m = [pose.position_m[2] for pose in scene.poses().values()]
  assert heights_m == [2.0, 1.5, 2.0, 1.5, 2.0]
  everybody = Scenario(observers=3, layout='line', hover_height_m=2.0).poses()
  assert {pose.position_m[2] for pose in everybody.values()} == {2.0}


@pytest.mark.parametrize('new', [False, True])
def test_a_run_is_read_by_what_both_sides_knew(
  new: bool, tmp_path: pathlib.Path
) -> None:
  scene = Scenario()
  if new:
    scene = Scenario(rate_hz=50, hover_height_m=2, camera_width_px=320)
  config = writer.config(scene, 'klt')
  if not new:  # As runs were left before these could be chosen.
    for name in [*config['scenario']]:
      if name in ('rate_hz', 'hover_height_m') or name.startswith('camera_'):
        del config['scenario'][name]
    del config['agreement'], config['format']
  path = tmp_path / 'config.json'
  path.write_text(json.dumps(config), encoding='utf-8')
  assert archive.read_config(path).agreement == scene.agreement


@pytest.mark.parametrize(
  ('shape', 'part'),
  [
    ((480, 640, 3), (10, 20, 337, 253)),
    ((240, 320, 3), (10, 20, 337, 253)),
    ((480, 480, 3), (52, 20, 253, 253)),
    ((180, 320, 3), (10, 51, 337, 191)),
  ],
)
def test_an_image_of_another_shape_is_filmed_undistorted(
  shape: tuple[int, ...], part: tuple[int, ...]
) -> None:
  place = layout.Rect(10, 20, 337, 253)
  assert layout.fitted(place, np.empty(shape, np.uint8)) == layout.Rect(*part)


def test_a_film_has_as_many_pictures_as_there_are_images(
  tmp_path: pathlib.Path,
) -> None:
  scene = Scenario(rate_hz=12.5)
  with pytest.raises(errors.WaggleError, match=r'between 0.1 and 12.5: got 25'):
    film.Film(tmp_path, scene, fps=25)


def test_a_dance_too_fast_for_the_rate_is_told(
  short: dict[str, object],
) -> None:
  slow = Scenario(rate_hz=12.5, **short)
  told = reach.note([slow, Scenario()], 'klt')
  assert re.match(
    '1 of 2 scenarios may not be read: at a `rate_hz` of 12.5 the dance goes'
    ' up to 17.3 px from one image to the next, of which klt can follow 15 px;'
    ' it takes 14.4 Hz',
    told,
  )
  assert not reach.note([slow], 'view_bank')
  assert not reach.note([Scenario(rate_hz=10), Scenario(**short)], 'klt')
  assert nulls.needed_s('klt', slow.agreement) == pytest.approx(3.84)
