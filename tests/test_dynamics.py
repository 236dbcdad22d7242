"""Whole tasks with rotors: what is flown, seen, refused, and flown again."""

from collections.abc import Callable, Iterator
import dataclasses
import math

import mujoco
import numpy as np
import pytest

from waggle_tasks import plain, registry, scenario
from waggle_tasks.entities import airframe, crazyflie, performer
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.protocol import gestures, limits, reference, timing
from waggle_tasks.tasks import air, broadcast, parts, roles

Load = Callable[..., registry.composer.Environment]
HOME_M = np.array([0.0, 0.0, 1.3])
WHOLE = mujoco.mjtState.mjSTATE_INTEGRATION
# Small gestures that rotors can fly, begun at once.
QUICK = {
  'codebook': gestures.v_codebook(0.06, 0.1, duration_s=2.4),
  'pauses': timing.Timing(0.2, 0.2, 0.2, 0.2),
  'dynamics': 'rotors',
}


def fly(
  environment: registry.composer.Environment, frames: int | None = None
) -> Iterator[np.ndarray]:
  """Tells observers to stay, and yields all positions, (N, 3), every frame."""
  timestep = environment.reset()
  hold = [
    reference.Reference.hover(each['position_m']).to_array()
    for each in timestep.observation
  ]
  while not timestep.last() and (frames is None or frames > 0):
    timestep = environment.step(hold)
    frames = None if frames is None else frames - 1
    yield np.array(
      [*environment.task.positions_m(environment.physics).values()]
    )


def test_the_default_dance_is_flown_within_two_centimetres(load: Load) -> None:
  """Of START and two bits; Crazyswarm's mean error is under 2 cm."""
  environment = load(
    cameras=False, observers=2, dynamics='rotors', duration_s=38.0
  )
  task, errors_m, tilts_rad, watching_m = environment.task, [], [], []
  for places_m in fly(environment):
    time_s = environment.physics.time()
    wanted_m, _, _ = task.performer.motion(HOME_M, -math.pi / 2, time_s)
    errors_m.append(np.linalg.norm(places_m[0] - wanted_m))
    tilts_rad.append(task.fleet.flown()['performer'][0])
    watching_m.append(places_m[1:])
  assert np.mean(errors_m) < 0.002
  assert max(errors_m) < 0.005
  assert 2 < math.degrees(max(tilts_rad)) < 6
  # Nothing moves who only watches: their pictures need not be drawn anew.
  assert np.abs(np.diff(watching_m, axis=0)).max() < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize(
  'changes',
  [
    {},
    {'air': air.Air(1.0, 20.0, True), 'estimator': 'lighthouse'},
    {'rate_hz': 50.0},
    {'rate_hz': 10.0},
  ],
)
def test_a_seed_flies_the_same_again_and_rates_fly_alike(
  changes: dict[str, object], load: Load
) -> None:
  flown = []
  for _ in range(2):
    environment = load(
      cameras=False, observers=2, duration_s=4.0, **QUICK, **changes
    )
    flown.append(np.array([*fly(environment)]))
    task = environment.task
    wanted_m, _, _ = task.performer.motion(HOME_M, -math.pi / 2, 4.0)
    assert np.linalg.norm(flown[-1][-1, 0] - wanted_m) < 0.04
  np.testing.assert_array_equal(flown[0], flown[1])


@pytest.mark.parametrize(
  'changes', [{}, {'air': air.Air(1.0, 0.0, True), 'estimator': 'mocap'}]
)
def test_a_state_that_is_set_back_is_flown_on_as_before(
  changes: dict[str, object], load: Load
) -> None:
  environment = load(
    cameras=False, observers=1, duration_s=6.0, **QUICK, **changes
  )
  hold = [reference.Reference.hover(np.array([0, -1.3, 1.3])).to_array()]
  environment.reset()
  physics = environment.physics
  flown: list[list[np.ndarray]] = [[], []]
  for _ in range(40):
    environment.step(hold)
  state = physics.get_state(WHOLE)
  for run in flown:
    for _ in range(40):
      environment.step(hold)
      run.append(np.array(physics.data.qpos))
    physics.set_state(state, WHOLE)
  assert np.ptp(flown[0], axis=0).max() > 0.02
  np.testing.assert_allclose(flown[0], flown[1], atol=1e-9)


@pytest.mark.parametrize(
  ('codebook', 'error'),
  [
    (
      gestures.v_codebook(0.12, 0.25, duration_s=2.0),
      r'`gesture 0` must accelerate sideways by at most 2 m/s\^2, which the'
      r' vehicle has: got 2.77 m/s\^2 in 2 s; in 2.4\d s it can be flown',
    ),
    (
      gestures.v_codebook(0.03, 0.18, duration_s=1.2),
      r'change its acceleration sideways by at most 30 m/s\^3.*got 6\d',
    ),
  ],
)
def test_a_gesture_that_rotors_cannot_fly_is_refused_before_the_flight(
  codebook: gestures.Codebook, error: str
) -> None:
  scenario.Scenario(codebook=codebook)  # Ideal forces can.
  with pytest.raises(limits.LimitError, match=error):
    scenario.Scenario(codebook=codebook, dynamics='rotors')


