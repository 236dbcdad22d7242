"""Configurations take any number, and keep a plain one."""

from collections.abc import Callable
import dataclasses
import fractions
import json
import pickle

import numpy as np
import pytest

from waggle_tasks import appearance, errors, scenario, sensor
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import checks, gestures, payload, timing
from waggle_tasks.tasks import drift, surroundings

Number = Callable[[float], object]

# What makes a configuration from one of its numbers, which may be a whole one.
WHOLE = {
  'observers': lambda n: scenario.Scenario(observers=n),
  'seed': lambda n: scenario.Scenario(seed=n),
  'black_observer': lambda n: scenario.Scenario(
    control='black_input', observers=5, black_observer=n
  ),
  'late_frames': lambda n: sensor.Sensor(late_frames=n),
  'bystanders': lambda n: surroundings.Surroundings(bystanders=n),
  'heading': lambda n: payload.Payload(0, n, n),
  'payload': payload.Payload.from_int,
}
ANY = {
  'distance_m': lambda n: scenario.Scenario(distance_m=n),
  'duration_s': lambda n: scenario.Scenario(duration_s=n),
  'noise_sigma': lambda n: sensor.Sensor(noise_sigma=n),
  'drift_time_s': lambda n: drift.Drift(drift_time_s=n),
  'occluder_mps': lambda n: surroundings.Surroundings(occluder_mps=n),
  'brightness': lambda n: appearance.Appearance(brightness=n),
  'gap_s': lambda n: timing.Timing(gap_s=n),
  'heading_step_rad': lambda n: payload.Units(heading_step_rad=n),
  'gesture_s': lambda n: gestures.v_codebook(duration_s=n),
  'width': lambda n: gestures.v_codebook(half_width_m=n, start_height_m=n),
  'corners': lambda n: gestures.Gesture(
    'START', [[0, 0], (0, n), np.zeros(2, int)], n
  ),
  'arc': lambda n: layouts.Arc(n, n, n),
  'line': lambda n: layouts.Line(n, n),
  'pose': lambda n: layouts.Pose((n, n, n), n),
}


def text(value: object) -> str:
  """A configuration as it is written; strict about what it holds."""
  if not dataclasses.is_dataclass(value):
    return json.dumps(value)
  fields = dataclasses.asdict(value)
  return json.dumps(fields, sort_keys=True, default=dataclasses.asdict)


@pytest.mark.parametrize('kind', [np.int64, np.uint8, np.int16])
@pytest.mark.parametrize('name', sorted((WHOLE | ANY).keys() - {'width'}))
def test_any_whole_number_is_kept_as_a_plain_int(
  name: str, kind: Number
) -> None:
  make = (WHOLE | ANY)[name]
  made, plain = make(kind(1)), make(1)
  assert made == plain
  assert repr(made) == repr(plain)
  assert text(made) == text(plain)
  assert pickle.dumps(made) == pickle.dumps(plain)


@pytest.mark.parametrize(
  'kind', [np.float64, np.float32, np.float16, fractions.Fraction]
)
@pytest.mark.parametrize('name', ANY)
def test_any_real_number_is_kept_as_a_plain_float(
  name: str, kind: Number
) -> None:
  made, plain = ANY[name](kind(1.0625)), ANY[name](1.0625)
  assert made == plain
  assert repr(made) == repr(plain)
  assert text(made) == text(plain)
  assert pickle.dumps(made) == pickle.dumps(plain)


@pytest.mark.parametrize('value', [True, np.True_, '1', 1j, np.ones(1)])
@pytest.mark.parametrize('name', sorted((WHOLE | ANY).keys() - {'pose'}))
def test_what_is_no_number_is_refused(name: str, value: object) -> None:
  with pytest.raises(errors.WaggleError, match=r'number|integer'):
    (WHOLE | ANY)[name](value)


@pytest.mark.parametrize('value', [1.0, np.float64(1.0), np.float32(2.0)])
@pytest.mark.parametrize('name', WHOLE)
def test_a_count_is_no_float(name: str, value: float) -> None:
  with pytest.raises(errors.WaggleError, match='must be an integer: got'):
    WHOLE[name](value)


@pytest.mark.parametrize(
  'value', [np.float64('nan'), -np.inf, 10**400, -(10**400)]
)
def test_a_number_without_a_size_is_refused(value: float) -> None:
  with pytest.raises(scenario.ScenarioError, match='must be a finite number'):
    scenario.Scenario(distance_m=value)


@pytest.mark.parametrize('value', [True, np.True_, np.False_])
def test_switches_are_kept_as_plain_ones(value: bool) -> None:
  assert appearance.Appearance(shadows=value).shadows is bool(value)
  with pytest.raises(errors.WaggleError, match='must be True or False: got 1'):
    checks.switch('shadows', 1, errors.WaggleError)


def test_a_scenario_of_numpy_numbers_is_the_same_scenario() -> None:
  made = scenario.Scenario(
    observers=np.int64(2),
    distance_m=np.float32(1.5),
    sensor=sensor.Sensor(noise_sigma=np.float64(2)),
    codebook=gestures.v_codebook(np.float64(0.2), duration_s=np.int32(6)),
  )
  plain = scenario.Scenario(
    observers=2,
    distance_m=1.5,
    sensor=sensor.Sensor(noise_sigma=2.0),
    codebook=gestures.v_codebook(0.2, duration_s=6),
  )
  assert made == plain
  assert hash(made) == hash(plain)
  assert repr(made) == repr(plain)
  assert pickle.loads(pickle.dumps(made)) == plain
