"""What people are told of frames: symbols in their times, packets, rounds."""

from collections.abc import Sequence

import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import receiver
from waggle_tasks.experiments.record import frames, moves, reader, story
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import frame, payload
from waggle_tasks.protocol.symbols import Symbol

DATA = '0110100001101001' * 5  # In two packets.


def flown(scene: scenario.Scenario) -> Sequence[moves.Sent]:
  return moves.sent(scene.performance, scene.agreement, scene.episode_s)


def read(
  scene: scenario.Scenario, *packets: int
) -> tuple[agreement_lib.Agreement, list[receiver.Event]]:
  """The events of whoever reads some of the packets of a broadcast, in turn."""
  agreed, events = scene.agreement, []
  cut = agreed.packets
  words = [agreed.word(b) for b in cut.split(scene.bits)] if cut else [
    agreed.word(scene.payload)
  ]  # fmt: skip
  ends = [each for each in flown(scene) if each.symbol is Symbol.END]
  for number in packets:
    end_s = ends[number].end_s + agreed.spoken.confirm_s
    events += [
      receiver.Event(end_s - 3, Symbol.START, frame.State.BIT),
      receiver.Event(
        end_s, Symbol.END, frame.State.FINAL_NULL, view_angle_deg=10.0,
        distance_m=1.3, word=words[number % len(words)], clear=0.9,
      ),
      receiver.Event(end_s, Symbol.NULL, frame.State.START),
    ]  # fmt: skip
  return agreed, events


def test_levels_are_told_by_their_numbers() -> None:
  sent = flown(scenario.Scenario(language='swift'))
  labels = [each.mark.label for each in sent]
  assert labels == ['START', '0', '2', '7', '6', 'END']
  assert [each.words for each in sent[1:3]] == ['level 0', 'level 2']
  brisk = flown(scenario.Scenario(language='brisk'))
  assert [each.words for each in brisk] == ['START', *'000010', 'END']


def test_packets_and_rounds_are_told_where_there_are_several() -> None:
  once = scenario.Scenario(language='swift', repeat=2)
  assert {each.part for each in flown(once)} == {'round 1 of 2', 'round 2 of 2'}
  data = scenario.Scenario(language='swift', bits=DATA, repeat=3)
  parts = [e.part for e in flown(data) if e.symbol is Symbol.START]
  assert parts == [
    f'packet {packet} of 2, round {turn} of 3'
    for turn in (1, 2, 3)
    for packet in (1, 2)
  ]
  silent = scenario.Scenario(language='swift', control='five_bits')
  assert {each.part for each in flown(silent)} == {''}


@pytest.mark.parametrize('language', ['swift', 'brisk'])
def test_what_was_read_stands_where_it_was_flown(language: str) -> None:
  scene = scenario.Scenario(language=language, payload='101101')
  agreed, events = read(scene, 0)
  (found,) = frames.read(events, agreed)
  sent = flown(scene)
  assert [each.mark for each in found.slots] == [each.mark for each in sent]
  for mine, theirs in zip(found.slots, sent, strict=True):
    assert mine.begin_s == pytest.approx(theirs.begin_s)
    assert mine.end_s == pytest.approx(theirs.end_s)
  assert found.words == (
    f'{found.word}, payload 101101, clear 0.90, from 10 degrees, 1.30 m away'
  )


def test_a_frame_that_was_refused_says_why() -> None:
  refusal = receiver.Event(
    9.0, Symbol.UNKNOWN, frame.State.LEAD_NULL, rejection='crc4 does not hold'
  )
  agreed = scenario.Scenario(language='swift').agreement
  (found,) = frames.read([refusal], agreed)
  assert (found.slots, found.words) == ((), 'crc4 does not hold')
  reading = story.Reading(agreed).after(refusal)
  assert reading.status == 'next: START'


def test_a_reading_tells_which_packets_it_has() -> None:
  scene = scenario.Scenario(language='swift', bits=DATA, repeat=3)
  agreed, events = read(scene, 1, 2)
  told = [reading for _, reading in story.readings(events, agreed)]
  assert story.Reading(agreed).status == 'next: START'
  assert told[0].status == 'next: END'
  assert told[2].status == 'has packet 2 of 2, next: START'
  # It stays to be seen until the next frame begins.
  assert told[2].symbols[0].label == 'START'
  assert len(told[2].symbols) == 2 + len(events[1].word)
  assert len(told[3].symbols) == 1
  assert told[5].parts == 'has all packets'
  says = [each.says for each in frames.read(events, agreed)]
  assert says == ['packet 2 of 2', 'packet 1 of 2']


def test_a_text_report_tells_each_frame() -> None:
  scene = scenario.Scenario(language='swift')
  agreed, events = read(scene, 0)
  whole = payload.Payload.from_bits(scene.payload)
  work = reader.Reader('joint', agreed)
  work.events = [
    *events[:2],
    receiver.Event(
      events[2].time_s, Symbol.NULL, frame.State.START, message=whole
    ),
  ]
  said = reader.report([work])
  assert 'END NULL' in said
  assert 's: 0 2 7 6, payload 000010, clear 0.90, from 10 degrees' in said


def test_few_frames_are_told_one_by_one_and_many_together() -> None:
  scene = scenario.Scenario(language='swift', bits=DATA, repeat=3)
  agreed, events = read(scene, 0, 1)
  first, second = frames.lines(events, agreed)
  assert ', packet 1 of 2, clear 0.90, ' in first
  assert ', packet 2 of 2, clear 0.90, ' in second
  agreed, events = read(scene, 0, 1, 2, 3)
  (line,) = frames.lines(events, agreed)
  assert line.startswith('4 frames to ')
  assert line.endswith(' s, clear 0.90 and more')
  assert frames.lines([], agreed) == []
