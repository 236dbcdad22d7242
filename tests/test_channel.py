"""What is counted on a channel is what `Coding.read` makes of each message."""

import numpy as np
import pytest

from waggle_tasks.experiments.studies import channel
from waggle_tasks.protocol import coding


@pytest.mark.parametrize('confusion', channel.CONFUSIONS)
@pytest.mark.parametrize(
  ('code', 'num_bits', 'size'),
  [
    (coding.Coding(parity=2), 6, 8),
    (coding.Coding('crc3', 2), 6, 8),
    (coding.Coding('crc4', 1), 13, 4),
    (coding.Coding('crc8'), 7, 2),
  ],
)
def test_counts_are_those_of_reading_each_message(
  code: coding.Coding, num_bits: int, size: int, confusion: str
) -> None:
  noisy = channel.Channel(0.1, 0.15, confusion)
  rng = np.random.default_rng(5)
  messages = 1500
  bits = rng.integers(2, size=(messages, num_bits), dtype=np.uint8)
  texts = [''.join(map(str, row)) for row in bits]
  # The first bit of a message is the last of its units.
  sent = np.array([code.symbols(text[::-1], size) for text in texts])
  seen = noisy.received(sent, size, rng)
  want = [0, 0, 0]
  for text, word in zip(texts, seen.tolist(), strict=True):
    symbols = [None if symbol == 255 else symbol for symbol in word]
    got = code.read(symbols, num_bits, size).bits
    want[2 if got is None else int(got != text[::-1])] += 1
  got = channel.simulate(code, num_bits, size, noisy, messages, seed=5)
  assert (got.right, got.wrong, got.refused) == (*want,)


def test_neighbours_in_gray_order_differ_in_one_bit() -> None:
  others = channel.Channel(0.1, 0, 'gray').others(8)
  apart = others ^ np.arange(8)[:, None]
  assert {*apart.ravel().tolist()} == {1, 2, 4}
  natural = channel.Channel(0.1, 0, 'natural').others(8)
  assert natural.tolist()[0] == [1, 1]
  assert natural.tolist()[3] == [2, 4]
  assert natural.tolist()[7] == [6, 6]


@pytest.mark.parametrize('field', ['substitution', 'erasure'])
def test_what_is_no_probability_is_refused(field: str) -> None:
  values = {'substitution': 0.1, 'erasure': 0.1, field: 1.5}
  with pytest.raises(channel.ChannelError, match=f'`{field}` must be between'):
    channel.Channel(**values)
