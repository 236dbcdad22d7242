"""Dances of which a part is hidden, shown again: nothing wrong is ever read."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.episodes import tape
from waggle_tasks.experiments.studies import spoilers

Stream = tape.Stream
# With so many motions hidden, a frame is left.
HIDDEN = {'seven_bits': 1, 'begun_anew': 1, 'run_together': 2}
Flown = Callable[[str], tuple[scenario.Scenario, tape.Tape]]


@pytest.fixture(scope='module')
def flown(short: dict[str, object]) -> Flown:
  """What one observer sees of a control in the fast language; flown once."""
  made = {}

  def fly(control: str) -> tuple[scenario.Scenario, tape.Tape]:
    if control not in made:
      scene = scenario.Scenario(control=control, observers=1, seed=3, **short)
      made[control] = scene, tape.record(scene, lambda frames: None)[0]
    return made[control]

  return fly


def read(stream: Stream, name: str, scene: scenario.Scenario) -> list[str]:
  """The messages that a receiver reads."""
  reader = receivers.make(name, scene.agreement)
  return [
    event.message.bits
    for image, time_s in stream
    for event in reader.step(image, time_s)
    if event.message
  ]


def hidden(
  scene: scenario.Scenario, first: int, count: int, kind: str
) -> spoilers.Loss:
  """A loss over some motions, from one rest into another."""
  slots = scene.performance.schedule.slots
  begin_s = slots[first].begin_s - 0.3
  end_s = slots[first + count - 1].end_s + 0.3
  return spoilers.Loss(kind, begin_s, end_s - begin_s)


@pytest.mark.parametrize(
  'every', [5, pytest.param(2, marks=pytest.mark.long)], ids=['few', 'many']
)
@pytest.mark.parametrize(
  ('control', 'name'),
  [
    pytest.param(
      control,
      name,
      marks=[pytest.mark.long] * (second or control != 'seven_bits'),
    )
    for control in HIDDEN
    for second, name in enumerate(['view_bank', 'klt'])
  ],
)
def test_with_a_part_hidden_no_message_is_read(
  control: str, name: str, every: int, flown: Flown
) -> None:
  scene, seen = flown(control)
  count = HIDDEN[control]
  kinds = [*spoilers.LOSSES]
  motions = len(scene.performance.schedule.slots)
  for first in range(1 + every % 2, motions - count, every):
    # Each kind in its turn: all of them everywhere are many minutes.
    loss = hidden(scene, first, count, kinds[first % len(kinds)])
    assert read(loss(seen.play()), name, scene) == [], loss


@pytest.mark.slow
def test_by_order_alone_a_message_is_read_that_was_not_danced(
  flown: Flown,
) -> None:
  scene, seen = flown('seven_bits')
  loss = hidden(scene, 3, 1, 'frozen')
  assert read(loss(seen.play()), 'klt:clock=off', scene) != []
  assert read(loss(seen.play()), 'klt', scene) == []


@pytest.mark.slow
@pytest.mark.parametrize(
  ('name', 'gap_s'),
  [
    pytest.param('klt', 60.0, marks=pytest.mark.long),
    ('view_bank', 7.0),
    ('view_bank', 60.0),
  ],
)
def test_halves_of_two_dances_are_no_message(
  name: str, gap_s: float, flown: Flown
) -> None:
  scene, seen = flown('none')
  middle_s = scene.performance.schedule.slots[4].begin_s - 1.0

  def halves() -> Iterator[tuple[np.ndarray, float]]:
    for image, time_s in seen.play():
      yield image, time_s + (gap_s if time_s > middle_s else 0.0)

  assert read(halves(), name, scene) == []


@pytest.mark.slow
@pytest.mark.parametrize('kind', spoilers.LOSSES)
def test_a_loss_that_can_hide_no_gesture_costs_nothing(
  kind: str, flown: Flown
) -> None:
  """In a rest; `view_bank` goes on where it was."""
  scene, seen = flown('none')
  begin_s = scene.performance.schedule.slots[3].end_s + 1.2
  loss = spoilers.Loss(kind, begin_s, 0.8 * scene.agreement.clock.blind_s)
  assert read(loss(seen.play()), 'view_bank', scene) == [scene.payload]


@pytest.mark.slow
@pytest.mark.parametrize('kind', spoilers.LOSSES)
@pytest.mark.parametrize('name', ['klt', 'view_bank'])
def test_a_loss_that_can_hide_one_breaks_the_frame_and_says_so(
  kind: str, name: str, flown: Flown
) -> None:
  scene, seen = flown('none')
  loss = hidden(scene, 4, 1, kind)
  reader = receivers.make(name, scene.agreement)
  reasons = ''
  for image, time_s in loss(seen.play()):
    for event in reader.step(image, time_s):
      assert event.message is None
      reasons += event.rejection or ''
    if time_s > loss.begin_s + loss.length_s + 8.0:
      break  # What is left is no frame.
  assert 'must come' in reasons or 'nothing was seen' in reasons, reasons
