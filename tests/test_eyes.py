"""Cameras by name, and those of one's own, in a scenario."""

import contextlib
import dataclasses

import numpy as np
import pytest

from waggle_tasks import (
  errors,
  eye_presets,
  eyes,
  plain,
  registry,
  scenario,
  suites,
)
from waggle_tasks.experiments.record import changes, eye_fields, scenario_fields
from waggle_tasks.experiments.studies import sweep_cases
from waggle_tasks.protocol import reference

SMALL = {'camera_width_px': 160, 'camera_height_px': 120}
SIZES = ('camera_width_px', 'camera_height_px', 'camera_fovy_deg', 'rate_hz')


def test_the_default_is_the_paper_s_camera() -> None:
  scene = scenario.Scenario()
  assert scene.eye.is_ideal
  assert scene.agreement.camera.is_plain
  assert scenario.Scenario(eye='ideal') == scene


def test_each_name_is_a_camera_with_its_size_and_its_rate() -> None:
  assert (eyes.IDEAL, *eye_presets.PRESETS) == eyes.NAMES
  for name, preset in eye_presets.PRESETS.items():
    scene = scenario.Scenario(eye=name)
    assert scene.eye == preset.eye
    assert not scene.eye.is_ideal
    assert [getattr(scene, each) for each in SIZES] == [*preset.frame.values()]
    assert scene == scenario.Scenario(**eye_presets.fields(name))


def test_both_sides_know_the_calibration() -> None:
  seen_with = scenario.Scenario(eye='webcam').agreement.camera
  assert seen_with.lens.model == 'brown'
  assert seen_with.focal_px == pytest.approx(622.0, abs=0.1)
  assert seen_with.readout_s == 0.03


def test_a_scenario_with_a_camera_is_plain_data_and_back() -> None:
  scene = scenario.Scenario(eye='fpv')
  assert plain.from_plain(scenario.Scenario, plain.to_plain(scene)) == scene


def test_flags_change_a_camera_that_is_named() -> None:
  scene = scenario_fields.make({'eye': 'phone', 'shutter_s': 0.02})
  assert (scene.eye.shutter_s, scene.eye.codec) == (0.02, 'h264')
  assert (scene.camera_width_px, scene.rate_hz) == (1280, 31.25)
  values = scenario_fields.flat(plain.to_plain(scene))
  assert scenario_fields.make(values) == scene


@pytest.mark.parametrize(
  ('values', 'error'),
  [
    ({'eye': 'phone', 'camera_width_px': 64}, '`camera_width_px` must be 1280'),
    ({'eye': 'fpv', 'rate_hz': 50.0}, '`rate_hz` must be 25 or left out'),
    ({'eye': 'fone'}, '`eye` must be one of .* Did you mean phone'),
    ({'readout_s': 0.2}, '`readout_s` must be between 0 and 0.1'),
    ({'well_electrons': 3.0}, '`well_electrons` must be 0 or at least 10'),
    ({'grey': True, 'mosaic': True}, '`mosaic` must be False'),
    ({'codec': 'mpeg'}, '`codec` must be one of'),
    ({'pitch_deg': 50.0}, '`pitch_deg` must be between -45 and 45'),
    ({'lens': 'fisheye', 'camera_fovy_deg': 119.0}, '`lens` must see'),
  ],
)  # fmt: skip
def test_a_camera_that_cannot_be_is_refused(
  values: dict[str, object], error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=error):
    scenario_fields.make(values)


def test_a_name_without_its_values_is_refused_in_python() -> None:
  with pytest.raises(errors.WaggleError, match='must come with its values'):
    eyes.Eye('phone')
  with pytest.raises(errors.WaggleError, match=r'`rate_hz` must be 31\.25'):
    scenario.Scenario(eye='phone', rate_hz=50.0)


def shots(scene: scenario.Scenario, count: int = 3) -> np.ndarray:
  """(count, H, W, 3) the first pictures of the first observer."""
  environment = registry.environment(scene)
  with contextlib.closing(environment):
    timestep, out = environment.reset(), []
    spec = environment.observation_spec()[0]['camera']
    places = [each['position_m'] for each in timestep.observation]
    rest = [reference.Reference.hover(place_m).to_array() for place_m in places]
    for _ in range(count):
      out.append(np.array(timestep.observation[0]['camera']))
      spec.validate(out[-1])
      timestep = environment.step(rest)
  return np.array(out)


