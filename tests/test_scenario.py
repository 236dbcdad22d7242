"""A scenario refuses every choice that cannot be flown, by its name."""

from collections.abc import Callable
import dataclasses
import itertools
import math

import numpy as np
import pytest

from waggle_tasks import appearance, errors, scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import gestures, payload, timing
from waggle_tasks.tasks import safety

Scenario = scenario.Scenario


@dataclasses.dataclass(frozen=True)
class Places:
  """A layout that puts observers on given places."""

  places_m: tuple[tuple[float, float], ...]

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    del count
    return tuple(layouts.facing_performer(*place) for place in self.places_m)


def test_the_default_is_the_papers() -> None:
  default = Scenario()
  assert default.observers == 3
  assert default.layout == 'arc'
  assert default.distance_m == 1.3
  assert default.half_span_deg == 30
  assert default.payload == '000010'
  assert default.jitter_m == 0
  assert default.seed == 0
  assert default.control == 'none'
  assert default.appearance.shadows is False


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'payload': '0000'}, "`payload` must be 6 characters .* got '0000'"),
    ({'payload': '00002x'}, "`payload` must be 6 .* got '00002x'"),
    ({'payload': 10}, '`payload` must be 6 characters of 0 and 1.* got 10'),
    ({'observers': 0}, '`observers` must be between 1 and 64: got 0'),
    ({'observers': -1}, '`observers` must be between 1 and 64: got -1'),
    ({'observers': 65}, '`observers` must be between 1 and 64: got 65'),
    ({'observers': 2.0}, '`observers` must be an integer: got 2.0'),
    ({'observers': '3'}, "`observers` must be an integer: got '3'"),
    ({'observers': True}, '`observers` must be an integer: got True'),
    ({'distance_m': -1.3}, '`distance_m` must be between 0.2 and 4: got -1.3'),
    ({'distance_m': 1e9}, '`distance_m` must be between 0.2 and 4'),
    ({'distance_m': '1'}, "`distance_m` must be a finite number: got '1'"),
    ({'half_span_deg': 180.1}, '`half_span_deg` must be between 0 and 180'),
    ({'half_span_deg': -1}, '`half_span_deg` must be between 0 and 180'),
    ({'bearing_deg': 181}, '`bearing_deg` must be between -180 and 180'),
    ({'spacing_m': -0.6}, '`spacing_m` must be between 0 and 4: got -0.6'),
    (
      {'layout': 'lien'},
      r"`layout` must be one of \['arc', 'line'\]: got 'lien'. "
      r'Did you mean line\?',
    ),
    ({'layout': 3}, '`layout` must be .* got 3'),
    ({'layout': None}, '`layout` must be .* got None'),
    (
      {'control': 'nosend'},
      r"`control` must be one of .* got 'nosend'. Did you mean no_send",
    ),
    ({'camera': 'fast'}, r"`camera` must be one of \['incremental', 'full'\]"),
    ({'seed': -1}, '`seed` must be between 0 and 4294967295: got -1'),
    ({'seed': 2**32}, '`seed` must be between 0 and 4294967295'),
    ({'seed': 0.5}, '`seed` must be an integer: got 0.5'),
    ({'jitter_m': -0.01}, '`jitter_m` must be between 0 and 0.1: got -0.01'),
    ({'jitter_m': 0.2}, '`jitter_m` must be between 0 and 0.1: got 0.2'),
    ({'duration_s': 0.0}, '`duration_s` must be between 0.04 and 600: got 0'),
    ({'stop_s': -1.0}, '`stop_s` must be between 0 and 600: got -1.0'),
    (
      {'control': 'black_input', 'black_observer': 4},
      '`black_observer` must be between 1 and 3: got 4',
    ),
    (
      {'control': 'black_input', 'black_observer': 0},
      '`black_observer` must be between 1 and 3: got 0',
    ),
    ({'codebook': 'v'}, "`codebook` must be .* got 'v'"),
    ({'pauses': 2.0}, '`pauses` must be .* got 2.0'),
    ({'units': None}, '`units` must be .* got None'),
    ({'appearance': 'dark'}, "`appearance` must be .* got 'dark'"),
  ],
)
def test_a_choice_that_cannot_be_flown_is_refused(
  changes: dict[str, object], error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=error):
    Scenario(**changes)


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(
  'field',
  [
    'distance_m',
    'half_span_deg',
    'bearing_deg',
    'spacing_m',
    'jitter_m',
    'stop_s',
    'duration_s',
  ],
)
def test_a_number_that_is_not_finite_is_refused(
  field: str, value: float
) -> None:
  error = f'`{field}` must be a finite number: got {value}'
  with pytest.raises(scenario.ScenarioError, match=error):
    Scenario(**{field: value})


@pytest.mark.parametrize(
  ('make', 'error'),
  [
    (
      lambda: Scenario(codebook=gestures.v_codebook(half_width_m=math.nan)),
      '`half_width_m` must be a finite number: got nan',
    ),
    (
      lambda: Scenario(codebook=gestures.v_codebook(duration_s=math.nan)),
      'duration_s` must be a finite number: got nan',
    ),
    (
      lambda: Scenario(pauses=timing.Timing(gap_s=math.nan)),
      '`gap_s` must be a finite number: got nan',
    ),
    (
      lambda: Scenario(units=payload.Units(distance_unit_m=math.nan)),
      '`distance_unit_m` must be a finite number: got nan',
    ),
    (
      lambda: Scenario(appearance=appearance.Appearance(brightness=math.nan)),
      '`brightness` must be .* got nan',
    ),
    (
      lambda: Scenario(layout=layouts.Arc(math.nan)),
      '`radius_m` must be a finite number: got nan',
    ),
    (
      lambda: Scenario(layout=Places(((0, -1), (1, math.nan), (-1, -1)))),
      '`position_m` must be 3 finite numbers',
    ),
    ({'seed': math.nan}, '`seed` must be an integer: got nan'),
    ({'observers': math.nan}, '`observers` must be an integer: got nan'),
  ],
)
def test_nan_is_refused_wherever_it_is(
  make: Callable[[], object] | dict[str, float], error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=error):
    Scenario(**make) if isinstance(make, dict) else make()


