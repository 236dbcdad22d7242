"""Suites as data: the paper's own, and a user's."""

from collections.abc import Mapping, Sequence
import json
import re

import pytest

from waggle_tasks import errors, suites
from waggle_tasks.protocol import gestures, payload, timing

FAST = {
  'codebook': {
    'half_width_m': 0.12,
    'start_height_m': 0.25,
    'duration_s': 2.0,
  },
  'pauses': {'initial_hover_s': 3.2, 'settle_s': 0.6, 'lead_in_s': 1.4},
}


def case(suite: str, name: str) -> suites.Case:
  (found,) = [each for each in suites.find(suite) if each.name == name]
  return found


# The paper's suites, of its Tables 2 and 3.


@pytest.mark.parametrize(
  ('name', 'broadcasts', 'exposures', 'correct', 'passed'),
  [
    ('standard', 17, 53, 44, 13),
    ('supplemental', 3, 14, 14, 3),
  ],
)
def test_totals_are_the_published_ones(
  name: str, broadcasts: int, exposures: int, correct: int, passed: int
) -> None:
  cases = suites.find(name)
  assert len(cases) == broadcasts
  assert sum(each.scene.observers for each in cases) == exposures
  assert sum(each.published.correct for each in cases) == correct
  assert sum(each.published.passed for each in cases) == passed


def test_the_paper_suite_is_the_three_groups_one_after_the_other() -> None:
  groups = ('standard', 'supplemental', 'controls')
  expected = [each for name in groups for each in suites.find(name)]
  assert list(suites.find('paper')) == expected
  assert len(suites.find('controls')) == 3
  assert len({each.name for each in expected}) == len(expected) == 23
  for name in groups:
    assert {each.group for each in suites.find(name)} == {name}


# N, configuration, correct and group verdict of the paper's Table 2, by row.
TABLE_2 = {
  'default': (3, {}, 3, True),
  'heading-45': (3, {'payload': '000110'}, 3, True),
  'heading-90': (3, {'payload': '001010'}, 3, True),
  'backward': (3, {'payload': '100010'}, 3, True),
  'one-observer': (1, {}, 1, True),
  'two-observers': (2, {}, 2, True),
  'span-35': (4, {'half_span_deg': 35}, 4, True),
  'span-40': (5, {'half_span_deg': 40}, 3, False),
  'line': (3, {'layout': 'line'}, 3, True),
  'distance-1-0': (3, {'distance_m': 1.0}, 0, False),
  'distance-1-6': (3, {'distance_m': 1.6}, 3, True),
  'span-15': (3, {'half_span_deg': 15}, 3, True),
  'span-45': (3, {'half_span_deg': 45}, 1, False),
  'jitter-0': (3, {'jitter_m': 0.01}, 3, True),
  'jitter-1': (3, {'jitter_m': 0.01, 'seed': 1}, 3, True),
  'line-jitter': (
    3,
    {'layout': 'line', 'jitter_m': 0.01, 'seed': 1, 'payload': '000110'},
    3,
    True,
  ),
  'span-40-backward': (
    5, {'half_span_deg': 40, 'payload': '100010'}, 3, False,
  ),
  'four-forward': (4, {}, 4, True),
  'five-forward': (5, {}, 5, True),
  'five-backward': (5, {'payload': '100010'}, 5, True),
}  # fmt: skip
DEFAULTS = {
  'control': 'none', 'layout': 'arc', 'distance_m': 1.3, 'half_span_deg': 30,
  'payload': '000010', 'jitter_m': 0.0, 'seed': 0,
}  # fmt: skip


def test_every_row_of_the_papers_table_is_there_once_in_its_order() -> None:
  rows = [*suites.find('standard'), *suites.find('supplemental')]
  assert [each.name for each in rows] == [*TABLE_2]


@pytest.mark.parametrize('name', TABLE_2)
def test_a_row_is_the_papers(name: str) -> None:
  observers, changes, correct, passed = TABLE_2[name]
  found = case('paper', name)
  assert found.published == suites.Published(correct, passed)
  assert found.scene.observers == observers
  for field, value in (DEFAULTS | changes).items():
    assert getattr(found.scene, field) == value, field


