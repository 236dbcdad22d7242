"""Frames that are read as a whole, on real rendered images."""

import numpy as np
import pytest

from waggle_tasks import scenario, sensor
from waggle_tasks.agents import group, receiver, receivers
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.protocol import decoys, languages, payload
from waggle_tasks.tasks import drift, surroundings

BITS = '01101000' * 2
HOVER = drift.Drift(performer_hover='mocap', observer_hover='mocap')
FRAMES = [name for name in decoys.DECOYS if not decoys.figures(name, np.random)]


def fly(**changes: object) -> tuple[verdicts.Outcome, list[receiver.Event]]:
  """What became of the one observer of an episode, and what it saw."""
  scene = scenario.Scenario(**{'observers': 1, **changes})
  flown = rollout.run(scene, 'joint')
  (outcome,) = evaluator.evaluate(scene, flown).outcomes
  events = flown.events['observer_1']
  return outcome, [e for e in events if isinstance(e, receiver.Event)]


@pytest.mark.parametrize(
  'language',
  [
    pytest.param(name, marks=[pytest.mark.long] * (name == 'gentle'))
    for name in languages.LANGUAGES
  ],
)
@pytest.mark.parametrize(
  ('distance_m', 'bearing_deg', 'noise_sigma'),
  [
    pytest.param(1.3, 0, 0, marks=pytest.mark.long),
    (3.0, 75, 10),
  ],
)
def test_a_message_is_read_and_flown(
  language: str, distance_m: float, bearing_deg: float, noise_sigma: float
) -> None:
  if language == 'rapid':  # For observers that are near.
    distance_m = min(distance_m, 2.0)
  outcome, events = fly(
    language=language, distance_m=distance_m, bearing_deg=bearing_deg,
    payload='101101', sensor=sensor.Sensor(noise_sigma=noise_sigma),
  )  # fmt: skip
  assert not outcome.failures
  assert outcome.decoded == '101101'
  (end,) = [each for each in events if each.word is not None]
  assert end.clear > 0.8
  assert end.distance_m == pytest.approx(distance_m, rel=0.1)


@pytest.mark.slow
def test_swift_is_read_within_5_s_of_its_first_stroke_and_brisk_in_12_s() -> (
  None
):
  swift, _ = fly(language='swift')
  begin_s = languages.LANGUAGES['swift'].initial_hover_s
  assert swift.final_null_s - begin_s <= 5.0
  brisk, _ = fly(language='brisk')
  assert brisk.final_null_s <= 12.0


@pytest.mark.slow
def test_another_camera_reads_the_same() -> None:
  outcome, events = fly(
    language='swift', payload='101101', camera_width_px=320,
    camera_height_px=240, rate_hz=50,
  )  # fmt: skip
  assert not outcome.failures
  (end,) = [each for each in events if each.word is not None]
  assert end.distance_m == pytest.approx(1.3, rel=0.1)


@pytest.mark.slow
def test_data_are_read_in_packets_and_nobody_moves() -> None:
  outcome, events = fly(language='swift', bits=BITS * 5)
  assert not outcome.failures
  assert outcome.decoded == BITS * 5
  assert outcome.start_s is None
  assert sum(each.word is not None for each in events) == 2


@pytest.mark.slow
def test_a_frame_that_was_hidden_is_read_in_the_next_round() -> None:
  dark = sensor.Sensor(blackout_s=2.5, blackout_length_s=3.0)
  once, _ = fly(language='swift', sensor=dark)
  assert once.decoded is None
  twice, _ = fly(language='swift', sensor=dark, repeat=2)
  assert twice.decoded == twice.expected
  assert not twice.failures


