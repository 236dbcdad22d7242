"""How an episode is scored: values, one for each observer and for all."""

import dataclasses

EARLY = 'premature motion'  # How the failure of who left its place begins.


@dataclasses.dataclass(frozen=True)
class Account:
  """One observer's episode, as files tell it.

  Attributes:
    observer: Its name.
    expected: The bits that it should have read, or None.
    decoded: The bits that it read, or None.
    end_s: When it recognised the END of that message.
    final_null_s: When it confirmed the final null.
    start_s: When its navigation began.
    arrival_s: When it had stood at the place that was sent for 0.4 s.
    error_m: How far from that place it was at the last frame.
    hold_s: How long it stayed there after arriving.
    failures: Every check that failed, with the reason; empty is a pass.
    diagnosis: Where reading failed, for one without a message.
    estimate_error_m: What it took `error_m` for, where it had an estimate.
  """

  observer: str
  expected: str | None
  decoded: str | None = None
  end_s: float | None = None
  final_null_s: float | None = None
  start_s: float | None = None
  arrival_s: float | None = None
  error_m: float | None = None
  hold_s: float | None = None
  failures: tuple[str, ...] = ()
  diagnosis: str = ''
  estimate_error_m: float | None = None


class Outcome(Account):
  """One observer's episode, and what follows from it."""

  @property
  def correct(self) -> bool:
    """Whether it read what was sent to it."""
    return self.expected is not None and self.decoded == self.expected

  @property
  def wrong(self) -> bool:
    """Whether it read a message that was not sent to it."""
    return self.decoded not in (None, self.expected)

  @property
  def unauthorised(self) -> bool:
    """Whether it left its place without the message that was sent to it."""
    early = any(each.startswith(EARLY) for each in self.failures)
    return early or (self.start_s is not None and not self.correct)


@dataclasses.dataclass(frozen=True)
class Verdict:
  """The whole group's episode.

  Attributes:
    outcomes: One for each observer.
    passed: Whether no check of any observer failed.
  """

  outcomes: tuple[Outcome, ...]

  @property
  def passed(self) -> bool:
    """Whether no check of any observer failed."""
    return not any(outcome.failures for outcome in self.outcomes)

  @property
  def correct(self) -> int:
    """How many observers read what was sent to them."""
    return sum(outcome.correct for outcome in self.outcomes)