@pytest.mark.slow
@pytest.mark.parametrize(
  'name',
  [
    'ai_deck',
    *(
      pytest.param(n, marks=pytest.mark.long)
      for n in ('fpv', 'phone', 'webcam')
    ),
  ],
)
def test_pictures_are_of_the_camera_s_size_and_follow_from_the_seed(
  name: str,
) -> None:
  scene = scenario.Scenario(eye=name, observers=1)
  first, again = shots(scene), shots(scene)
  assert first.shape[1:] == scene.agreement.camera.shape
  np.testing.assert_array_equal(first, again)
  other = shots(dataclasses.replace(scene, seed=1))
  assert (other != first).any()


@pytest.mark.slow
def test_the_middle_of_a_bent_picture_is_that_of_a_pinhole_s() -> None:
  bent = eyes.Eye(lens='brown', k1=-0.1, k2=0.02)
  scene = scenario.Scenario(observers=1, eye=bent, **SMALL)
  straight = dataclasses.replace(
    scene,
    eye=eyes.Eye(),
    camera_fovy_deg=2
    * np.degrees(np.arctan(60 / scene.agreement.camera.focal_px)),
  )
  middle = slice(50, 70), slice(70, 90)
  one, other = (shots(s, 1)[0][middle].astype(int) for s in (scene, straight))
  assert np.abs(one - other).mean() < 1.0


@pytest.mark.slow
def test_a_camera_that_looks_up_sees_the_dancer_below_its_middle() -> None:
  level = scenario.Scenario(observers=1, **SMALL)
  up = dataclasses.replace(level, eye=eyes.Eye(pitch_deg=5.0))
  ahead = up.agreement.camera.shown(np.array([80.0, 60.0]))
  one, other = (shots(s, 1)[0].astype(int) for s in (level, up))
  down = round(ahead[1]) - 60
  assert down == pytest.approx(9, abs=1)
  moved = other[55 + down : 65 + down, 75:85] - one[55:65, 75:85]
  there = other[55:65, 75:85] - one[55:65, 75:85]
  assert np.abs(moved).mean() < 0.4 * np.abs(there).mean()


def test_a_command_that_makes_a_scenario_again_names_its_camera() -> None:
  for values in (
    {'eye': 'phone'},
    {'eye': 'phone', 'mosaic': False, 'shutter_s': 0.02},
    {'grey': True},
  ):
    scene = scenario_fields.make(values)
    flags = scenario_fields.flags(scenario_fields.flat(plain.to_plain(scene)))
    said = dict(each.removeprefix('--').split('=') for each in flags)
    assert said.keys() == values.keys(), said
    again = {n: scenario_fields.parse(n, text) for n, text in said.items()}
    assert scenario_fields.make(again) == scene
    assert {c.split('=')[0] for c in changes.of(scene)} == {*values}


def test_a_grid_of_cameras_flies_each_with_its_own_numbers() -> None:
  base = scenario_fields.defaults() | {'read_noise': 4.0}
  grid = {'eye': ['ideal', 'phone', 'webcam'], 'shutter_s': [0.0, 0.02]}
  drawn = sweep_cases.cases(grid, base, 1)
  scenes = [each.scene for each in drawn]
  assert [s.camera_width_px for s in scenes] == [640, 640, 1280, 1280, 640, 640]
  assert [s.eye.shutter_s for s in scenes] == [0.0, 0.02] * 3
  assert {s.eye.read_noise for s in scenes} == {4.0}
  assert [s.eye.codec for s in scenes[::2]] == ['none', 'h264', 'jpeg']
  for each in drawn:
    whole = eye_fields.filled(
      each.values, scenario_fields.defaults(), each.cell
    )
    assert scenario_fields.make(whole) == each.scene


def test_a_suite_names_cameras() -> None:
  (case,) = suites.from_rows([{'name': 'seen', 'eye': 'fpv'}])
  assert case.scene.camera_fovy_deg == 82.5
  with pytest.raises(errors.WaggleError, match='`rate_hz` must be 25'):
    suites.from_rows([{'name': 'seen', 'eye': 'fpv', 'rate_hz': 50}])
