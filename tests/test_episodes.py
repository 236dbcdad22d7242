"""Whole episodes on real images: payloads, numbers, layouts and controls.

The default run flies a short dance where it can; `-m slow` flies the paper's
own for every payload, number, layout and case of its tables.
"""

import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import verdicts

PAYLOADS = ('000010', '000110', '001010', '100010')
Played = tuple[scenario.Scenario, rollout_lib.Rollout, verdicts.Verdict]


def play(name: str, **changes: object) -> Played:
  scene = registry.find(name, **changes)
  rollout = rollout_lib.run(scene, 'klt')
  return scene, rollout, evaluator.evaluate(scene, rollout)


def moved_m(rollout: rollout_lib.Rollout, observer: str) -> np.ndarray:
  """How far an observer was from its first place at most."""
  positions_m = rollout.positions_m[observer]
  return np.linalg.norm(positions_m - positions_m[0], axis=1).max()


def check_all_flew(played: Played) -> None:
  scene, rollout, verdict = played
  assert [each.failures for each in verdict.outcomes] == [()] * scene.observers
  assert verdict.correct == scene.observers
  offset_m = scene.message.displacement_m(scene.units)
  for each in verdict.outcomes:
    positions_m = rollout.positions_m[each.observer]
    np.testing.assert_allclose(
      positions_m[-1] - positions_m[0], offset_m, atol=0.015
    )


@pytest.mark.parametrize(
  ('payload', 'observers', 'layout'),
  [
    ('000110', 1, 'arc'),
    pytest.param('001010', 2, 'line', marks=pytest.mark.long),
    pytest.param('100010', 2, 'arc', marks=pytest.mark.long),
    pytest.param('000010', 5, 'arc', marks=pytest.mark.long),
  ],
)
def test_a_short_dance_is_read_and_flown(
  payload: str, observers: int, layout: str, short: dict[str, object]
) -> None:
  check_all_flew(
    play(
      'broadcast',
      payload=payload,
      observers=observers,
      layout=layout,
      **short,
    )
  )


@pytest.mark.long
@pytest.mark.parametrize('layout', ['arc', 'line'])
@pytest.mark.parametrize('payload', PAYLOADS)
@pytest.mark.parametrize('observers', [1, 2, 3, 4, 5])
def test_the_papers_payloads_for_any_number_in_either_layout(
  observers: int, payload: str, layout: str
) -> None:
  check_all_flew(
    play('broadcast', observers=observers, payload=payload, layout=layout)
  )


@pytest.mark.long
@pytest.mark.parametrize(
  ('changes', 'correct'),
  [
    ({'observers': 4, 'half_span_deg': 35}, 4),
    ({'distance_m': 1.6}, 3),
    ({'half_span_deg': 15}, 3),
    ({'jitter_m': 0.01, 'seed': 0}, 3),
    ({'jitter_m': 0.01, 'seed': 1}, 3),
    ({'layout': 'line', 'jitter_m': 0.01, 'seed': 1, 'payload': '000110'}, 3),
  ],
)
def test_the_papers_other_nominal_cases_that_passed(
  changes: dict[str, object], correct: int
) -> None:
  played = play('broadcast', **changes)
  check_all_flew(played)
  assert played[2].correct == correct


@pytest.mark.long
@pytest.mark.parametrize(
  ('changes', 'right'),
  [
    ({'observers': 5, 'half_span_deg': 40}, [2, 3, 4]),
    ({'observers': 5, 'half_span_deg': 40, 'payload': '100010'}, [2, 3, 4]),
    ({'distance_m': 1.0}, []),
    ({'half_span_deg': 45}, [2]),
  ],
)
def test_who_cannot_read_in_the_paper_cannot_here_and_stays(
  changes: dict[str, object], right: list[int]
) -> None:
  _, rollout, verdict = play('broadcast', **changes)
  assert not verdict.passed
  for number, each in enumerate(verdict.outcomes, 1):
    assert each.correct == (number in right)
    if number not in right:
      assert each.decoded is None
      assert moved_m(rollout, each.observer) < 1e-3


def test_nothing_sent_is_one_null_and_nobody_moves() -> None:
  _, rollout, verdict = play('no_send')
  assert verdict.passed
  assert rollout.times_s[-1] == pytest.approx(10.0)
  for name, events in rollout.events.items():
    assert [each.symbol for each in events] == ['NULL']  # It is allowed.
    assert moved_m(rollout, name) < 1e-3
  assert moved_m(rollout, 'performer') < 1e-3


@pytest.mark.slow
def test_who_sees_black_waits_and_the_others_fly(
  short: dict[str, object],
) -> None:
  _, rollout, verdict = play(
    'black_input', observers=2, black_observer=1, **short
  )
  assert verdict.passed
  decoded = [each.decoded for each in verdict.outcomes]
  assert decoded == [None, '000010']
  assert rollout.events['observer_1'] == ()
  assert moved_m(rollout, 'observer_1') < 1e-3
  assert moved_m(rollout, 'observer_2') == pytest.approx(0.4, abs=0.015)


def check_nobody_moved(played: Played, duration_s: float) -> None:
  _, rollout, verdict = played
  assert verdict.passed
  assert rollout.times_s[-1] == pytest.approx(duration_s)
  for each in verdict.outcomes:
    assert each.decoded is each.start_s is None
    assert moved_m(rollout, each.observer) < 1e-3


@pytest.mark.slow
def test_a_dance_that_stops_at_26_s_moves_nobody_until_60_s() -> None:
  played = play('interrupted', observers=1)
  check_nobody_moved(played, 60.0)
  for events in played[1].events.values():
    # START and the first bit had been flown, the second had not.
    assert [str(each.symbol) for each in events[:5]] == [
      'NULL', 'START', 'NULL', '0', 'NULL',
    ]  # fmt: skip


@pytest.mark.slow
def test_a_dance_that_stops_within_its_end_moves_nobody(
  short: dict[str, object],
) -> None:
  """END begins at 48 s; its first half is not enough."""
  changes = {'stop_s': 49.0, 'duration_s': 56.0, 'observers': 1, **short}
  played = play('interrupted', **changes)
  check_nobody_moved(played, 56.0)
  (events,) = played[1].events.values()
  assert len(events) >= 15  # Everything before END was read.
  assert all(each.message is None for each in events)
