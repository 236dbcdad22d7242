"""What a language is like, measured by itself: nothing is flown."""

import dataclasses

from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import alphabets, languages, limits, schedule, sights
from waggle_tasks.protocol.symbols import Symbol

HEADER = (
  'language', 's', 'with hover', 'bits', 'bit/s', 'symbols', 'm/s', 'up',
  'sideways', *limits.DYNAMICS, 'apart mm', 'from deg', 'nearest',
)  # fmt: skip
ABOUT = (
  's: from the first stroke to acceptance. symbols: between START and END.\n'
  'm/s, up, sideways: the most that is flown, accelerations in m/s^2.\n'
  f'apart: root mean square of the two nearest symbols, from the views up to'
  f' {sights.WIDEST_DEG} degrees.'
)


@dataclasses.dataclass(frozen=True)
class Measured:
  """A language by numbers.

  Attributes:
    begin_s: When the first stroke of a frame begins, after the first hover.
    accepted_s: When the rest after END is over.
    bits: Bits of a payload.
    symbols: Symbols of a frame, between START and END.
    speed_mps: Most speed along an axis, as for the next two.
    up_mps2: Most acceleration upwards.
    sideways_mps2: Most acceleration sideways.
    refusals: Why a kind of vehicle cannot fly it, by the kind; empty if it can.
    nearest: The two symbols that look most alike.
  """

  begin_s: float
  accepted_s: float
  bits: int
  symbols: int
  speed_mps: float
  up_mps2: float
  sideways_mps2: float
  refusals: dict[str, str]
  nearest: sights.Separation

  @property
  def seconds(self) -> float:
    """From the first stroke to acceptance."""
    return self.accepted_s - self.begin_s

  def row(self, name: str) -> list[str]:
    """Its line of a table, see `HEADER`."""
    angle_deg = self.nearest.angle_deg
    return [
      name,
      table.number(self.seconds),
      table.number(self.accepted_s),
      str(self.bits),
      table.number(self.bits / self.seconds),
      str(self.symbols),
      table.number(self.speed_mps),
      table.number(self.up_mps2),
      table.number(self.sideways_mps2),
      *('no' if self.refusals[each] else 'yes' for each in limits.DYNAMICS),
      table.number(self.nearest.distance_m, 1, 1e3),
      'any' if angle_deg is None else f'{angle_deg:g}',
      ' '.join(self.nearest.symbols),
    ]


def frame(language: languages.Language, bits: str) -> tuple[schedule.Slot, ...]:
  """How a payload is flown."""
  word = language.coding.symbols(bits, language.alphabet.size)
  tokens: list[alphabets.Token] = [Symbol.START, *word, Symbol.END]
  return language.fly([tokens])


def measure(language: languages.Language) -> Measured:
  """The numbers of a language, for a payload of the usual units."""
  bits = agreement_lib.Agreement().units.num_bits
  slots = frame(language, '0' * bits)
  motions = language.alphabet.motions
  peaks = [limits.peaks(path) for path in motions]
  return Measured(
    slots[0].begin_s,
    slots[-1].end_s + language.confirm_s,
    bits,
    len(slots) - 2,
    max(each.speed_mps for each in peaks),
    max(each.up_mps2 for each in peaks),
    max(each.sideways_mps2 for each in peaks),
    {name: _refusal(motions, name) for name in limits.DYNAMICS},
    sights.nearest(language.alphabet),
  )


def _refusal(motions: tuple[schedule.Path, ...], dynamics: str) -> str:
  """Why motions cannot be flown; empty if they can."""
  try:
    limits.check_motions(motions, limits.LIMITS[dynamics])
  except limits.LimitError as error:
    return str(error)
  return ''
