"""A swarm that chooses a nest site by dancing, by models that are published.

Two published models say what a vehicle does; what is new is that a dance has to
be read. In `value` (Pais et al. 2013, doi:10.1371/journal.pone.0073216, as
agents by Reina et al. 2015, doi:10.1371/journal.pone.0140950) a vehicle without
a site finds one of value v at the rate v, is recruited by whoever dances for it
at the rate v, gives it up at the rate 1/v, and is stopped by whoever dances for
another one at the rate of the stop signal. In `list` (List, Elsholtz and Seeley
2009, doi:10.1098/rstb.2008.0277) a vehicle that does not dance finds a site j
with the probability (1 - lambda) pi_j + lambda f_j, where f_j is the share of
the swarm that dances for it, and dances for as many steps as its value, times
the exponential of a normal error.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.experiments.episodes import word_level
from waggle_tasks.protocol import checks

MODELS = 'value', 'list'
_MOST_VEHICLES, _MOST_SITES = 100_000, 16


class ColonyError(errors.WaggleError):
  """A swarm that cannot choose."""


@dataclasses.dataclass(frozen=True)
class Swarm:
  """Vehicles, sites, and how they choose.

  Where no source is named, the value is a choice of this project.

  Attributes:
    vehicles: How many, 2 to 100000.
    qualities: Of the sites, the best first, 0.01 to 1 each.
    noise: Standard deviation of the logarithm of a vehicle's own measure of a
      site, 0 to 2: it multiplies by the exponential of a normal error, as in
      List et al. 2009. What it dances follows its own measure.
    model: One of `MODELS`.
    value: The value of a site of quality 1: a rate in `value`, a number of
      steps in `list`; 1 to 100.
    stop: Rate of the stop signal (sigma of Pais et al. 2013), 0 to 1000; only
      in `value`.
    follow: How much vehicles follow dances (lambda of List et al. 2009), 0 to
      1; only in `list`.
    found: The chance of a site to be found without a dance in a step (pi of
      List et al. 2009), 0 to 1 for all together; only in `list`.
    quorum: The share of all vehicles, in `list` of all that dance, that must be
      for a site, 0.5 to 1.
    watching: From where dances are watched.
    wrong: Share of frames that are read as another site, 0 to 1: none was ever
      seen; it is there to see what one would do.
    step_s: How long a frame takes, from the rest before it until it is read, s:
      6.56 in swift, rounded up to a tenth.
    longest_s: When a swarm that has not chosen is ended, s.
  """

  vehicles: int = 100
  qualities: tuple[float, ...] = (1.0, 0.5)
  noise: float = 0.2
  model: str = 'value'
  value: float = 5.0
  stop: float = 5.0
  follow: float = 0.8
  found: float = 0.25
  quorum: float = 0.8
  watching: word_level.Watching = word_level.Watching()
  wrong: float = 0.0
  step_s: float = 6.6
  longest_s: float = 7200.0

  def __post_init__(self) -> None:
    limits = {
      'vehicles': (2, _MOST_VEHICLES),
      'noise': (0.0, 2.0),
      'value': (1.0, 100.0),
      'stop': (0.0, 1000.0),
      'follow': (0.0, 1.0),
      'found': (0.0, 1.0),
      'quorum': (0.5, 1.0),
      'wrong': (0.0, 1.0),
      'step_s': (0.1, 1000.0),
      'longest_s': (self.step_s, 1e6),
    }
    checks.settle_numbers(self, limits, ColonyError)
    checks.choice('model', self.model, MODELS, ColonyError)
    sites = tuple(self.qualities)
    for quality in sites:
      checks.number('qualities', quality, 0.01, 1.0, ColonyError)
    if not 2 <= len(sites) <= _MOST_SITES or max(sites) != sites[0]:
      raise ColonyError(
        f'`qualities` must be 2 to {_MOST_SITES} numbers, the largest first:'
        f' got {sites}'
      )
    checks.settle(self, 'qualities', tuple(map(float, sites)))

  @property
  def values(self) -> np.ndarray:  # (S,)
    """The values of the sites."""
    return self.value * np.array(self.qualities)

  @property
  def steps(self) -> int:
    """After how many steps a swarm that has not chosen is ended."""
    return math.ceil(self.longest_s / self.step_s)

  @property
  def rate(self) -> float:
    """How many units of the time of `value` a step is.

    The most that can happen to a vehicle in a step has a probability of a half:
    to be found or recruited, or to be stopped or to give up. A measure that is
    too good by two standard deviations still fits.
    """
    most = self.values * math.exp(2 * self.noise)
    come = self.values.sum() + most.max()
    go = self.stop + (1 / self.values).max() * math.exp(2 * self.noise)
    return 0.5 / max(come, go)

  @property
  def unit_s(self) -> float:
    """How long a unit of the time of `value` is, s."""
    return self.step_s / self.rate


@dataclasses.dataclass(frozen=True, eq=False)
class Choice:
  """What some worlds came to.

  Attributes:
    chosen: (W,) which site reached the quorum; -1 for none in time.
    steps: (W,) after how many steps.
    shares: (T, S) how many vehicles were for each site in the first world, as
      shares, from the first step on.
    read: (W,) what share of frames was readable in each world.
    frames: Frames that were watched in all.
  """

  chosen: np.ndarray
  steps: np.ndarray
  shares: np.ndarray
  read: np.ndarray
  frames: int