def test_a_gesture_is_flown_in_the_time_that_a_refusal_names() -> None:
  duration_s, refusals = 1.2, 0
  while True:
    codebook = gestures.v_codebook(0.12, 0.25, duration_s)
    try:
      limits.check_motions(codebook.gestures, limits.LIMITS['rotors'])
    except limits.LimitError as error:  # Of one gesture after another.
      duration_s = float(str(error).split('; in ')[1].split()[0])
      refusals += 1
    else:
      break
  assert 1 <= refusals <= 3
  assert 2.4 < duration_s < 2.6


def test_propellers_that_turn_are_the_same_in_every_picture() -> None:
  resting, turning = (
    {part.name: part for part in airframe.parts((1, 1, 1, 1), spinning)}
    for spinning in (False, True)
  )
  assert turning.keys() - resting.keys() == {'blurs'}
  for name in resting.keys() - {'propellers'}:
    for one, other in zip(
      resting[name].solids, turning[name].solids, strict=True
    ):
      np.testing.assert_array_equal(one.vertices_m, other.vertices_m)
  blur = turning['blurs']
  assert 0 < blur.rgba[3] < 0.5  # What is behind it is seen.
  for solid in blur.solids:  # As round as it is drawn: it cannot beat.
    middle = solid.vertices_m.mean(axis=0)
    away_m = np.linalg.norm((solid.vertices_m - middle)[:, :2], axis=1)
    np.testing.assert_allclose(away_m, away_m[0], atol=1e-9)
    assert away_m[0] < crazyflie.ROTOR_RADIUS_M


@pytest.mark.slow
@pytest.mark.parametrize('observers', [1, 3])
def test_pictures_in_parts_equal_full_ones_where_bodies_and_eyes_tilt(
  observers: int, load: Load
) -> None:
  """The dancer flies, and who watches is blown about."""
  films = {}
  for camera in ('incremental', 'full'):
    environment = load(
      observers=observers, duration_s=1.4, camera=camera, distance_m=0.8,
      air=air.Air(2.0, 40.0, True), estimator='flow_deck',
      camera_width_px=320, camera_height_px=240, **QUICK,
    )  # fmt: skip
    timestep, pictures = environment.reset(), []
    hold = [
      reference.Reference.hover(each['position_m']).to_array()
      for each in timestep.observation
    ]
    while not timestep.last():
      pictures.append([e['camera'].copy() for e in timestep.observation])
      timestep = environment.step(hold)
    films[camera] = np.array(pictures)
    eye = environment.physics.named.data.cam_xmat['observer_1/eye']
    assert abs(eye[7]) < 0.9999  # It is tilted: the image's up is not z.
  np.testing.assert_array_equal(films['incremental'], films['full'])
  assert (np.diff(films['full'], axis=0) != 0).any()


def test_dynamics_air_and_estimates_have_flags_and_go_through_files() -> None:
  known = scenario_fields.defaults()
  usual = {
    'dynamics': 'ideal', 'wind_mps': 0.0, 'wind_deg': 0.0, 'gusts': False,
    'downwash': False, 'estimator': 'none',
  }  # fmt: skip
  assert usual.items() <= known.items()
  scene = scenario_fields.make(
    {
      'dynamics': 'rotors', 'wind_mps': 1.5, 'wind_deg': -30, 'gusts': True,
      'estimator': 'flow_deck',
    }
  )  # fmt: skip
  assert scene.air == air.Air(1.5, -30, True)
  assert plain.from_plain(scenario.Scenario, plain.to_plain(scene)) == scene
  table = plain.to_plain(scenario.Scenario())
  for field in ('dynamics', 'air', 'estimator'):  # Of an older program.
    del table[field]
  assert plain.from_plain(scenario.Scenario, table) == scenario.Scenario()


def test_parts_of_other_dynamics_are_refused() -> None:
  ideal = registry.parts(scenario.Scenario(observers=1))
  turning = registry.parts(scenario.Scenario(observers=1, **QUICK))
  for made, changes, error in (
    (
      turning,
      {'roles': ideal.roles},
      '`dynamics` of performer must be',
    ),
    (ideal, {'dynamics': 'rotors'}, '`dynamics` of performer must be'),
    (ideal, {'air': air.Air(1.0)}, '`air` and `estimator` must not be given'),
    (ideal, {'estimator': 'mocap'}, '`air` and `estimator` must not be given'),
    (ideal, {'dynamics': 'jets'}, "`dynamics` must be one of ..ideal'"),
  ):
    with pytest.raises(parts.PartsError, match=error):
      dataclasses.replace(made, **changes)


def test_a_second_dancer_flies_with_rotors_too(load: Load) -> None:
  scene = scenario.Scenario(observers=1, duration_s=3.0, **QUICK)
  made = registry.parts(scene)
  place = dataclasses.replace(
    made.poses['performer'], position_m=(0.8, 0.5, 1.3)
  )
  other = roles.Role(
    performer.Performer('dancer', scene.dynamics),
    place,
    dataclasses.replace(scene, payload='111111').performance,
  )
  task = broadcast.Broadcast(
    dataclasses.replace(made, roles=(*made.roles, other))
  )
  environment = registry.of_task(task)
  for each in task.observers:
    each.observables.camera.enabled = False
  ways_m = np.array([*fly(environment)])
  environment.close()
  apart_m = ways_m[:, 0] - ways_m[:, -1]
  assert np.abs(apart_m - apart_m[0]).max() < 0.002
  assert np.ptp(ways_m[:, -1, 2]) > 0.08
