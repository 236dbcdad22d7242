"""What codes do on a channel: right, wrong and refused messages, counted."""

import itertools

from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.results import goodput, intervals
from waggle_tasks.experiments.studies import channel

_LANGUAGE = 'swift'
_CODES = (
  'check=none,parity=0', 'check=crc4,parity=0', 'check=crc8,parity=0',
  'check=none,parity=2', 'check=crc3,parity=2', 'check=crc8,parity=2',
  'check=none,parity=3',
)  # fmt: skip
_RATES = ((0.01, 0.05), (0.05, 0.10))
# Levels dance their symbols in their order.
_CONFUSIONS = ('any', 'natural')
_LEGEND = (
  'sub., er.: probability that another symbol is seen, or none. confused: with'
  ' any other,\nor with the level above or below. s: seconds of a message.'
  ' at most: of wrong messages,\none-sided 95 % limit. bit/s: bits x share of'
  ' right messages / seconds.'
)


def report(messages: int) -> str:
  """The table, counted now.

  Args:
    messages: How many are sent with each code on each channel.

  Raises:
    ChannelError: if there are none, or too many.
  """
  header = (
    'code', 'symbols', 's', 'sub.', 'er.', 'confused', 'right', 'wrong',
    'at most', 'refused', 'bit/s',
  )  # fmt: skip
  lines = [
    _line(code, channel.Channel(*rates, confusion), messages)
    for rates, confusion, code in itertools.product(_RATES, _CONFUSIONS, _CODES)
  ]
  title = f'{_LANGUAGE}, {messages} messages each'
  return '\n\n'.join([title, table.render(header, lines), _LEGEND])


def _line(code: str, noisy: channel.Channel, messages: int) -> tuple[str, ...]:
  scene = scenario_fields.make({'language': f'{_LANGUAGE}:{code}'})
  agreed = scene.agreement
  bits, size = agreed.frame_bits, agreed.spoken.alphabet.size
  got = channel.simulate(agreed.coding, bits, size, noisy, messages)
  seconds = goodput.airtime_s(scene)
  return (
    code, str(agreed.coding.count(bits, size)), f'{seconds:.1f}',
    f'{noisy.substitution:g}', f'{noisy.erasure:g}', noisy.confusion,
    f'{got.right / messages:.4f}', f'{got.wrong / messages:.2e}',
    f'{intervals.upper_limit(got.wrong, messages):.1e}',
    f'{got.refused / messages:.4f}',
    f'{bits * got.right / messages / seconds:.2f}',
  )  # fmt: skip
