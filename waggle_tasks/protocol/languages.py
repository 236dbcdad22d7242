"""Languages by name: how bits become motions, and what confirms them."""

from collections.abc import Callable, Sequence
import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import (
  alphabets,
  checks,
  gestures,
  limits,
  schedule,
  sights,
  timing,
)
from waggle_tasks.protocol import coding as coding_lib
from waggle_tasks.protocol import levels as levels_lib
from waggle_tasks.protocol.symbols import BITS, Symbol

# Trackers err by 2 mm, root mean square, at every distance: what is half-way
# between two strokes that are so far apart is twice that from each.
APART_M = 0.008
# Up to here a language must be told from everywhere.
VIEWS_DEG = 60


class LanguageError(errors.WaggleError):
  """A language that nobody can speak or read."""


@dataclasses.dataclass(frozen=True)
class Language:
  """An alphabet, its frame and its code.

  A frame is START, symbols of a count that both sides know, and END; it is
  accepted when all of it came by the clock that START sets, and the dancer then
  rests. From every view up to 60 degrees, any two symbols must look at least
  8 mm apart, root mean square over their time; see `sights.nearest`.

  Attributes:
    alphabet: What is flown: levels, or gestures with rests between them.
    coding: What makes a message known from a damaged one.
    initial_hover_s: Stillness before the first frame, 0 to 60 s.
    confirm_s: Stillness after END that belongs to a frame, 0.1 to 10 s.
    pause_s: Stillness after that before the next frame, 0.3 to 60 s; 1.3 s is
      what whoever lost the dancer needs to learn anew how it looks at rest.
  """

  alphabet: levels_lib.Levels | alphabets.Gestures
  coding: coding_lib.Coding = coding_lib.Coding()
  initial_hover_s: float = 1.65
  confirm_s: float = 0.2
  pause_s: float = 1.3

  def __post_init__(self) -> None:
    kinds = levels_lib.Levels | alphabets.Gestures
    if not isinstance(self.alphabet, kinds):
      raise LanguageError(
        f'`alphabet` must be Levels or Gestures: got {self.alphabet!r}'
      )
    bounds = {
      'initial_hover_s': (0.0, 60.0),
      'confirm_s': (0.1, 10.0),
      'pause_s': (0.3, 60.0),
    }
    checks.settle_numbers(self, bounds, LanguageError)
    if not isinstance(self.coding, coding_lib.Coding):
      raise LanguageError(f'`coding` must be a Coding: got {self.coding!r}')
    self.coding.count(1, self.alphabet.size)  # Which refuses what does not fit.
    self._check_views()

  def _check_views(self) -> None:
    """Refuses symbols that cannot be told apart."""
    alike = sights.nearest(self.alphabet, VIEWS_DEG)
    if alike.distance_m < APART_M:
      where = (
        'every view' if alike.angle_deg is None
        else f'{alike.angle_deg:g} degrees'
      )  # fmt: skip
      raise LanguageError(
        f'`alphabet` must have symbols that look at least {1000 * APART_M:g} mm'
        f' apart from every view up to {VIEWS_DEG} degrees:'
        f' {" and ".join(alike.symbols)} are {1000 * alike.distance_m:.1f} mm'
        f' apart from {where}'
      )

  @property
  def pauses(self) -> timing.Timing:
    """Its rests, as those of gestures are told."""
    return timing.Timing(self.initial_hover_s, 0.0, self.alphabet.rest_s, 0.0)

  def fly(
    self, frames: Sequence[Sequence[alphabets.Token]]
  ) -> tuple[schedule.Slot, ...]:
    """Frames one after another."""
    tokens: list[alphabets.Token] = []
    for frame in frames:
      tokens += [*frame, self.confirm_s + self.pause_s]
    return alphabets.lay_out(self.alphabet, tokens, self.initial_hover_s)


def _gestures(
  arm_m: float,
  start_m: float,
  end_m: float,
  rest_s: float,
  leg_s: Callable[[float, float], float],
) -> Language:
  """The paper's four gestures.

  Args:
    arm_m: Half the width, and the height, of a V.
    start_m: How far START climbs.
    end_m: Half the width of END.
    rest_s: The rest after each gesture but END.
    leg_s: The time of a leg that leads so far sideways, and so far up.
  """
  hover = (0.0, 0.0)
  bit_s = 4 * leg_s(arm_m, arm_m)
  start_s = 2 * leg_s(0.0, start_m)
  end_s = 3 * leg_s(2 * end_m, 0.0)  # All legs take the time of the longest.
  vee = (hover, (-arm_m, arm_m), hover, (arm_m, arm_m), hover)
  ways = {
    Symbol.START: ((hover, (0.0, start_m), hover), start_s),
    BITS[0]: (vee, bit_s),
    BITS[1]: (tuple((x_m, -z_m) for x_m, z_m in vee), bit_s),
    Symbol.END: ((hover, (-end_m, 0.0), (end_m, 0.0), hover), end_s),
  }
  codebook = gestures.Codebook(
    tuple(gestures.Gesture(symbol, *way) for symbol, way in ways.items())
  )
  return Language(alphabets.Gestures(codebook, rest_s))


LANGUAGES = {
  'brisk': _gestures(
    0.04,
    0.15,
    0.08,
    0.08,
    lambda right_m, up_m: levels_lib.least_s(max(right_m, up_m)),
  ),
  # What four rotors fly: they lean before they go sideways, and settle after.
  'gentle': _gestures(
    0.15,
    0.3,
    0.2,
    0.4,
    lambda right_m, up_m: limits.least_s(right_m, up_m, 'rotors'),
  ),
  # For observers within 2 m.
  'rapid': Language(levels_lib.quickest(8, 0.085), coding_lib.Coding(parity=2)),
  'swift': Language(levels_lib.quickest(8, 0.14), coding_lib.Coding(parity=2)),
}
