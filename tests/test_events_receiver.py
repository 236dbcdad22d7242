"""The receiver that sees events alone, on real rendered images."""

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import group, receiver, receivers
from waggle_tasks.experiments.episodes import evaluator, rollout, tape
from waggle_tasks.experiments.record import verdicts


def fly(**changes: object) -> tuple[verdicts.Outcome, list[receiver.Event]]:
  """What became of the one observer of an episode, and what it saw."""
  scene = scenario.Scenario(**{'observers': 1, **changes})
  flown = rollout.run(scene, 'events')
  (outcome,) = evaluator.evaluate(scene, flown).outcomes
  events = flown.events['observer_1']
  return outcome, [e for e in events if isinstance(e, receiver.Event)]


def test_a_message_is_read_and_flown() -> None:
  outcome, _ = fly(
    language='swift', payload='011010', distance_m=2.0, bearing_deg=60
  )
  assert not outcome.failures
  assert outcome.decoded == '011010'


@pytest.mark.long
def test_the_papers_dance_is_read_one_gesture_after_another() -> None:
  outcome, events = fly(payload='101101')
  assert not outcome.failures
  assert outcome.decoded == '101101'
  said = [e.symbol for e in events if e.symbol != 'NULL']
  assert ' '.join(said) == 'START 1 0 1 1 0 1 END'


def test_a_decoy_is_no_message_and_nobody_moves() -> None:
  outcome, _ = fly(language='swift', control='seven_bits', seed=3)
  assert outcome.decoded is None
  assert not outcome.failures


@pytest.mark.slow
def test_the_same_images_give_the_same_events() -> None:
  scene = scenario.Scenario(language='swift', observers=1)
  (seen,) = tape.record(scene, lambda done_s: None)
  runs = []
  for _ in range(2):
    reader = receivers.make('events', scene.agreement)
    runs.append(
      [e for image, at in seen.play() for e in reader.step(image, at)]
    )
  assert runs[0] == runs[1]
  assert any(event.message for event in runs[0])


def test_a_dancer_that_never_moved_is_not_to_be_seen() -> None:
  """Where it hovers is not known, whatever the picture shows."""
  reader = receivers.make('events')
  rng = np.random.default_rng(0)
  image = rng.integers(0, 256, (480, 640, 3)).astype(np.uint8)
  for number in range(50):
    reader.step(image, 0.04 * number)
  assert reader.track.support == 0


def test_images_of_another_kind_are_refused() -> None:
  reader = receivers.make('events')
  with pytest.raises(group.ReceiverError, match='`image` must be uint8'):
    reader.step(np.zeros((480, 640, 3)), 0.0)


@pytest.mark.parametrize('language', ['paper', 'swift'])
def test_it_tells_what_it_asks_for(language: str) -> None:
  agreed = scenario.Scenario(language=language).agreement
  told = receivers.describe('events:contrast=0.3', agreed)
  assert (told.null is None) == bool(told.frames) == (language == 'swift')
