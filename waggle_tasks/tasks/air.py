"""What the air is to do: wind, gusts, and what vehicles blow down."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks


class AirError(errors.WaggleError):
  """Air that nobody could fly in, or that would do nothing."""


@dataclasses.dataclass(frozen=True)
class Air:
  """Wind and downwash; by default the air rests.

  Attributes:
    wind_mps: Speed of the mean wind, 0 to 4 m/s.
    wind_deg: Where it blows to, -180 to 180 degrees, as the heading of a
      message: at 0 away from the front observer (+y), at 90 to its left (-x).
    gusts: Whether it gusts, as by the Dryden spectra of MIL-F-8785C near the
      ground: by a fifth of the wind along and across it, a tenth upwards.
    downwash: Whether vehicles are in the jets of those above them.
  """

  wind_mps: float = 0.0
  wind_deg: float = 0.0
  gusts: bool = False
  downwash: bool = False

  def __post_init__(self) -> None:
    limits = {'wind_mps': (0.0, 4.0), 'wind_deg': (-180.0, 180.0)}
    checks.settle_numbers(self, limits, AirError)
    for field in ('gusts', 'downwash'):
      checks.settle(
        self, field, checks.switch(field, getattr(self, field), AirError)
      )
    if self.gusts and not self.wind_mps:
      raise AirError(
        '`gusts` must be False without wind: they are a part of it'
      )

  @property
  def rests(self) -> bool:
    """Whether it does nothing."""
    return not (self.wind_mps or self.downwash)
