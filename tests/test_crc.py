"""A check holds behind its own bits, and notices what it promises."""

from collections.abc import Iterator
import itertools

import hypothesis
from hypothesis import strategies as st
import pytest

from waggle_tasks.protocol import crc

CHECKS = crc.NAMES[1:]
BITS = st.text('01', min_size=1, max_size=119)
# What catalogues of checks compare: the nine digits as bytes.
DIGITS = ''.join(f'{byte:08b}' for byte in b'123456789')


def flipped(bits: str, places: tuple[int, ...]) -> str:
  return ''.join(
    str(int(bit) ^ (place in places)) for place, bit in enumerate(bits)
  )


def errors_of(weight: int, length: int) -> Iterator[tuple[int, ...]]:
  return itertools.combinations(range(length), weight)


@hypothesis.given(BITS, st.sampled_from(crc.NAMES))
def test_bits_with_their_check_are_these_bits(bits: str, name: str) -> None:
  word = crc.append(bits, name)
  assert len(word) == len(bits) + crc.width(name)
  assert crc.strip(word, name) == bits


@pytest.mark.parametrize(
  ('name', 'first', 'check'),
  [
    ('crc3', 0, '100'),  # CRC-3/GSM
    # The register of these begins with ones: as if the first bits were others.
    ('crc4', 4, '1011'),  # CRC-4/INTERLAKEN
    ('crc8', 8, f'{0xDF:08b}'),  # CRC-8/AUTOSAR
    # Its own is not inverted.
    ('crc8', 0, f'{0x3E ^ 0xFF:08b}'),  # CRC-8/OPENSAFETY
  ],
)
def test_checks_are_those_that_are_published(
  name: str, first: int, check: str
) -> None:
  bits = flipped(DIGITS, tuple(range(first)))
  assert crc.append(bits, name) == bits + check


@pytest.mark.parametrize('name', CHECKS)
def test_no_word_of_zeros_holds(name: str) -> None:
  assert {crc.strip('0' * length, name) for length in range(1, 300)} == {None}


@pytest.mark.parametrize(
  ('name', 'num_bits', 'weights'),
  [
    ('crc3', 4, (1, 2)),
    ('crc4', 11, (1, 2)),
    ('crc8', 12, (1, 2, 3)),
    ('crc8', 119, (1, 2)),  # Of 3 bits as of any odd number, see below.
  ],
)
def test_so_many_wrong_bits_are_always_noticed(
  name: str, num_bits: int, weights: tuple[int, ...]
) -> None:
  word = crc.append(('10' * num_bits)[:num_bits], name)
  for weight in weights:
    for places in errors_of(weight, len(word)):
      assert crc.strip(flipped(word, places), name) is None


@hypothesis.given(st.data(), BITS)
def test_crc8_notices_any_odd_number_of_wrong_bits(
  data: st.DataObject, bits: str
) -> None:
  word = crc.append(bits, 'crc8')
  places = data.draw(st.sets(st.integers(0, len(word) - 1), min_size=1))
  hypothesis.assume(len(places) % 2)
  assert crc.strip(flipped(word, tuple(places)), 'crc8') is None


def test_crc8_lets_few_patterns_of_four_bits_through() -> None:
  word = crc.append('010110', 'crc8')
  missed = [
    places
    for places in errors_of(4, len(word))
    if crc.strip(flipped(word, places), 'crc8')
  ]
  assert len(missed) == 5


@hypothesis.given(st.data(), BITS, st.sampled_from(CHECKS))
def test_a_run_no_longer_than_the_check_is_noticed(
  data: st.DataObject, bits: str, name: str
) -> None:
  word = crc.append(bits, name)
  length = crc.width(name)
  run = data.draw(st.integers(1, 2**length - 1))
  begin = data.draw(st.integers(0, len(word) - length))
  places = tuple(begin + k for k in range(length) if run >> k & 1)
  assert crc.strip(flipped(word, places), name) is None


def test_a_word_that_is_all_check_holds_nothing() -> None:
  assert [crc.strip('1' * length, 'crc3') for length in (1, 2, 3)] == [None] * 3


@pytest.mark.parametrize(
  'bits', ['', '012', ' 01', '\u0660\u0661', 1, None, b'01']
)
@pytest.mark.parametrize('use', [crc.append, crc.strip])
def test_what_is_no_bits_is_refused(use: object, bits: object) -> None:
  rule = '`bits` must be 1 or more characters of 0 and 1: got '
  with pytest.raises(crc.CheckError, match=rule):
    use(bits, 'crc4')


@pytest.mark.parametrize('name', ['crc16', 'CRC8', '', None, 8])
def test_another_check_is_refused_with_the_choices(name: object) -> None:
  rule = r"`check` must be one of \['none', 'crc3', 'crc4', 'crc8'\]: got "
  for use in (crc.width, lambda n: crc.append('1', n)):
    with pytest.raises(crc.CheckError, match=rule):
      use(name)
