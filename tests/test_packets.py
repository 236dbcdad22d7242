"""Packets bring a message whole, in any order, and never two mixed."""

import hypothesis
from hypothesis import strategies as st
import pytest

from waggle_tasks.protocol import packets

CUTS = st.integers(1, 64).map(packets.Packets)


@hypothesis.settings(max_examples=20)
@hypothesis.given(st.data(), CUTS)
def test_packets_in_any_order_are_the_message(
  data: st.DataObject, cut: packets.Packets
) -> None:
  length = data.draw(st.integers(1, cut.most_bits))
  bits = f'{data.draw(st.integers(0, 2**length - 1)):0{length}b}'
  sent = cut.split(bits)
  assert {len(packet) for packet in sent} == {cut.packet_bits}
  collector = packets.Collector(cut)
  for packet in data.draw(st.permutations(sent)):
    assert collector.bits is None
    collector = collector.add(packet)
  assert collector.bits == bits


def test_a_packet_that_was_missed_comes_in_the_next_round() -> None:
  sent = packets.Packets(8).split('10' * 10)
  collector = packets.Collector(packets.Packets(8))
  for packet in (sent[0], sent[2], sent[0]):
    collector = collector.add(packet)
    assert collector.bits is None
  assert collector.add(sent[1]).bits == '10' * 10


@pytest.mark.parametrize('other', ['1' * 17, '1' * 30, '0' + '1' * 23])
def test_another_message_begins_anew(other: str) -> None:
  cut = packets.Packets(8)
  first, second = cut.split('10' * 12), cut.split(other)
  collector = packets.Collector(cut).add(first[0]).add(first[1])
  collector = collector.add(second[0])
  assert collector == packets.Collector(cut).add(second[0])
  for packet in second[1:]:
    collector = collector.add(packet)
  assert collector.bits == other


def test_what_no_message_has_changes_nothing() -> None:
  cut = packets.Packets(8)
  collector = packets.Collector(cut).add(cut.split('10' * 12)[0])
  beyond = '00011' + '00010' + '111' + '0' * 8 + '0' * 8
  unclean = '00010' + '00010' + '000' + '0' * 8 + '00000001'
  assert collector.add(beyond) == collector
  assert collector.add(unclean) == collector


def test_messages_of_one_length_are_not_mixed() -> None:
  cut = packets.Packets(8)
  first, second = cut.split('01' * 8), cut.split('10' * 8)
  mixed = packets.Collector(cut).add(first[0]).add(second[1])
  assert mixed.bits is None
  assert mixed.add(second[0]).bits == '10' * 8


def test_at_least_32_packets_and_the_longest_is_told() -> None:
  cut = packets.Packets()
  assert len(cut.split('1' * cut.most_bits)) >= 32
  rule = f'`bits` must be 1 to {cut.most_bits} .* got {cut.most_bits + 1}'
  with pytest.raises(packets.PacketError, match=rule):
    cut.split('1' * (cut.most_bits + 1))


@hypothesis.given(st.text(min_size=1))
def test_a_text_comes_back(text: str) -> None:
  assert packets.bits_text(packets.text_bits(text)) == text


def test_bits_that_are_no_text_are_none() -> None:
  assert packets.bits_text('1' * 8) is None
  assert packets.bits_text('0' * 7) is None


@pytest.mark.parametrize(
  ('call', 'error'),
  [
    (lambda: packets.Packets(0), '`chunk_bits` .* 1 and 64: got 0'),
    (lambda: packets.Packets(65), '`chunk_bits` .* 1 and 64: got 65'),
    (lambda: packets.Packets().split(''), '`bits` .* got 0 of them'),
    (lambda: packets.Packets().split('012'), "`bits` .* got '012'"),
    (lambda: packets.Collector().add('01'), '`packet` must be 88 .* got 2'),
    (lambda: packets.text_bits(''), '`text` must be at least one'),
    (lambda: packets.text_bits('\ud800'), '`text` must be .* UTF-8'),
    (lambda: packets.text_bits(b'a'), '`text` must be'),
    (lambda: packets.bits_text('x'), "`bits` .* got 'x'"),
  ],
)
def test_what_is_no_message_is_refused(call: object, error: str) -> None:
  with pytest.raises(packets.PacketError, match=error):
    call()
