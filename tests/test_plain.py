"""Values as plain data and back: nothing is lost, nothing wrong is taken."""

from collections.abc import Sequence
import dataclasses
import enum
import json
import pathlib
import re
import sys
from typing import Any, Literal

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

import waggle_tasks
from waggle_tasks import (
  appearance,
  errors,
  plain,
  scenario,
  scenarios,
  sensor,
  suites,
)
from waggle_tasks.agents import observer_agent, receiver, recogniser
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.protocol import clock, frame, gestures, payload, timing
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import drift, hover, surroundings


def through_json(value: object) -> Any:  # noqa: ANN401
  """A value as it comes from a file."""
  return json.loads(json.dumps(plain.to_plain(value), allow_nan=False))


@pytest.mark.parametrize('name', scenarios.SCENARIOS)
def test_a_named_scenario_and_its_agreement_come_back(name: str) -> None:
  scene = scenarios.find(name)
  assert plain.from_plain(scenario.Scenario, through_json(scene)) == scene
  agreed = scene.agreement
  assert plain.from_plain(type(agreed), through_json(agreed)) == agreed


@pytest.mark.parametrize('name', suites.SUITES)
def test_every_scenario_of_the_paper_comes_back(name: str) -> None:
  for case in suites.find(name):
    table = through_json(case.scene)
    assert plain.from_plain(scenario.Scenario, table) == case.scene


SECONDS = st.floats(0, 10)
BANDS = st.tuples(*[st.floats(0, 0.4)] * hover.BANDS)
SCENES = st.builds(
  scenario.Scenario,
  control=st.sampled_from(scenario.CONTROLS),
  observers=st.just(2),
  distance_m=st.floats(1.0, 1.5),
  bearing_deg=st.floats(-30, 30),
  payload=st.integers(0, 63).map('{:06b}'.format),
  seed=st.integers(0, 2**32 - 1),
  duration_s=st.none() | st.floats(1, 600) | st.integers(1, 600),
  layout=st.sampled_from(
    ['arc', 'line', layouts.Arc(1.3, 0.5, 0.1), layouts.Line(1.2, 0.7)]
  ),
  codebook=st.builds(
    gestures.v_codebook, st.floats(0.1, 0.3), st.floats(0.3, 0.6),
    st.floats(6, 9),
  ),
  pauses=st.builds(timing.Timing, SECONDS, SECONDS, SECONDS, SECONDS),
  tolerance=st.builds(clock.Tolerance, st.floats(0, 0.2), SECONDS),
  units=st.builds(payload.Units, st.floats(0.1, 3), st.floats(0.01, 0.2)),
  appearance=st.builds(
    appearance.Appearance, st.sampled_from(appearance.FLOORS),
    st.sampled_from(appearance.WALLS), shadows=st.booleans(),
  ),
  surroundings=st.builds(
    surroundings.Surroundings, occluder_mps=st.floats(0.1, 2)
  ),
  drift=st.builds(
    drift.Drift, st.floats(0, 0.03), observer_hover=st.just('log'),
    performer_hover=st.sampled_from(drift.HOVERS),
    hover_log=st.builds(hover.Spectrum, *[BANDS] * 6),
  ),
  sensor=st.builds(
    sensor.Sensor, noise_sigma=st.floats(0, 128), late_frames=st.integers(0, 25)
  ),
)  # fmt: skip


@settings(max_examples=25)
@given(SCENES)
def test_any_scenario_comes_back(scene: scenario.Scenario) -> None:
  assert plain.from_plain(scenario.Scenario, through_json(scene)) == scene


SCORES = recogniser.Recognition(Symbol.ZERO, '', Symbol.ZERO, 0.1, 0.2)
BITS = payload.Payload.from_bits('100011')


