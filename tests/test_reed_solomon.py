"""Blocks are filled and corrected as far as promised, and never guessed."""

import functools
import itertools

import hypothesis
from hypothesis import strategies as st
import numpy as np
import pytest

from waggle_tasks.protocol import finite_field, reed_solomon

SIZES = st.sampled_from([4, 8, 16])
Word = tuple[int | None, ...]


@st.composite
def blocks(draw: st.DrawFn) -> tuple[tuple[int, ...], int, int]:
  """A block, its parity symbols, and the size of its alphabet."""
  size = draw(SIZES)
  parity = draw(st.integers(0, size - 2))
  symbol = st.integers(0, size - 1)
  data = draw(st.lists(symbol, min_size=1, max_size=size - 1 - parity))
  return reed_solomon.encode(data, parity, size), parity, size


@st.composite
def spoilt(draw: st.DrawFn, block: tuple[int, ...], size: int) -> Word:
  """A word like a block, some of its symbols missing and some other ones."""
  changes = draw(
    st.dictionaries(
      st.integers(0, len(block) - 1), st.none() | st.integers(0, size - 1)
    )
  )
  return tuple(changes.get(k, symbol) for k, symbol in enumerate(block))


def distance(word: Word, block: tuple[int, ...]) -> int:
  """2 e + f."""
  pairs = zip(word, block, strict=True)
  return sum(1 if w is None else 2 * (w != b) for w, b in pairs)


@pytest.mark.parametrize('size', [4, 8, 16])
def test_a_field_is_a_field(size: int) -> None:
  field, symbols = finite_field.of(size), range(size)
  assert {*field.powers} == {*symbols} - {0}
  for a, b, c in itertools.product(symbols, repeat=3):
    assert field.times(a, b) == field.times(b, a)
    assert field.times(a, b ^ c) == field.times(a, b) ^ field.times(a, c)
    product = field.times(field.times(a, b), c)
    assert product == field.times(a, field.times(b, c))
  for a, b in itertools.product(symbols, symbols[1:]):
    assert field.times(field.over(a, b), b) == a


@hypothesis.given(blocks())
def test_a_block_has_its_roots_and_begins_with_its_data(
  made: tuple[tuple[int, ...], int, int],
) -> None:
  block, parity, size = made
  field = finite_field.of(size)
  roots = [field.power(exponent) for exponent in range(1, parity + 1)]
  assert {field.value(block[::-1], root) for root in roots} <= {0}
  data = block[: len(block) - parity]
  assert reed_solomon.encode(data, parity, size) == block


def test_a_block_is_that_of_the_textbook() -> None:
  # (x + 2) (x + 4) over GF(8): x^2 + 6 x + 3.
  assert reed_solomon.encode([1], 2, 8) == (1, 6, 3)
  assert reed_solomon.encode([0, 0, 1], 2, 8) == (0, 0, 1, 6, 3)


@pytest.mark.slow
@hypothesis.settings(max_examples=300)
@hypothesis.given(st.data(), blocks())
def test_whatever_is_near_enough_is_found_and_nothing_else(
  data: st.DataObject, made: tuple[tuple[int, ...], int, int]
) -> None:
  block, parity, size = made
  spare = data.draw(st.integers(0, parity))
  word = data.draw(spoilt(block, size))
  got = reed_solomon.decode(word, parity, size, spare)
  if distance(word, block) <= parity - spare:
    assert got == block
  elif got is not None:  # It is so near to another one.
    assert distance(word, got) <= parity - spare
    kept = len(got) - parity
    assert reed_solomon.encode(got[:kept], parity, size) == got


@pytest.mark.parametrize(('size', 'length', 'parity'), [(4, 3, 2), (8, 4, 2)])
def test_every_word_of_a_short_block_is_read_as_the_nearest_or_not_at_all(
  size: int, length: int, parity: int
) -> None:
  words = itertools.product([None, *range(size)], repeat=length)
  data = itertools.product(range(size), repeat=length - parity)
  code = [reed_solomon.encode(each, parity, size) for each in data]
  values = np.array(code)
  for word in words:
    seen = np.array([-1 if s is None else s for s in word])
    far = (2 * (values != seen) - (seen < 0)).sum(axis=1)
    for spare in range(parity + 1):
      near = [code[k] for k in np.flatnonzero(far <= parity - spare)]
      assert len(near) <= 1
      want = near[0] if near else None
      assert reed_solomon.decode(word, parity, size, spare) == want


def test_symbols_kept_for_confirmation_are_not_used_up() -> None:
  word = (None, 5, *reed_solomon.encode([3, 5], 2, 8)[2:])
  assert reed_solomon.decode(word, 2, 8, spare=1)[0] == 3
  missing = (None, None, *word[2:])
  assert reed_solomon.decode(missing, 2, 8)[:2] == (3, 5)
  assert reed_solomon.decode(missing, 2, 8, spare=1) is None
  # One that was misread beside one that was not seen.
  assert reed_solomon.decode((None, 4, *word[2:]), 2, 8, spare=1) is None


@pytest.mark.parametrize(
  ('call', 'error'),
  [
    (lambda: reed_solomon.encode([0], 1, 2), r'`size` .* \[4, 8, 16\]: got 2'),
    (lambda: reed_solomon.encode([0], 1, 32), r'`size` .* \[4, 8, 16\]: got'),
    (lambda: reed_solomon.encode([0], 1, 8.0), '`size` .* got 8.0'),
    (lambda: reed_solomon.encode([0], 7, 8), '`parity` .* 0 and 6: got 7'),
    (lambda: reed_solomon.encode([0], -1, 8), '`parity` .* got -1'),
    (lambda: reed_solomon.encode([0], True, 8), '`parity` .* got True'),
    (lambda: reed_solomon.encode([], 2, 8), '`data` .* 1 to 5 symbols: got 0'),
    (lambda: reed_solomon.encode([0] * 6, 2, 8), '1 to 5 symbols: got 6'),
    (lambda: reed_solomon.encode([8], 2, 8), '`data` .* 0 and 7: got 8'),
    (lambda: reed_solomon.encode([None], 2, 8), '`data` must be an integer'),
    (lambda: reed_solomon.decode([0, 1], 2, 8), '`word` .* 3 to 7 .* got 2'),
    (lambda: reed_solomon.decode([0] * 8, 2, 8), '`word` .* 3 to 7 .* got 8'),
    (lambda: reed_solomon.decode([0, 8, 0], 2, 8), '`word` .* got 8'),
    (lambda: reed_solomon.decode([0] * 3, 2, 8, 3), '`spare` .* 0 and 2: got'),
    (lambda: reed_solomon.decode([0] * 3, 2, 8, -1), '`spare` .* got -1'),
  ],
)
def test_what_does_not_fit_is_refused(
  call: functools.partial, error: str
) -> None:
  with pytest.raises(reed_solomon.ReedSolomonError, match=error):
    call()


@pytest.mark.parametrize(('size', 'parity'), [(4, 2), (8, 2), (8, 4), (16, 5)])
def test_blocks_are_those_of_another_program(size: int, parity: int) -> None:
  galois = pytest.importorskip('galois')
  length = size - 1
  code = galois.ReedSolomon(length, length - parity, field=galois.GF(size))
  rng = np.random.default_rng(0)
  for kept in range(1, length - parity + 1):
    data = rng.integers(size, size=kept)
    want = code.encode(galois.GF(size)(data))
    assert reed_solomon.encode(data, parity, size) == (*map(int, want),)
