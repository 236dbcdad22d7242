"""A sweep as data: factors, their product, and the cases of every cell."""

from collections.abc import Mapping, Sequence
import dataclasses
import hashlib
import itertools
import math
from typing import Any

from waggle_tasks import errors
from waggle_tasks import scenario as scenario_lib
from waggle_tasks.experiments.record import eye_fields, scenario_fields
from waggle_tasks.protocol import checks, packets

RANDOM, ALL = 'random', 'all'
MAX_CASES = 1_000_000
_MOST_BITS = 10  # Of payloads that are flown all.


class SweepError(errors.WaggleError):
  """A sweep that cannot be run."""


@dataclasses.dataclass(frozen=True)
class Sample:
  """One episode of a sweep.

  Attributes:
    cell: The factors and their values here.
    repeat: Which of the cell's episodes, from 0.
    values: Every value of the scenario, see `scenario_fields`.
    scene: The scenario.
    receiver: Who reads it; empty for the receiver of the study.
  """

  cell: Mapping[str, Any]
  repeat: int
  values: Mapping[str, Any]
  scene: scenario_lib.Scenario
  receiver: str = ''

  @property
  def name(self) -> str:
    """What it is called: its cell and its repeat."""
    return f'{cell_name(self.cell)} #{self.repeat}'.lstrip()


def cell_name(cell: Mapping[str, Any]) -> str:
  """A cell as text, such as 'distance_m=0.6 bearing_deg=15.0'."""
  return ' '.join(f'{name}={value}' for name, value in cell.items())


def grid(texts: Sequence[str]) -> dict[str, list[object]]:
  """The factors of a sweep.

  Args:
    texts: Such as 'distance_m=0.6,0.8'; 'payload=all' stands for all there
      are.

  Returns:
    The values of each factor, by its name in `scenario_fields`.

  Raises:
    WaggleError: naming what is wrong with one of them.
  """
  out = {}
  for text in texts:
    name, equals, listed = text.partition('=')
    if not equals:
      raise SweepError(f'`grid` must be NAME=VALUE,VALUE,...: got {text!r}')
    if name == 'seed':
      raise SweepError('`grid` must not name seed: every case has its own')
    if name == 'hover_log':
      raise SweepError('`grid` must not name hover_log: fly a sweep of each')
    others = [
      field
      for field in scenario_fields.defaults()
      if field not in ('seed', 'hover_log')
    ]
    checks.choice('grid', name, others, SweepError)
    if name in out:
      raise SweepError(f'`grid` must name a field once: got {name} again')
    values = [scenario_fields.parse(name, each) for each in listed.split(',')]
    if any(map(scenario_fields.is_own, values)):
      raise SweepError(
        f'`grid` must hold names for {name}: fly a sweep of each file'
      )
    if len(set(values)) < len(values):
      raise SweepError(f'`grid` must give a value once: got {text!r}')
    out[name] = values
  return out


def cases(
  factors: Mapping[str, Sequence[object]],
  base: Mapping[str, Any],
  repeats: int,
) -> tuple[Sample, ...]:
  """Every case of a sweep, cell by cell.

  Each case has a seed of its own: 32 bits of a SHA-256 of the repeat and of all
  values of its scenario that are not the defaults, the base's seed among them.
  A random payload, and random bits, come from other bits of it. So more
  factors, values or repeats leave the other cases as they are, and two sweeps
  never share a case unless it is the same scenario.

  Args:
    factors: See `grid`.
    base: All values of the scenario that the factors change; its payload may
      be 'random', and its bits 'random:64' or another number.
    repeats: How many episodes a cell has.

  Raises:
    WaggleError: if there are too many, or a scenario breaks a rule; then the
      error names its cell.
  """
  checks.integer('repeats', repeats, 1, MAX_CASES, SweepError)
  if list(factors.get('payload', ())) == [ALL]:
    factors = {**factors, 'payload': _all_payloads(factors, base)}
  count = math.prod(map(len, factors.values())) * repeats
  if count > MAX_CASES:
    raise SweepError(
      f'`grid` and `repeats` must make at most {MAX_CASES} cases: got {count}'
    )
  out = []
  for values in itertools.product(*factors.values()):
    cell = dict(zip(factors, values, strict=True))
    try:
      out += [draw(cell, base, repeat) for repeat in range(repeats)]
    except errors.WaggleError as error:
      raise SweepError(f'cell {cell_name(cell)}: {error}') from None
  return tuple(out)


def _all_payloads(
  factors: Mapping[str, Sequence[object]], base: Mapping[str, Any]
) -> list[str]:
  fixed = [
    name for name in ('heading_bits', 'distance_bits') if name in factors
  ]
  bits = _num_bits(base)
  if fixed or bits > _MOST_BITS:
    raise SweepError(
      f'`grid` may hold payload=all for at most {_MOST_BITS} bits, and not'
      f' beside other numbers of bits: got {fixed or bits}'
    )
  return [f'{number:0{bits}b}' for number in range(2**bits)]


def _num_bits(values: Mapping[str, Any]) -> int:
  return 1 + values['heading_bits'] + values['distance_bits']


def draw(
  cell: Mapping[str, Any], base: Mapping[str, Any], repeat: int
) -> Sample:
  """One case, with the seed, the payload and the bits of its own; see `cases`.

  Raises:
    WaggleError: if the scenario breaks a rule.
  """
  values = {**base, **cell}
  drawn = hashlib.sha256(_seed_text(values, repeat).encode()).digest()
  values['seed'] = int.from_bytes(drawn[:4], 'big')
  if values['payload'] == RANDOM:
    bits = _num_bits(values)
    number = int.from_bytes(drawn[4:], 'little') % 2**bits
    values['payload'] = f'{number:0{bits}b}'
  if values['bits'].startswith(RANDOM):
    values['bits'] = _drawn_bits(values['bits'], drawn)
  whole = eye_fields.filled(values, scenario_fields.defaults(), cell)
  return Sample(cell, repeat, values, scenario_fields.make(whole))


def _drawn_bits(text: str, drawn: bytes) -> str:
  """As many bits as a text such as 'random:64' asks for.

  Raises:
    WaggleError: if it asks for none, for too many, or for something else.
  """
  _, colon, count = text.partition(':')
  if not colon or not count.isdecimal():
    raise SweepError(
      f"`bits` must be characters of 0 and 1, or '{RANDOM}:N' for N bits that"
      f' are drawn: got {text!r}'
    )
  packets.Packets.of(int(count))  # Refuses what no message holds.
  long = hashlib.shake_256(drawn).digest(-(-int(count) // 8))
  return ''.join(f'{byte:08b}' for byte in long)[: int(count)]


def _seed_text(values: Mapping[str, Any], repeat: int) -> str:
  """What a case's seed is drawn from: the same whichever way it was said."""
  usual = scenario_fields.defaults()
  unusual = {n: v for n, v in sorted(values.items()) if v != usual[n]}
  unusual.pop('fidelity', None)  # One case is the same at every level.
  return f'{cell_name(unusual)} #{repeat}'
