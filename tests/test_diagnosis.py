"""Why a message was not read, by the events of whoever did not read it."""

from collections.abc import Sequence

import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import receiver
from waggle_tasks.experiments.episodes import diagnosis
from waggle_tasks.experiments.record import moves
from waggle_tasks.protocol import frame
from waggle_tasks.protocol.symbols import Symbol

ONCE = scenario.Scenario(language='swift')
THRICE = scenario.Scenario(language='swift', repeat=3)
PACKETS = scenario.Scenario(language='swift', bits='01101' * 14)
START_S, END_S = 2.9, 6.6  # After START, and after the frame, of one message.
UNCLEAR = 'two words are as likely: clear 0.31 < 0.4'


def start(time_s: float) -> receiver.Event:
  return receiver.Event(time_s, Symbol.START, frame.State.BIT)


def refused(time_s: float, why: str = UNCLEAR) -> receiver.Event:
  return receiver.Event(
    time_s, Symbol.UNKNOWN, frame.State.LEAD_NULL, rejection=why
  )


def whole(time_s: float) -> receiver.Event:
  return receiver.Event(
    time_s, Symbol.END, frame.State.FINAL_NULL, word=(0, 2, 7, 6), clear=1.0
  )


@pytest.mark.parametrize(
  ('scene', 'events', 'why'),
  [
    (ONCE, [], 'START, flown at 1.65 s, was never seen'),
    (ONCE, [start(9.0)], 'START, flown at 1.65 s, was never seen'),
    (ONCE, [start(START_S)], 'START was seen, and of the rest nothing was made'
     ' by 6.34 s'),
    (ONCE, [start(START_S), start(4.0), refused(END_S), refused(9.0, 'x')],
     f'the frame was refused at 6.60 s: {UNCLEAR}'),
    (ONCE, [start(START_S), whole(END_S)],
     'all of it was read, and its parts make no message'),
    (THRICE, [start(START_S), refused(END_S)],
     f'the frame was refused at 6.60 s: {UNCLEAR}, and in none of 3 rounds'),
  ],
)  # fmt: skip
def test_a_frame_that_was_not_read_is_told_by_what_was_seen_of_it(
  scene: scenario.Scenario, events: Sequence[receiver.Event], why: str
) -> None:
  assert diagnosis.diagnose(scene, events) == why


def test_the_packet_that_is_missing_is_named() -> None:
  sent = moves.sent(PACKETS.performance, PACKETS.agreement, PACKETS.episode_s)
  ends_s = [each.end_s for each in sent if each.symbol is Symbol.END]
  first = whole(ends_s[0] + 0.2)
  said = diagnosis.diagnose(PACKETS, [first])
  assert said.startswith('packet 2 of 2: START, flown at ')
  again = diagnosis.diagnose(PACKETS, [whole(ends_s[1] + 0.2)])
  assert again.startswith('packet 1 of 2: START, flown at 1.65 s')


def test_a_receiver_without_scores_is_told_by_its_own_reasons() -> None:
  paper = scenario.Scenario()
  said = diagnosis.diagnose(paper, [start(4.0), refused(90.0)])
  assert said == f'the frame was refused at 90.00 s: {UNCLEAR}'
