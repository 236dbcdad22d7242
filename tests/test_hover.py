"""Hover as measured: its bands, its lean, its seeds, and how it is flown."""

from collections.abc import Callable
import functools
import math
import subprocess
import sys

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.results import hover_measure
from waggle_tasks.protocol import reference, timing
from waggle_tasks.tasks import drift, hover, hover_presets

PRESETS = [*hover_presets.PRESETS]
measured = functools.cache(hover_measure.figures)
STILL = timing.Timing(initial_hover_s=60.0)
NOTHING = (0.0,) * hover.BANDS


def drawn(name: str, seed: int = 0, **changes: float) -> drift.Sway:
  wanted = drift.Drift(observer_hover=name, **changes)
  return wanted.observer(np.random.RandomState(seed))


@pytest.mark.slow
@pytest.mark.parametrize('name', PRESETS)
def test_a_preset_does_what_its_source_has_measured(name: str) -> None:
  """Within 15 %, its bands within 20 %; the slowest shows some of the next."""
  preset = hover_presets.PRESETS[name]
  flown = measured(preset.spectrum)
  for axis, figures in preset.published.items():
    for quantity, value in figures.items():
      share = {'rms': 0.15, 'speed': 0.15, '0.2-0.55': 0.35}.get(quantity, 0.2)
      assert flown[axis][quantity] == pytest.approx(value, rel=share), (
        axis,
        quantity,
      )


@pytest.mark.slow
@pytest.mark.parametrize('name', PRESETS)
def test_a_hover_wanders_slowly_too(name: str) -> None:
  """Windows of 40 s show more of it than those of 4 s."""
  spectrum = hover_presets.PRESETS[name].spectrum
  moved = np.stack(
    [hover_measure.signal(spectrum, seed, 40.0, 5.0)[0] for seed in range(6)]
  )
  long = (moved - moved.mean(axis=1, keepdims=True)).std(axis=(0, 1))
  short = [
    figures['rms'] for figures in hover_measure.figures(spectrum).values()
  ]
  assert (long[:2] > 1.2 * np.array(short)[:2]).all()


@pytest.mark.parametrize('amplitude', [0.25, 0.5])
def test_an_amplitude_is_a_factor(amplitude: float) -> None:
  whole = drawn('mocap')
  part = drawn('mocap', hover_amplitude=amplitude)
  np.testing.assert_allclose(part.at(7.0), amplitude * np.array(whole.at(7.0)))
  np.testing.assert_allclose(
    part.attitude(7.0), amplitude * whole.attitude(7.0)
  )


@pytest.mark.slow
def test_a_hover_is_smooth_and_begins_at_rest() -> None:
  sway = drawn('flow_deck')
  step_s = 0.0005
  times_s = np.arange(0, 4, step_s)
  for ways in (
    np.array([sway.at(t) for t in times_s]),
    np.array([sway.attitude(t) for t in times_s]),
  ):
    np.testing.assert_array_equal(ways[0], 0)
    for order in (0, 1):
      slopes = np.gradient(ways[:, order], step_s, axis=0)[1:-1]
      scale = np.abs(ways[:, order + 1]).max()
      np.testing.assert_allclose(
        slopes, ways[1:-1, order + 1], atol=2e-3 * scale
      )


def test_who_hovers_is_said_by_role() -> None:
  wanted = drift.Drift(performer_hover='mocap')
  state = np.random.RandomState(0)
  assert wanted.performer(state).attitude(5.0).any()
  assert wanted.observer(state).attitude(5.0) is None
  assert not np.any(wanted.observer(state).at(5.0))


def test_a_hover_comes_on_top_of_a_drift() -> None:
  slow = drift.Drift(observer_drift_m=0.005).observer(np.random.RandomState(3))
  both = drawn('mocap', 3, observer_drift_m=0.005)
  apart = np.array(both.at(5.0)) - slow.at(5.0)
  np.testing.assert_allclose(apart[:, :3], both.hover.place(5.0))
  np.testing.assert_array_equal(apart[:, 3], 0)


@pytest.mark.parametrize(
  ('yaw_rad', 'axis', 'sign'),
  [(0.0, 1, 1), (math.pi, 1, -1), (math.pi / 2, 0, 1), (-math.pi / 2, 0, -1)],
)
def test_a_vehicle_leans_to_where_it_is_pushed(
  yaw_rad: float, axis: int, sign: int
) -> None:
  """Along x with a = g tan(tilt), whichever way it looks."""
  spectrum = hover.Spectrum(
    (0.0, 0.0, 4.0, 0.0, 0.0, 0.0), NOTHING, NOTHING, (0.5,) * 6, (0.5,) * 6,
    NOTHING,
  )  # fmt: skip
  way = hover.Hover(spectrum, 1.0, np.random.RandomState(0), yaw_rad)
  times_s = np.arange(2, 102, 0.05)
  pushed = np.array([way.place(t)[2, 0] for t in times_s]) / 9.81
  leans = np.array([way.attitude(t)[0] for t in times_s])  # (T, 3)
  assert leans[:, axis] @ pushed == pytest.approx(
    sign * pushed @ pushed, rel=0.15
  )
  other = leans[:, 1 - axis] @ pushed
  assert abs(other) < 0.15 * (pushed @ pushed)
  assert np.degrees(leans[:, :2].std(axis=0)) == pytest.approx(
    0.5 * math.sqrt(6), rel=0.15
  )