@pytest.mark.parametrize(
  ('changes', 'pair'),
  [
    # The ends of a whole turn are one place.
    ({'half_span_deg': 180}, 'observer_1 and observer_3'),
    ({'layout': 'line', 'spacing_m': 0.1}, 'observer_1 and observer_2'),
    ({'observers': 64, 'distance_m': 0.5}, 'observer_1 and observer_2'),
    ({'half_span_deg': 1}, 'observer_1 and observer_2'),
    ({'half_span_deg': 0}, 'observer_1 and observer_2'),
    (
      {'layout': Places(((0, -1), (0.5, -1), (0, -0.05)))},
      'performer and observer_3',
    ),
    ({'distance_m': 0.2, 'jitter_m': 0.05}, 'performer and observer_1'),
  ],
)
def test_a_layout_in_which_vehicles_overlap_is_refused(
  changes: dict[str, object], pair: str
) -> None:
  error = rf'{pair} must start at least 0\.\d+ m apart: got 0\.\d+ m'
  with pytest.raises(layouts.LayoutError, match=error):
    Scenario(**changes)


def test_vehicles_stay_apart_whatever_the_jitter() -> None:
  jitter_m = 0.1
  worst_m = math.inf
  for distance_m in np.arange(0.2, 0.6, 0.005):
    step_m = distance_m / math.sqrt(2)
    try:
      scene = Scenario(
        observers=2,
        layout=Places(((0, -2), (step_m, -2 - step_m))),
        jitter_m=jitter_m,
      )
    except layouts.LayoutError:
      continue
    first, second = (
      np.array(scene.poses()[f'observer_{i}'].position_m[:2]) for i in (1, 2)
    )
    corners = list(itertools.product((-jitter_m, jitter_m), repeat=2))
    for one, other in itertools.product(corners, corners):
      apart_m = np.linalg.norm(first + one - second - other)
      worst_m = min(worst_m, float(apart_m))
  assert worst_m >= safety.MINIMUM_SPACING_M - 1e-9


def test_a_layout_of_another_number_of_places_is_refused() -> None:
  with pytest.raises(errors.WaggleError, match=r'`layout` must .* 3 .* got 2'):
    Scenario(layout=Places(((0, -1), (0.5, -1))))


@pytest.mark.parametrize('count', [1, 2, 3, 4, 5, 20])
@pytest.mark.parametrize('layout', ['arc', 'line'])
def test_any_number_of_observers_finds_a_place(count: int, layout: str) -> None:
  # Twenty need more room than the default arc has.
  wide = {'distance_m': 3.0, 'half_span_deg': 60.0} if count > 5 else {}
  poses = Scenario(observers=count, layout=layout, **wide).poses()
  names = ['performer', *(f'observer_{i}' for i in range(1, count + 1))]
  assert [*poses] == names


@pytest.mark.parametrize(
  ('changes', 'episode_s'),
  [
    ({}, 104.0),  # 92 s of dance, then the null, the flight and the hold.
    ({'control': 'no_send'}, 10.0),
    ({'control': 'interrupted'}, 60.0),
    ({'control': 'black_input'}, 104.0),
    ({'control': 'interrupted', 'duration_s': 5.0}, 5.0),
  ],
)
def test_an_episode_lasts_as_long_as_its_control_needs(
  changes: dict[str, object], episode_s: float
) -> None:
  assert Scenario(**changes).episode_s == pytest.approx(episode_s)


def test_a_bearing_places_a_single_observer_at_an_angle() -> None:
  pose = Scenario(observers=1, bearing_deg=85.0).poses()['observer_1']
  angle_rad = math.radians(85.0)
  assert pose.position_m == pytest.approx(
    (1.3 * math.sin(angle_rad), -1.3 * math.cos(angle_rad), 1.3)
  )
  ahead = Scenario(observers=1).poses()
  assert Scenario(observers=1, bearing_deg=0.0).poses() == ahead


def test_the_default_stop_is_the_papers() -> None:
  assert Scenario(control='interrupted').stop_s == 26.0


def test_another_codebook_and_timing_make_another_dance() -> None:
  scene = Scenario(
    codebook=gestures.v_codebook(duration_s=4.0),
    pauses=timing.Timing(1.0, 0.0, 1.0, 0.0),
    payload='101010',
  )
  assert scene.performance.schedule.end_s == pytest.approx(1 + 8 * 4 + 7)
  symbols = [slot.gesture.symbol for slot in scene.performance.schedule.slots]
  assert ' '.join(symbols) == 'START 1 0 1 0 1 0 END'


def test_a_scenario_is_a_value() -> None:
  assert Scenario(seed=1) == Scenario(seed=1) != Scenario(seed=2)
  assert len({Scenario(), Scenario(), Scenario(seed=1)}) == 2
  with pytest.raises(dataclasses.FrozenInstanceError):
    Scenario().seed = 1
  changed = dataclasses.replace(Scenario(seed=1), payload='111111')
  assert (changed.seed, changed.message.bits) == (1, '111111')