@pytest.mark.slow
@pytest.mark.parametrize(
  'spoilt',
  [
    {'sensor': sensor.Sensor(dropped_share=0.3)},
    {'sensor': sensor.Sensor(blackout_s=3.2, blackout_length_s=0.6)},
    pytest.param(
      {'drift': drift.Drift(performer_hover='mocap'), 'seed': 1},
      marks=pytest.mark.long,
    ),
    {'drift': HOVER, 'seed': 858278},
    {'dynamics': 'rotors'},
    {'surroundings': surroundings.Surroundings(0, 5.0), 'repeat': 2},
  ],
  ids=['dropped', 'a symbol hidden', 'hover', 'all hover', 'rotors', 'board'],
)
def test_swift_bears_it(spoilt: dict) -> None:
  outcome, _ = fly(language='swift', payload='011010', **spoilt)
  assert outcome.decoded == '011010'


@pytest.mark.long
def test_brisk_is_read_of_a_dancer_that_hovers() -> None:
  hover = drift.Drift(performer_hover='mocap')
  outcome, _ = fly(language='brisk', payload='011010', drift=hover, seed=1)
  assert outcome.decoded == '011010'


@pytest.mark.slow
def test_who_sees_nothing_at_first_learns_the_scene_later() -> None:
  dark = sensor.Sensor(blackout_length_s=3.0)
  outcome, _ = fly(language='swift', sensor=dark, repeat=2)
  assert outcome.decoded == outcome.expected


@pytest.mark.parametrize(
  ('language', 'name', 'seed'),
  [
    *(
      pytest.param(
        'swift', name, 5, marks=[pytest.mark.long] * bool(number % 3)
      )
      for number, name in enumerate(FRAMES)
    ),
    ('swift', 'repeated', 475138),  # START and the levels 7 and 0 are alike.
    pytest.param('brisk', 'seven_bits', 5, marks=pytest.mark.long),
    pytest.param('brisk', 'begun_anew', 5, marks=pytest.mark.long),
    ('brisk', 'start_repeated', 640181),  # A START where a bit should be.
  ],
)
def test_a_decoy_of_the_languages_own_symbols_is_no_message(
  language: str, name: str, seed: int
) -> None:
  outcome, _ = fly(language=language, control=name, seed=seed)
  assert outcome.decoded is None
  assert not outcome.failures


def test_a_start_that_does_not_begin_at_rest_opens_no_frame() -> None:
  # Every symbol is danced twice, so that a second START begins where the first
  # one ends, at the lowest level; with few images it looks like a whole one.
  outcome, _ = fly(
    language='swift', control='repeated', seed=1489973539, distance_m=2.2,
    sensor=sensor.Sensor(dropped_share=0.3),
  )  # fmt: skip
  assert outcome.decoded is None
  assert not outcome.failures


@pytest.mark.long
def test_the_papers_own_dance_is_read_as_a_whole_too() -> None:
  outcome, _ = fly(payload='101101')
  assert outcome.decoded == '101101'
  assert not outcome.failures


@pytest.mark.parametrize('name', ['klt', 'view_bank'])
def test_receivers_of_the_paper_refuse_another_language(name: str) -> None:
  agreed = scenario.Scenario(language='swift').agreement
  with pytest.raises(group.ReceiverError, match="the receiver 'joint'"):
    receivers.make(name, agreed)


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'language': 'swfit'}, '`language` must be one of .* Did you mean swift'),
    ({'bits': '01'}, '`bits` must not be given with `language`'),
    ({'repeat': 2}, '`repeat` must not be given with `language`'),
    ({'language': 'swift', 'repeat': 0}, '`repeat` must be between 1 and 100'),
    ({'language': 'swift', 'bits': '012'}, '`bits` must be .* of 0 and 1'),
    ({'language': 'swift', 'bits': '0' * 2049}, '`bits` must be .* 2048'),
    (
      {'language': 'swift', 'pauses': scenario.timing.Timing(5.0)},
      '`pauses` must not be given with `language`',
    ),
    (
      {'language': 'brisk', 'dynamics': 'rotors'},
      'gesture 0` must accelerate sideways by at most 2',
    ),
  ],
)
def test_what_a_language_does_not_take_is_refused(
  changes: dict, error: str
) -> None:
  with pytest.raises(scenario.errors.WaggleError, match=error):
    scenario.Scenario(**changes)


def test_data_are_bits() -> None:
  with pytest.raises(payload.PayloadError, match='`bits` must be'):
    payload.Data('')