def test_what_references_are_too_slow_for_is_left_out() -> None:
  spectrum = hover.Spectrum(*[(0.0, 0.0, 0.0, 0.0, 0.0, 1.0)] * 6)
  for rate_hz, is_left_out in ((10.0, True), (25.0, False)):
    state = np.random.RandomState(0)
    way = hover.Hover(spectrum, 1.0, state, 0.0, rate_hz)
    moves = [way.place(t)[0] for t in np.arange(2, 6, 0.02)]
    assert (not np.any(moves)) == is_left_out


def test_a_hover_is_the_same_in_any_process() -> None:
  code = """if True:
    import numpy as np
    from waggle_tasks.tasks import drift
    wanted = drift.Drift(observer_hover='mocap')
    sway = wanted.observer(np.random.RandomState(7))
    print(repr([*sway.at(9.0)[0], *sway.attitude(9.0)[0]]))
  """
  child = subprocess.run(
    [sys.executable, '-c', code], capture_output=True, text=True, check=True
  )
  sway = drawn('mocap', 7)
  assert child.stdout.strip() == repr(
    [*sway.at(9.0)[0], *sway.attitude(9.0)[0]]
  )
  assert np.any(np.array(sway.at(9.0)) != drawn('mocap', 8).at(9.0))


def attitude_rad(environment: object, name: str) -> np.ndarray:  # (3,)
  """True roll, pitch and yaw of a vehicle."""
  body = environment.physics.named.data.xmat[f'{name}/airframe'].reshape(3, 3)
  return np.array(
    [
      math.atan2(body[2, 1], body[2, 2]),
      -math.asin(body[2, 0]),
      math.atan2(body[1, 0], body[0, 0]),
    ]
  )


@pytest.mark.slow
@pytest.mark.parametrize('rate_hz', [25.0, 10.0])
def test_bodies_truly_hover_so(rate_hz: float, load: Callable) -> None:
  """Place, and a tilt of which little is lost between two references."""
  environment = load(
    cameras=False, observers=1, rate_hz=rate_hz, pauses=STILL,
    drift=drift.Drift(performer_hover='mocap', observer_hover='lighthouse'),
  )  # fmt: skip
  timestep, task = environment.reset(), environment.task
  homes_m = task.positions_m(environment.physics)
  (observation,) = timestep.observation
  hold = [reference.Reference.hover(observation['position_m']).to_array()]
  begun = {name: attitude_rad(environment, name) for name in homes_m}
  leans = {name: [] for name in homes_m}
  for _ in range(round(20 * rate_hz)):
    environment.step(hold)
    places_m, drifts_m = task.positions_m(environment.physics), task.drifts_m()
    for name, home_m in homes_m.items():
      np.testing.assert_allclose(
        places_m[name] - home_m, drifts_m[name], atol=5e-4
      )
      turned = attitude_rad(environment, name) - begun[name]
      turned[2] = math.remainder(turned[2], math.tau)
      wanted = task.attitudes_rad()[name]
      leans[name].append(np.degrees([turned, wanted]))
  for name, roll_deg in (('performer', 0.5), ('observer_1', 0.4)):
    flown, wanted = np.moveaxis(leans[name], 1, 0)  # (T, 3) each
    assert (flown[:, :2].std(axis=0) > roll_deg).all()
    missed = (flown - wanted).std(axis=0) / wanted.std(axis=0)
    assert (missed < 0.25).all()


@pytest.mark.parametrize('name', PRESETS)
def test_neighbours_keep_their_distance_when_they_hover(name: str) -> None:
  wanted = drift.Drift(observer_hover=name)
  spectrum = hover_presets.PRESETS[name].spectrum
  moved = np.concatenate(
    [hover_measure.signal(spectrum, seed, 60.0, 5.0)[0] for seed in range(4)]
  )
  assert 2 * np.abs(moved[:, :3]).max() / 1000 < wanted.near_m < 0.2
  places = {'layout': 'line', 'spacing_m': 0.2, 'observers': 2}
  scenario.Scenario(**places)
  with pytest.raises(layouts.LayoutError, match='must start at least 0'):
    scenario.Scenario(**places, drift=wanted)


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'x_mm': (1.0,) * 5}, '`x_mm` must be 6 numbers, one for each band'),
    ({'x_mm': 3.0}, '`x_mm` must be numbers'),
    ({'y_mm': (-1.0, *[0.0] * 5)}, '`y_mm` must be between 0 and 30: got -1'),
    ({'yaw_deg': (6.0, *[0.0] * 5)}, '`yaw_deg` must be between 0 and 5'),
    ({'z_mm': (math.nan, *[0.0] * 5)}, '`z_mm` must be a finite number'),
  ],
)
def test_a_spectrum_that_is_none_is_refused(
  changes: dict[str, object], error: str
) -> None:
  axes = 'x_mm', 'y_mm', 'z_mm', 'roll_deg', 'pitch_deg', 'yaw_deg'
  with pytest.raises(hover.HoverError, match=error):
    hover.Spectrum(**{**dict.fromkeys(axes, NOTHING), **changes})