@pytest.mark.parametrize(
  ('name', 'control', 'episode_s', 'correct'),
  [
    ('no-send', 'no_send', 10.0, 0),
    ('black-input', 'black_input', None, 2),
    ('interrupted', 'interrupted', 60.0, 0),
  ],
)
def test_a_control_is_the_papers(
  name: str, control: str, episode_s: float | None, correct: int
) -> None:
  found = case('controls', name)
  assert found.scene.control == control
  assert found.scene.observers == 3
  assert found.published == suites.Published(correct, True)
  if episode_s is not None:
    assert found.scene.episode_s == episode_s
  if control == 'black_input':
    assert found.scene.black_observer == 2
  if control == 'interrupted':
    assert found.scene.stop_s == 26.0


@pytest.mark.parametrize('name', suites.SUITES)
def test_tables_can_name_every_case(name: str) -> None:
  for each in suites.find(name):
    assert each.label
    assert re.fullmatch('[a-z0-9-]+', each.name)


@pytest.mark.parametrize(
  ('name', 'hint'),
  [
    ('standart', 'Did you mean standard?'),
    ('control', 'Did you mean controls?'),
    ('', ''),
    ('everything', ''),
  ],
)
def test_an_unknown_suite_is_refused_with_the_close_ones(
  name: str, hint: str
) -> None:
  known = "['standard', 'supplemental', 'controls', 'paper']"
  with pytest.raises(suites.SuiteError) as caught:
    suites.find(name)
  text = f'`suite` must be one of {known}: got {name!r}. {hint}'
  assert str(caught.value) == text.rstrip()


# A user's own.


def test_a_case_of_ones_own_is_the_default_with_its_changes() -> None:
  (found,) = suites.from_rows([{'name': 'near', 'distance_m': 1.1}])
  assert found.name == 'near'
  assert found.group == 'own'
  assert found.label == 'distance_m = 1.1'
  assert found.published is None
  assert found.scene.distance_m == 1.1
  assert found.scene.observers == 3
  assert found.scene.control == 'none'


def test_a_case_names_its_task_its_group_and_its_label() -> None:
  silent, plain = suites.from_rows(
    [
      {
        'name': 'silent', 'task': 'no_send', 'group': 'quiet',
        'label': 'Nothing is sent', 'duration_s': 1,
      },
      {'name': 'plain'},
    ]
  )  # fmt: skip
  assert silent.scene.control == 'no_send'
  assert silent.scene.episode_s == 1
  assert (silent.group, silent.label) == ('quiet', 'Nothing is sent')
  assert plain.label == 'broadcast'


def test_parts_are_given_as_tables_of_their_numbers() -> None:
  (found,) = suites.from_rows(
    [
      {
        'name': 'fast', **FAST,
        'units': {'distance_unit_m': 0.1},
        'appearance': {'floor': 'plain', 'shadows': True},
      }
    ]
  )  # fmt: skip
  scene = found.scene
  assert scene.codebook == gestures.v_codebook(0.12, 0.25, 2.0)
  assert scene.pauses == timing.Timing(3.2, 0.6, 2.0, 1.4)
  assert scene.units == payload.Units(distance_unit_m=0.1)
  assert (scene.appearance.floor, scene.appearance.shadows) == ('plain', True)


def test_what_json_can_write_can_be_a_suite() -> None:
  rows = [{'name': 'a', **FAST}, {'name': 'b_2', 'seed': 3}]
  assert suites.from_rows(json.loads(json.dumps(rows))) == suites.from_rows(
    rows
  )