@pytest.mark.parametrize(
  'value',
  [
    receiver.Event(3.0, Symbol.NULL, frame.State.START),
    receiver.Event(9.0, Symbol.ZERO, frame.State.BIT, SCORES, BITS, 'no', 3.0),
    observer_agent.Navigation(
      9.0, observer_agent.Deed.ARRIVAL, (0.0, 1.0, 1.3), BITS, 7, 'ab'
    ),
    verdicts.Verdict((verdicts.Outcome('observer_1', None, failures=('a',)),)),
    suites.find('standard')[0],
  ],
)
def test_what_came_of_a_run_comes_back(value: object) -> None:
  assert plain.from_plain(type(value), through_json(value)) == value


# What classes from outside may hold.


class Colour(enum.Enum):
  RED = 1
  BLUE = 2


@dataclasses.dataclass(frozen=True)
class Leaf:
  size: int = 1


@dataclasses.dataclass(frozen=True)
class Twig(Leaf):
  bark: str = 'grey'


@dataclasses.dataclass(frozen=True)
class Tree:
  colour: Colour
  name: str | Leaf
  one: Leaf | Twig
  leaves: tuple[Leaf, ...] = ()
  pair: tuple[int, str] = (1, 'a')
  more: list[float] = dataclasses.field(default_factory=list)
  kinds: frozenset[int] = frozenset()
  by_name: dict[str, Leaf] = dataclasses.field(default_factory=dict)
  some: Sequence[Leaf] = ()
  maybe: Leaf | None = None
  word: Literal['in', 'out'] = 'in'
  home: pathlib.Path = pathlib.Path()
  twice: int = dataclasses.field(init=False, default=2)


def test_whatever_a_dataclass_may_hold_comes_back() -> None:
  leaf = Leaf(2)
  tree = Tree(
    Colour.BLUE, leaf, Twig(3), (leaf, Leaf()), (2, 'b'), [0.5], frozenset({3}),
    {'a': leaf}, (leaf,), leaf, 'out', pathlib.Path('a/b'),
  )  # fmt: skip
  assert plain.from_plain(Tree, through_json(tree)) == tree
  same = dataclasses.replace(tree, name='oak', maybe=None)
  assert plain.from_plain(Tree, through_json(same)) == same


def test_a_table_of_another_class_than_declared_is_refused() -> None:
  table = through_json(Tree(Colour.RED, 'a', Leaf()))
  table['one'] = {f'{__name__}:Tree': {}}
  error = '`one` must be a table of Leaf or a table of Twig: got .*:Tree'
  with pytest.raises(plain.PlainError, match=error):
    plain.from_plain(Tree, table)


@dataclasses.dataclass(frozen=True, eq=False)
class Way:
  places_m: np.ndarray
  length: float


def test_arrays_come_back_as_arrays_of_numbers() -> None:
  places_m = np.arange(6.0).reshape(2, 3)
  made = plain.from_plain(Way, through_json(Way(places_m, np.float32(2.0))))
  np.testing.assert_array_equal(made.places_m, places_m)
  assert (type(made.length), made.length) == (float, 2.0)
  for odd in ([[1], [1, 2]], ['a'], 3):
    with pytest.raises(plain.PlainError, match='`places_m` must be an array'):
      plain.from_plain(Way, {'places_m': odd, 'length': 1.0})


