"""A message is believed when what was seen confirms it."""

import hypothesis
from hypothesis import strategies as st
import pytest

from waggle_tasks import plain
from waggle_tasks.protocol import coding, crc

BITS = st.text('01', min_size=1, max_size=119)


@st.composite
def cases(draw: st.DrawFn) -> tuple[coding.Coding, str, int]:
  size = draw(st.sampled_from(coding.SIZES))
  parity = draw(st.integers(0, size - 2))
  code = coding.Coding(draw(st.sampled_from(crc.NAMES)), parity)
  return code, draw(BITS), size


@hypothesis.given(cases())
def test_what_was_seen_whole_is_the_message(
  case: tuple[coding.Coding, str, int],
) -> None:
  code, bits, size = case
  sent = code.symbols(bits, size)
  assert len(sent) == code.count(len(bits), size)
  assert code.read(sent, len(bits), size) == coding.Reading(bits)


@hypothesis.given(st.data(), cases())
def test_a_burst_is_filled_over_all_blocks(
  data: st.DataObject, case: tuple[coding.Coding, str, int]
) -> None:
  code, bits, size = case
  hypothesis.assume(code.parity)
  sent = code.symbols(bits, size)
  count = -(-(len(bits) + crc.width(code.check)) // (size.bit_length() - 1))
  blocks = (len(sent) - count) // code.parity
  length = blocks * (code.parity - (code.check == 'none'))
  begin = data.draw(st.integers(0, len(sent) - length))
  seen = [*sent]
  seen[begin : begin + length] = [None] * length
  want = coding.Reading(bits, filled=length)
  assert code.read(seen, len(bits), size) == want


@pytest.mark.slow
@hypothesis.settings(max_examples=200)
@hypothesis.given(st.data(), cases())
def test_without_a_check_nothing_that_was_seen_is_changed(
  data: st.DataObject, case: tuple[coding.Coding, str, int]
) -> None:
  code, bits, size = coding.Coding(parity=case[0].parity), *case[1:]
  sent = code.symbols(bits, size)
  place = st.integers(0, len(sent) - 1)
  value = st.none() | st.integers(0, size - 1)
  changes = data.draw(st.dictionaries(place, value, max_size=4))
  seen = [changes.get(k, symbol) for k, symbol in enumerate(sent)]
  got = code.read(seen, len(bits), size)
  assert got.corrected == 0
  if got.bits is not None:
    again = code.symbols(got.bits, size)
    assert all(s in (None, a) for s, a in zip(seen, again, strict=True))


def test_with_a_check_errors_are_corrected() -> None:
  code = coding.Coding('crc3', 2)
  sent = code.symbols('010110', 8)
  wrong = (sent[0] ^ 5, *sent[1:])
  want = coding.Reading('010110', corrected=1)
  assert code.read(wrong, 6, 8) == want
  refused = coding.Coding(parity=2).symbols('010110', 8)
  got = coding.Coding(parity=2).read((refused[0] ^ 5, *refused[1:]), 6, 8)
  assert got.bits is None


def test_a_check_refuses_what_it_does_not_confirm() -> None:
  code = coding.Coding('crc4')
  sent = code.symbols('0101', 16)
  got = code.read((sent[0] ^ 1, sent[1]), 4, 16)
  assert (got.bits, got.reason) == (None, 'crc4 does not hold')


def test_a_pad_that_is_not_zero_is_refused() -> None:
  got = coding.Coding().read((0, 1), 4, 8)
  assert (got.bits, got.reason[:5]) == (None, 'what ')


def test_without_a_code_every_symbol_has_to_be_seen() -> None:
  for check in crc.NAMES:
    code = coding.Coding(check)
    seen = (*code.symbols('010110', 8)[:-1], None)
    assert code.read(seen, 6, 8).bits is None


@pytest.mark.parametrize(
  ('call', 'error'),
  [
    (lambda: coding.Coding('crc5'), '`check` must be one of .* Did you mean'),
    (lambda: coding.Coding(parity=15), '`parity` must be between 0 and 14'),
    (lambda: coding.Coding(parity=1.0), '`parity` must be an integer'),
    (
      lambda: coding.Coding(parity=1).count(6, 2),
      r'`parity` .* 0 and 0 in an alphabet of 2 .* got 1, .* \[4, 8, 16\]',
    ),
    (
      lambda: coding.Coding(parity=7).symbols('0', 8),
      r'`parity` .* 0 and 6 in an alphabet of 8 .* got 7, .* \[16\]',
    ),
    (lambda: coding.Coding().count(0, 8), '`num_bits` .* 1 and 119: got 0'),
    (lambda: coding.Coding().count(6, 3), r'`size` .* \[2, 4, 8, 16\]: got 3'),
    (lambda: coding.Coding().symbols('', 8), '`bits` .* 1 to 119 .* got 0'),
    (lambda: coding.Coding().read((0,), 6, 8), '`symbols` must be 2, .* got 1'),
    (lambda: coding.Coding().read((0, 8), 6, 8), '`symbols` .* 7: got 8'),
  ],
)
def test_what_does_not_fit_is_refused(call: object, error: str) -> None:
  with pytest.raises(coding.CodingError, match=error):
    call()


def test_a_coding_goes_to_plain_data_and_back() -> None:
  code = coding.Coding('crc8', 4)
  assert plain.from_plain(coding.Coding, plain.to_plain(code)) == code
