"""Cells, maps, limits and fits of made results."""

import dataclasses
import math
import pathlib
import re

import numpy as np
import pytest

from waggle_tasks.experiments.pages import sweep_output
from waggle_tasks.experiments.results import (
  envelope,
  figures,
  heat,
  logistic,
  palette,
  sweep_fit,
  sweep_tables,
)
from waggle_tasks.experiments.studies import case_rows

SILENT = {
  'decoded': None,
  'start_s': None,
  'failures': ('message: none, motion 3 unknown: rmse 0.210 > 0.17',),
}
GRID = ('bearing_deg=0,40,80', 'distance_m=1.3,0.6', 'noise_sigma=0,5')


def far(case: object, number: int) -> dict[str, object]:
  """At 80 degrees two of five see nothing."""
  del number
  blind = case.values['bearing_deg'] == 80 and case.repeat < 2
  return SILENT if blind else {}


@pytest.fixture(scope='module')
def rows(make: object) -> list[case_rows.SweepRow]:
  """Sixty exposures, eight of which see nothing."""
  return make.rows(*GRID, repeats=5, fate=far, observers=1, payload='random')


def test_distance_goes_down_and_angle_across_and_noise_has_maps(
  rows: list[case_rows.SweepRow],
) -> None:
  maps = envelope.panels(rows)
  assert [each.fixed for each in maps] == [
    {'noise_sigma': 0.0}, {'noise_sigma': 5.0},
  ]  # fmt: skip
  for each in maps:
    assert (each.down, each.across) == ('distance_m', 'bearing_deg')
    assert (each.downs, each.acrosses) == ([0.6, 1.3], [0, 40, 80])
    counts = {k: envelope.count(v) for k, v in each.cells.items()}
    assert counts[0.6, 0] == envelope.Count(5, 5, 0, 0)
    assert counts[1.3, 80] == envelope.Count(5, 3, 0, 0)


@pytest.mark.parametrize(
  ('grid', 'axes', 'maps'),
  [
    (['distance_m=0.6,1.3'], ('distance_m', None), 1),
    (['bearing_deg=0,15'], (None, 'bearing_deg'), 1),
    (['half_span_deg=0,15', 'distance_m=1,2'],
     ('distance_m', 'half_span_deg'), 1),
    (['gap_s=2,3', 'noise_sigma=0,5'], ('gap_s', 'noise_sigma'), 1),
    (['noise_sigma=0,5', 'distance_m=1,2'], ('distance_m', 'noise_sigma'), 1),
    (['noise_sigma=0,5', 'bearing_deg=0,9'], ('noise_sigma', 'bearing_deg'), 1),
    (['gap_s=2,3', 'noise_sigma=0,5', 'brightness=1,2'],
     ('gap_s', 'brightness'), 2),
    (['control=no_send'], (None, None), 1),
    ([], (None, None), 1),
  ],
)  # fmt: skip
def test_axes_follow_from_what_differs(
  make: object, grid: list[str], axes: tuple[str | None, str | None], maps: int
) -> None:
  made = envelope.panels(make.rows(*grid, repeats=2, observers=1))
  assert len(made) == maps
  assert sum(len(panel.rows) for panel in made) == math.prod(
    [2 ** ('control' not in each) for each in grid], start=2
  )
  assert (made[0].down, made[0].across) == axes


def test_sweeps_are_put_together_by_what_differs_between_them(
  make: object,
) -> None:
  grid = 'bearing_deg=0,40'
  rows = [
    *make.rows(grid, 'noise_sigma=0,5', 'distance_m=1,3', observers=1),
    *make.rows(grid, 'distance_m=1', observers=1, noise_sigma=20.0),
  ]
  maps = envelope.panels(rows)
  assert [each.fixed['noise_sigma'] for each in maps] == [0, 5, 20]
  assert [len(each.cells) for each in maps] == [4, 4, 2]
  assert maps[2].downs == [1, 3]  # As in the others, with nothing at 3 m.
  table = sweep_tables.report(rows, None).split('sigma = 20:\n')[1]
  lines = table.split('\n\n')[0].splitlines()
  assert [line.split()[0] for line in lines[2:]] == ['1']


def test_receivers_are_a_factor_when_they_differ(make: object) -> None:
  one = make.rows('distance_m=1,2', observers=1)
  two = [dataclasses.replace(row, receiver='klt') for row in one]
  assert envelope.factors([*one, *two]) == ['receiver', 'distance_m']


def test_wrong_messages_and_motions_are_counted(make: object) -> None:
  fates = [
    {'decoded': '111111', 'failures': ('message: read 111111, sent 000010',)},
    {'decoded': None, 'start_s': 3.0},
    {'failures': ('premature motion: 0.020 m from 3.00 s',)},
    {'failures': ('safety: too close', 'arrival: never')},
    {'decoded': None, 'start_s': None},
    {},
  ]
  rows = make.rows(repeats=6, observers=1, fate=lambda c, _: fates[c.repeat])
  assert envelope.count(rows) == envelope.Count(6, 3, 1, 3)
  assert len(envelope.failures(rows)) == 4
  assert envelope.flaws_of_right(rows) == {'safety': 1, 'arrival': 1}


