"""Grids and the cases that they make."""

import re
import types

import pytest

from waggle_tasks import errors
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.studies import sweep_cases

Make = types.SimpleNamespace


def test_cells_are_the_product_in_the_order_given(make: Make) -> None:
  cases = make.cases('distance_m=0.8,1.3', 'bearing_deg=0,15', repeats=2)
  assert [case.name for case in cases] == [
    'distance_m=0.8 bearing_deg=0.0 #0', 'distance_m=0.8 bearing_deg=0.0 #1',
    'distance_m=0.8 bearing_deg=15.0 #0', 'distance_m=0.8 bearing_deg=15.0 #1',
    'distance_m=1.3 bearing_deg=0.0 #0', 'distance_m=1.3 bearing_deg=0.0 #1',
    'distance_m=1.3 bearing_deg=15.0 #0', 'distance_m=1.3 bearing_deg=15.0 #1',
  ]  # fmt: skip
  scene = cases[-1].scene
  assert (scene.distance_m, scene.bearing_deg) == (1.3, 15.0)


def test_a_sweep_without_a_grid_is_one_cell(make: Make) -> None:
  cases = make.cases(repeats=3, distance_m=1.6)
  assert [case.name for case in cases] == ['#0', '#1', '#2']
  assert {case.scene.distance_m for case in cases} == {1.6}


def test_fields_of_groups_are_fields_of_the_grid(make: Make) -> None:
  cases = make.cases('noise_sigma=0,5', 'gap_s=2,2.5', 'observers=1,2')
  assert [
    (c.scene.sensor.noise_sigma, c.scene.pauses.gap_s, c.scene.observers)
    for c in cases[:3]
  ] == [(0.0, 2.0, 1), (0.0, 2.0, 2), (0.0, 2.5, 1)]


def test_every_case_has_a_seed_of_its_own(make: Make) -> None:
  cases = make.cases('distance_m=0.8,1.3', repeats=20)
  assert len({case.scene.seed for case in cases}) == 40


def test_more_values_and_repeats_leave_the_other_cases_as_they_are(
  make: Make,
) -> None:
  few = make.cases('distance_m=1.3', 'bearing_deg=0,15', payload='random')
  more = make.cases(
    'bearing_deg=15,30,0', 'distance_m=0.8,1.3', repeats=3, payload='random'
  )
  scenes = [case.scene for case in more]
  assert all(case.scene in scenes for case in few)


def test_another_scenario_is_another_draw_however_it_is_said(
  make: Make,
) -> None:
  (swept,) = make.cases('distance_m=1.6', 'observers=1', 'bearing_deg=0')
  (said,) = make.cases(distance_m=1.6, observers=1)
  (other,) = make.cases('distance_m=1.6', 'observers=1', gap_s=2.5)
  assert swept.scene == said.scene
  assert swept.scene.seed != other.scene.seed


def test_another_base_seed_gives_other_seeds_and_payloads(make: Make) -> None:
  one, other = (
    make.cases(repeats=30, payload='random', seed=seed) for seed in (0, 1)
  )
  assert not {c.scene.seed for c in one} & {c.scene.seed for c in other}
  payloads = [[c.scene.payload for c in cases] for cases in (one, other)]
  assert payloads[0] != payloads[1]


@pytest.mark.slow
def test_random_payloads_are_about_evenly_spread(make: Make) -> None:
  cases = make.cases(repeats=640, payload='random')
  counts = [0] * 64
  for case in cases:
    counts[int(case.scene.payload, 2)] += 1
  # Each is binomial with mean 10: beyond 1 to 27 once in thousands of seeds.
  assert min(counts) >= 1
  assert max(counts) <= 27


def test_all_payloads_can_be_asked_for(make: Make) -> None:
  cases = make.cases('payload=all')
  assert len({case.scene.payload for case in cases}) == 64


@pytest.mark.parametrize(
  ('grid', 'error'),
  [
    (['distance_m'], "`grid` must be NAME=VALUE,VALUE,...: got 'distance_m'"),
    (['distanc_m=1'], "got 'distanc_m'. Did you mean distance_m"),
    (['distance_m='], "`distance_m` must be of type float: got ''"),
    (['distance_m=1,,2'], "`distance_m` must be of type float: got ''"),
    (['distance_m=1,far'], "`distance_m` must be of type float: got 'far'"),
    (['distance_m=1,1.0'], "`grid` must give a value once: got 'distance_m="),
    (['gap_s=2', 'gap_s=3'], '`grid` must name a field once: got gap_s again'),
    (['seed=1,2'], '`grid` must not name seed: every case has its own'),
    (['codebook=1'], "`grid` must be one of ['control', "),
    (
      ['distance_m=1,9'],
      'cell distance_m=9.0: `distance_m` must be between 0.2 and 4: got 9.0',
    ),
    (
      ['observers=2,40', 'distance_m=0.6'],
      'cell observers=40 distance_m=0.6: observer_1 and observer_2 must start',
    ),
    (
      ['layout=arc,line', 'spacing_m=0.1,0.6'],
      'cell layout=line spacing_m=0.1: observer_1 and observer_2 must start',
    ),
    (['payload=random,all'], 'cell payload=all: `payload` must be 6'),
    (
      ['payload=all', 'heading_bits=3,4'],
      '`grid` may hold payload=all for at most 10 bits, and not beside other'
      " numbers of bits: got ['heading_bits']",
    ),
    (
      ['distance_m=' + ','.join(str(1 + n / 10000) for n in range(1001)),
       'gap_s=' + ','.join(str(2 + n / 10000) for n in range(1000))],
      '`grid` and `repeats` must make at most 1000000 cases: got 1001000',
    ),
  ],
)  # fmt: skip
def test_what_cannot_be_swept_is_refused(
  make: Make, grid: list[str], error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=re.escape(error)):
    make.cases(*grid)


def test_fields_that_can_be_swept_are_listed_without_the_seed(
  make: Make,
) -> None:
  with pytest.raises(errors.WaggleError) as refused:
    make.cases('colour=red')
  assert "'distance_m'" in str(refused.value)
  assert "'seed'" not in str(refused.value)


@pytest.mark.parametrize('repeats', [0, -1, 10**6 + 1])
def test_a_number_of_repeats_that_makes_no_sense_is_refused(
  make: Make, repeats: int
) -> None:
  with pytest.raises(sweep_cases.SweepError, match='`repeats` must be between'):
    make.cases(repeats=repeats)


def test_bits_are_drawn_like_payloads() -> None:
  base = scenario_fields.defaults() | {'language': 'swift', 'bits': 'random:9'}
  cases = sweep_cases.cases({'distance_m': [1.0, 1.3]}, base, 2)
  sent = {case.values['bits'] for case in cases}
  assert {len(bits) for bits in sent} == {9}
  assert len(sent) > 1
