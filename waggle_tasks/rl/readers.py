"""A learner of `Read`: it says bits, and learns from its reward alone.

REINFORCE (Williams, 1992, doi:10.1007/BF00992696) with Adam, by numpy. It looks
at a dance from where the target leaves its first place on; a network of one
hidden layer has a chance for each bit, and the bits that it says are drawn. Its
reward is the share of them that is right, as that of `Read` with `reward`
'dense'. It waits until a dance is over, which is no matter of learning here.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks.protocol import checks
from waggle_tasks.rl import adam, curve, glimpses, needs

_LEFT = 0.2  # Of its longest way: who is farther from its first place dances.
_LOOKS = 100  # Images of a dance that are looked at, about.
_EVERY = 50  # Updates between two points of a curve.
_RESTS = 4  # Images that tell the first place.


@dataclasses.dataclass(frozen=True)
class Numbers:
  """How it learns.

  Attributes:
    updates: How many times it learns, 1 to 1e6.
    batch: Dances of an update, 8 to 65536.
    hidden: Cells of the layer, 4 to 4096.
    rate: Its step, 1e-6 to 1.
    entropy: What a doubt is worth at first, 0 to 1; nothing in the end (see
      `learners.Numbers`).
  """

  updates: int = 2500
  batch: int = 256
  hidden: int = 128
  rate: float = 0.003
  entropy: float = 0.2

  def __post_init__(self) -> None:
    limits = {
      'updates': (1, 10**6), 'batch': (8, 65536), 'hidden': (4, 4096),
      'rate': (1e-6, 1), 'entropy': (0, 1),
    }  # fmt: skip
    checks.settle_numbers(self, limits, needs.LearningError)


class Reader:
  """Says bits for tracks."""

  def __init__(
    self, seen: glimpses.Glimpses, numbers: Numbers, rng: np.random.Generator
  ) -> None:
    """Begins with a network that says anything.

    Args:
      seen: How dances are seen.
      numbers: How it learns.
      rng: Draws the first network.
    """
    dance = glimpses.paths_m(seen.agreement).shape[1]
    self._step = math.ceil(dance / _LOOKS)
    self._window = dance // self._step
    size = 2 * self._window + 1
    self._parts = [
      rng.normal(0, 1 / np.sqrt(size), (size, numbers.hidden)),
      np.zeros(numbers.hidden),
      rng.normal(0, 0.01, (numbers.hidden, seen.num_bits)),
      np.zeros(seen.num_bits),
    ]
    self._adam = adam.Adam(self._parts, numbers.rate)

  def look(self, tracks: np.ndarray) -> np.ndarray:
    """What it makes of tracks (B, frames, 4), (B, 2 window + 1).

    Places from where it leaves its first one on, in the largest of them, and
    the logarithm of that.
    """
    seen = tracks[:, :, 2] > 0
    last = np.where(seen, np.arange(seen.shape[1]), 0)
    last = np.maximum.accumulate(last, axis=1)
    places = np.take_along_axis(tracks[:, :, :2], last[..., None], 1)
    places = places - np.median(places[:, :_RESTS], axis=1, keepdims=True)
    ways = np.abs(places).max(-1)
    size = ways.max(1, keepdims=True) + 1e-3
    begins = np.argmax(ways > _LEFT * size, axis=1)
    at = begins[:, None] + self._step * np.arange(self._window)
    at = np.minimum(at, places.shape[1] - 1)[..., None]
    looked = np.take_along_axis(places, at, 1).reshape(len(tracks), -1)
    return np.hstack([looked / size, np.log(size) / 3])

  def chances(self, looks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of a 1 for each bit, (B, bits), and the hidden cells."""
    into, bias, out, last = self._parts
    cells = np.tanh(looks @ into + bias)
    return 1 / (1 + np.exp(-(cells @ out + last))), cells

  def says(self, tracks: np.ndarray) -> np.ndarray:
    """The likelier bits of tracks (B, frames, 4), (B, bits) of 0 and 1."""
    return (self.chances(self.look(tracks))[0] > 0.5).astype(int)

  def learn(
    self, tracks: np.ndarray, bits: np.ndarray, entropy: float,
    rng: np.random.Generator,
  ) -> None:  # fmt: skip
    """Says something of tracks, and takes what it earns.

    Args:
      tracks: (B, frames, 4), see `glimpses.Glimpses.draw`.
      bits: (B, bits) what was danced, of which only the reward tells.
      entropy: What its doubt is worth.
      rng: Draws what it says.
    """
    looks = self.look(tracks)
    chances, cells = self.chances(looks)
    said = rng.random(chances.shape) < chances
    rewards = 2 * (said == bits).mean(1) - 1
    better = (rewards - rewards.mean())[:, None]
    doubts = np.log((1 - chances + 1e-12) / (chances + 1e-12))
    push = (
      better * (said - chances) + entropy * chances * (1 - chances) * doubts
    )
    push /= len(said)
    inner = (push @ self._parts[2].T) * (1 - cells**2)
    self._adam.climb([
      looks.T @ inner, inner.sum(0), cells.T @ push, push.sum(0),
    ])  # fmt: skip


def train(
  seen: glimpses.Glimpses = glimpses.Glimpses(),
  numbers: Numbers = Numbers(),
  seed: int = 0,
) -> curve.Curve:
  """Lets a reader learn from nothing.

  Args:
    seen: How dances are seen.
    numbers: How it learns.
    seed: Of all that is drawn.
  """
  rng = np.random.default_rng(seed)
  reader, points = Reader(seen, numbers, rng), []
  for update in range(numbers.updates):
    if update % _EVERY == 0:
      points.append((update * numbers.batch, share(reader, seen, rng)))
    values = rng.integers(2**seen.num_bits, size=numbers.batch)
    doubt = numbers.entropy * (1 - update / numbers.updates)
    reader.learn(seen.draw(values, rng), seen.bits(values), doubt, rng)
  points.append((numbers.updates * numbers.batch, share(reader, seen, rng)))
  episodes, right = np.array(points).T
  return curve.Curve(seed, episodes, right)


def share(
  reader: Reader,
  seen: glimpses.Glimpses,
  rng: np.random.Generator,
  count: int = 512,
) -> float:
  """The share of payloads that it reads, all bits of them."""
  values = rng.integers(2**seen.num_bits, size=count)
  said = reader.says(seen.draw(values, rng))
  return float((said == seen.bits(values)).all(1).mean())