def test_a_message_where_nothing_was_sent_is_wrong(make: object) -> None:
  fate = {'decoded': '000010', 'start_s': 3.0}
  rows = make.rows(control='no_send', fate=lambda c, n: fate if n == 2 else {})
  assert envelope.count(rows) == envelope.Count(3, 2, 1, 1)


def test_the_report_says_what_is_in_the_cells(
  rows: list[case_rows.SweepRow],
) -> None:
  text = sweep_tables.report(rows, None)
  first = text.split('\n\n')[0].splitlines()
  assert first[0] == 'noise sigma = 0:'
  assert re.split(' {2,}', first[1]) == [
    r'distance_m \ bearing_deg', '0', '40', '80',
  ]  # fmt: skip
  # Clopper and Pearson's limits of 5 of 5 and 3 of 5.
  assert re.split(' {2,}', first[3]) == [
    '0.6', '5/5 48-100', '5/5 48-100', '3/5 15-95',
  ]  # fmt: skip
  assert 'right: 52/60 exposures (86.67%); 95 % interval 75.41%' in text
  # 1 - 0.05^(1/60)
  assert 'wrong messages: 0 in 60 exposures; at most 4.870%' in text
  assert 'Success falls below 90 % in 4 of 12 cells:' in text
  assert text.count('message: none, motion 3 unknown') == 8
  assert 'share its performer' not in text


def test_long_lists_are_cut_where_asked(rows: list[case_rows.SweepRow]) -> None:
  text = sweep_tables.report(rows, 3)
  assert text.count('message: none, motion 3 unknown') == 3
  assert text.endswith('  and 5 more')


def test_observers_of_one_broadcast_are_said_to_share_it(make: object) -> None:
  text = sweep_tables.report(make.rows(observers=3), None)
  assert 'The 3 exposures are those of 1 broadcasts' in text


def test_a_broadcast_of_two_sweeps_counts_once(make: object) -> None:
  text = sweep_tables.report(2 * make.rows(observers=3), None)
  assert 'The 6 exposures are those of 1 broadcasts' in text


# Fits.


def test_a_fit_that_cannot_be_is_said_to_be_none(make: object) -> None:
  def lines(blind: object) -> str:
    rows = make.rows(
      'bearing_deg=0,30,60', 'distance_m=1,2', repeats=2, observers=1,
      fate=lambda case, _: SILENT if blind(case) else {},
    )  # fmt: skip
    return '\n'.join(sweep_fit.lines(envelope.panels(rows)[0]))

  assert lines(lambda case: False).startswith(
    'no logistic fit: all 12 succeeded'
  )
  assert lines(lambda case: True) == 'no logistic fit: none of 12 succeeded.'
  assert 'are separated by angle and distance (8 of 12 succeeded)' in lines(
    lambda case: case.values['bearing_deg'] > 30
  )


@pytest.mark.slow
def test_the_fit_says_where_success_falls_below_90_percent(
  make: object,
) -> None:
  # Of 20: 20, 18 and 6 at 0, 40 and 80 degrees, whatever the distance.
  blind = {0.0: 0, 40.0: 2, 80.0: 14}
  rows = make.rows(
    'bearing_deg=0,40,80', 'distance_m=1,2,3', repeats=20, observers=1,
    fate=lambda case, _: (
      SILENT if case.repeat < blind[case.values['bearing_deg']] else {}
    ),
  )  # fmt: skip
  head, angle, distance = sweep_fit.lines(envelope.panels(rows)[0])
  assert head.startswith('logistic fit, maximum likelihood: logit p = ')
  beyond = re.search(r'below 90 % beyond ([\d.]+) deg at distance 2 m', angle)
  assert 36 < float(beyond[1]) < 46
  assert 'success does not cross 90 % between 1 and 3 m at angle 0' in distance


def test_nothing_is_fitted_where_nothing_varies(make: object) -> None:
  rows = make.rows('noise_sigma=0,5', observers=1)
  assert sweep_fit.lines(envelope.panels(rows)[0]) == []


def test_the_fit_is_the_published_one() -> None:
  # Hours of study and exams passed; intercept -4.0777, slope 1.5046
  # (Wikipedia, 'Logistic regression', section 'Example').
  hours = [
    0.5, 0.75, 1, 1.25, 1.5, 1.75, 1.75, 2, 2.25, 2.5, 2.75, 3, 3.25, 3.5, 4,
    4.25, 4.5, 4.75, 5, 5.5,
  ]  # fmt: skip
  passed = [0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1, 1]
  fit = logistic.fit({'hours': np.array(hours)}, np.array(passed, bool))
  assert fit.intercept == pytest.approx(-4.0777, abs=1e-3)
  assert fit.slopes['hours'] == pytest.approx(1.5046, abs=1e-3)
  assert fit.crossing('hours', {}, 0.5) == pytest.approx(2.71, abs=0.01)