@pytest.mark.parametrize(
  ('row', 'error'),
  [
    ({'distance': 1.0}, "`distance` must be one of the fields .*'distance_m'.*"
     r'\. Did you mean distance_m'),
    ({'published': {'correct': 1, 'passed': True}},
     '`published` must be one of the fields'),
    ({'distance_m': -1.0}, '`distance_m` must be between 0.2 and 4: got -1.0'),
    ({'distance_m': '1'}, "`distance_m` must be a finite number: got '1'"),
    ({'distance_m': float('nan')}, '`distance_m` must be a finite number: got'),
    ({'jitter_m': float('inf')}, '`jitter_m` must be a finite number: got inf'),
    ({'observers': 0}, '`observers` must be between 1 and 64: got 0'),
    ({'observers': True}, '`observers` must be an integer: got True'),
    ({'observers': [1]}, r'`observers` must be an integer: got \[1\]'),
    ({'observers': 64, 'distance_m': 0.2}, 'must start at least .* m apart'),
    ({'payload': '00001'}, "`payload` must be 6 .* got '00001'"),
    ({'payload': 10}, '`payload` must be text: got 10'),
    ({'duration_s': 0}, '`duration_s` must be between 0.04 and 600: got 0'),
    ({'layout': 'ring'}, r"`layout` must be one of \['arc', 'line'\]: got"),
    ({'layout': {'radius_m': 1.0}}, '`layout` must be .*: got'),
    ({'layout': ['arc']}, '`layout` must be .*: got'),
    ({'task': 'nosend'}, '`task` must be .*Did you mean no_send'),
    ({'control': 'none '}, "`control` must be one of .*: got 'none '"),
    ({'pauses': 3}, '`pauses` must be a table of Timing: got 3'),
    ({'pauses': None}, '`pauses` must be a table of Timing: got None'),
    ({'pauses': {'gap': 2}}, r'`pauses\.gap` .*one of .* Did you mean gap_s'),
    ({'pauses': {'gap_s': -1}}, r'`pauses\.gap_s` must be between 0 and 60'),
    ({'pauses': {'gap_s': '2'}}, r'`pauses\.gap_s` must be a finite number'),
    ({'codebook': 'v'}, "`codebook` must be a table of Codebook: got 'v'"),
    ({'codebook': {'width_m': 1}}, 'width_m` must be one of .*half_width_m'),
    ({'codebook': {'duration_s': 0}}, 'duration_s` must be'),
    ({'codebook': {'half_width_m': 99.0}}, 'must be between .*: got -?99'),
    ({'codebook': {'half_width_m': '1'}}, "must be a finite number: got '1'"),
    ({'units': {'distance_unit_m': []}}, r'must be a finite number: got \[\]'),
    ({'appearance': {'floor': 'lava'}}, r'`appearance\.floor` must be .*lava'),
    ({'appearance': {'brightness': 9}}, r'`appearance\.brightness` .*got 9'),
    ({'appearance': {'brightness': '1'}}, r'`appearance\.brightness` .*got .1'),
    ({'label': 3}, '`label` .*must be .*: got 3'),
    ({'group': 3}, '`group` .*must be .*: got 3'),
    ({'group': ['a']}, r"`group` .*must be .*: got \['a'\]"),
  ],
)  # fmt: skip
def test_what_cannot_be_flown_is_refused_naming_the_case_and_the_rule(
  row: dict[str, object], error: str
) -> None:
  rows = [{'name': 'fine'}, {'name': 'odd', **row}]
  with pytest.raises(errors.WaggleError, match=error) as caught:
    suites.from_rows(rows)
  assert 'case 2 (odd)' in str(caught.value)


@pytest.mark.parametrize(
  'row', ['name', ['name'], 5, None, {}, {'distance_m': 1.0}]
)
def test_a_case_that_is_no_table_with_a_name_is_refused(row: object) -> None:
  text = f'case 1 must be a table with a `name`: got {row!r}'
  with pytest.raises(suites.SuiteError, match=re.escape(text)):
    suites.from_rows([row])


@pytest.mark.parametrize(
  'name', ['', 'Near', 'a b', '../up', '.', '-a', 'a\n', 'x' * 65, 3, None, []]
)
def test_a_name_that_could_not_be_a_folder_everywhere_is_refused(
  name: object,
) -> None:
  with pytest.raises(suites.SuiteError, match='`name` of a case must be'):
    suites.from_rows([{'name': name}])


@pytest.mark.parametrize('name', ['a', '1-0', 'x' * 64, 'span_40-b'])
def test_a_plain_name_is_taken(name: str) -> None:
  (found,) = suites.from_rows([{'name': name}])
  assert found.name == name


@pytest.mark.parametrize(
  ('rows', 'names'),
  [([], r'\[\]'), ([{'name': 'a'}, {'name': 'a', 'seed': 1}], "'a', 'a'")],
)
def test_a_suite_has_cases_and_each_a_name_of_its_own(
  rows: Sequence[Mapping[str, object]], names: str
) -> None:
  with pytest.raises(suites.SuiteError, match=names):
    suites.from_rows(rows)


def test_rows_are_left_as_they_were() -> None:
  row = {'name': 'fast', **FAST}
  suites.from_rows([row])
  assert row == {'name': 'fast', **FAST}