def test_a_layout_from_outside_comes_back_where_it_can_be_imported(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  (tmp_path / 'ringed.py').write_text(
    'import dataclasses\nfrom waggle_tasks.arenas import layouts\n'
    '@dataclasses.dataclass(frozen=True)\nclass Ring:\n  radius_m: float\n'
    '  def poses(self, count):\n'
    '    return layouts.Arc(self.radius_m, 0.5, 0.0).poses(count)\n'
    'class Plain(Ring):\n  pass\n'
    'class Loose:\n  def poses(self, count):\n'
    '    return Ring(1.2).poses(count)\n'
  )
  monkeypatch.syspath_prepend(tmp_path)
  import ringed

  scene = scenario.Scenario(layout=ringed.Ring(1.4))
  table = through_json(scene)
  assert table['layout'] == {'ringed:Ring': {'radius_m': 1.4}}
  assert plain.from_plain(scenario.Scenario, table) == scene
  loose = through_json(scenario.Scenario(layout=ringed.Loose()))
  error = '`layout` must be of a dataclass, else it cannot be made again'
  with pytest.raises(plain.PlainError, match=error):
    plain.from_plain(scenario.Scenario, loose)
  monkeypatch.undo()
  del sys.modules['ringed']
  error = '`layout` must be of a class that can be imported: ringed:Ring: Modul'
  with pytest.raises(plain.PlainError, match=error):
    plain.from_plain(scenario.Scenario, table)


@pytest.mark.parametrize(
  ('table', 'error'),
  [
    ({'pauses': {'gap': 1}}, '`s.pauses.gap` must be one of the fields'
     " ['initial_hover_s', 'settle_s', 'gap_s', 'lead_in_s']. Did you mean"
     ' gap_s?'),
    ({'pauses': {'gap_s': -1}}, '`s.pauses.gap_s` must be between 0 and 60:'
     ' got -1'),
    ({'pauses': 3}, '`s.pauses` must be a table of Timing: got 3'),
    ({'pauses': {'gap_s': True}}, '`s.pauses.gap_s` must be a finite number:'
     ' got True'),
    ({'distance_m': float('nan')}, '`s.distance_m` must be a finite number'),
    ({'duration_s': 'long'}, '`s.duration_s` must be a finite number or None:'
     " got 'long'"),
    ({'observers': 2.0}, '`s.observers` must be an integer: got 2.0'),
    ({'observers': 0}, '`s.observers` must be between 1 and 64: got 0'),
    ({'layout': ['arc']}, '`s.layout` must be text or a table of Layout'),
    ({'layout': {'Rows': {}}}, "`s.layout` must be a table {'package.module:"
     "Class': {...}}: got {'Rows': {}}"),
    ({'layout': {'math:sin': {}}}, '`s.layout` must be of a dataclass'),
    ({'layout': 'ring'}, "`s.layout` must be one of ['arc', 'line']"),
    ({'appearance': {'floor': 'plan'}}, '`s.appearance.floor` must be one of'),
    ({'codebook': {'gestures': [{'symbol': 'STRT'}]}},
     "`s.codebook.gestures[0].symbol` must be one of ['NULL', 'START', '0',"
     " '1', 'END', 'LEVEL', 'UNKNOWN']: got 'STRT'. Did you mean START?"),
    ({'codebook': {'gestures': [{'symbol': 'START'}]}},
     '`s.codebook.gestures[0].corners_m` must be given'),
    ({'codebook': {'gestures': [
      {'symbol': 'END', 'corners_m': [[1]], 'duration_s': 1.0}]}},
     '`s.codebook.gestures[0].corners_m[0]` must hold 2 values: got 1'),
    ({'codebook': {'half_width_m': 99}}, '`s.codebook.half_width_m` must be'),
    ([1], '`s` must be a table of Scenario: got [1]'),
  ],
)  # fmt: skip
def test_wrong_data_are_refused_with_the_path_of_the_field(
  table: object, error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=re.escape(error)):
    plain.from_plain(scenario.Scenario, table, 's')


def test_a_field_that_is_missing_has_its_default_or_is_named() -> None:
  assert plain.from_plain(scenario.Scenario, {}) == scenario.Scenario()
  with pytest.raises(plain.PlainError, match=r'`event\.symbol` must be given'):
    plain.from_plain(receiver.Event, {'time_s': 1.0}, 'event')


def test_the_public_names_make_a_scenario_again() -> None:
  scene = waggle_tasks.Scenario(observers=2, payload='110010')
  table = waggle_tasks.to_plain(scene)
  assert waggle_tasks.from_plain(waggle_tasks.Scenario, table) == scene