@pytest.mark.parametrize('count', [6, 10, 18])
def test_a_slope_of_nothing_is_told_as_nothing(count: int) -> None:
  angle = np.repeat([0.0, 30.0, 60.0], count)
  distance = np.tile([1.0, 2.0], 3 * count // 2)
  success = distance > 1.5
  for first in (0, 1):  # The nearer read once, the further failed once.
    success[first::count] = ~success[first::count]
  fit = logistic.fit({'angle': angle, 'distance': distance}, success)
  assert fit.slopes['angle'] == 0
  assert fit.slopes['distance'] > 0.1


@pytest.mark.parametrize('passed', ['0000', '1111', '0011', '0111', '0101'])
def test_separated_outcomes_have_no_fit(passed: str) -> None:
  hours = np.array([1.0, 2.0, 2.0, 3.0])
  success = np.array([int(each) for each in passed], bool)
  # One failure and one success at the same place are no overlap either.
  assert logistic.fit({'hours': hours}, success) is None


# Looks.


def test_colours_go_from_the_first_stop_to_the_last() -> None:
  assert heat.colour(0.0) == heat.STOPS[0]
  assert heat.colour(0.5) == heat.STOPS[2]
  assert heat.colour(1.0) == heat.STOPS[-1]
  # Brighter is better, for those who see no colours.
  light = [
    sum(palette.rgb(heat.colour(share))) for share in np.linspace(0, 1, 21)
  ]
  assert light == sorted(light)


@pytest.mark.parametrize(
  ('factor', 'title'),
  [
    ('distance_m', 'distance, m'),
    ('bearing_deg', 'viewing angle, degrees'),
    ('noise_sigma', 'noise sigma'),
    ('exposure_s', 'exposure, s'),
    ('control', 'control'),
    (None, ''),
  ],
)
def test_axes_have_units(factor: str | None, title: str) -> None:
  assert heat.axis(factor) == title


@pytest.mark.slow
def test_pictures_and_page_are_drawn_the_same_twice(
  rows: list[case_rows.SweepRow], tmp_path: pathlib.Path
) -> None:
  pytest.importorskip('matplotlib')
  for name in 'ab':
    sweep_output.write(tmp_path / name, rows)
  files = {path.name for path in (tmp_path / 'a').iterdir()}
  assert files == {'summary.txt', 'index.html', *case_rows.FIGURES}
  for name in files - {'index.html'}:
    one, other = ((tmp_path / each / name).read_bytes() for each in 'ab')
    assert one == other
  svg = (tmp_path / 'a' / 'envelope.svg').read_text()
  assert svg.count('5/5') == 8
  assert svg.count('3/5') == 4
  for word in ('viewing angle, degrees', 'distance, m', 'noise sigma = 5'):
    assert word in svg
  assert 'not flown' not in svg
  png = (tmp_path / 'a' / 'envelope.png').read_bytes()
  assert png.startswith(b'\x89PNG')


def test_a_picture_says_what_its_white_cells_are(
  make: object, tmp_path: pathlib.Path
) -> None:
  pytest.importorskip('matplotlib')
  rows = make.rows('distance_m=1,2', 'bearing_deg=0,30', observers=1)
  rows += make.rows('distance_m=3', 'bearing_deg=0', observers=1)
  figures.draw(envelope.panels(rows), tmp_path)
  svg = (tmp_path / 'envelope.svg').read_text()
  assert svg.count('not flown') == 1


def test_many_sweeps_of_one_factor_each_make_one_report(make: object) -> None:
  # Their product has more than 10^9 combinations.
  factors = (
    'distance_m', 'noise_sigma', 'flicker_share', 'exposure_s', 'step_gain',
    'jitter_m', 'dropped_share', 'repeated_share', 'blackout_share',
    'performer_drift_m', 'observer_drift_m',
  )  # fmt: skip
  levels = '0.01,0.012,0.014,0.016,0.018,0.02'
  grids = {name: f'{name}={levels}' for name in factors}
  grids['distance_m'] = 'distance_m=1,1.1,1.2,1.3,1.4,1.5'
  grids['step_gain'] = 'step_gain=0.5,0.6,0.7,0.8,0.9,1.1'
  rows = [
    row for grid in grids.values() for row in make.rows(grid, observers=1)
  ]
  maps = envelope.panels(rows)
  assert sum(len(panel.cells) for panel in maps) == len(rows) == 66
  assert 'right: 66/66 exposures' in sweep_tables.report(rows, None)
