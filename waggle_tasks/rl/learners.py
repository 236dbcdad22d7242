"""Learners of `Dance` that know nothing of each other: two times REINFORCE.

Williams (1992), doi:10.1007/BF00992696, with Adam. The speaker has a mean of
each height for each payload, and tries others about it; the listener has a
network of one hidden layer and says what it draws. Each learns from its own
reward alone, by numpy.
"""

import dataclasses

import numpy as np

from waggle_tasks.rl import adam, curve, needs, signals

_LEFT_M = 0.03  # In half widths: who is farther from its first place dances.
_EVERY = 20  # Updates between two points of a curve.


@dataclasses.dataclass(frozen=True)
class Numbers:
  """How they learn.

  Attributes:
    updates: How many times they learn, 1 to 1e6.
    batch: Episodes of an update, 8 to 65536.
    hidden: Cells of the listener's layer, 4 to 4096.
    speaker_rate: Step of the speaker, 1e-6 to 1.
    listener_rate: Step of the listener, 1e-6 to 1.
    entropy: What a doubt of the listener is worth at first, 0 to 1; nothing in
      the end (Williams and Peng, 1991, doi:10.1080/09540099108946587).
    first_sigma: How far the speaker tries at first, 0.01 to 1...
    last_sigma: ...and in the end.
  """

  updates: int = 3000
  batch: int = 512
  hidden: int = 128
  speaker_rate: float = 0.01
  listener_rate: float = 0.002
  entropy: float = 0.03
  first_sigma: float = 0.3
  last_sigma: float = 0.05

  def __post_init__(self) -> None:
    for name, least, most in (
      ('updates', 1, 10**6), ('batch', 8, 65536), ('hidden', 4, 4096),
      ('speaker_rate', 1e-6, 1), ('listener_rate', 1e-6, 1), ('entropy', 0, 1),
      ('first_sigma', 0.01, 1), ('last_sigma', 0.01, 1),
    ):  # fmt: skip
      value = getattr(self, name)
      if not least <= value <= most:
        raise needs.LearningError(
          f'`{name}` must be {least:g} to {most:g}: got {value!r}'
        )


class Speaker:
  """Chooses heights for payloads.

  Attributes:
    means: (payloads, strokes) what it dances when it does not try.
  """

  def __init__(
    self,
    payloads: int,
    strokes: int,
    numbers: Numbers,
    rng: np.random.Generator,
  ) -> None:
    """Begins near home, by what is drawn."""
    self.means = rng.uniform(-0.3, 0.3, (payloads, strokes))
    self._adam = adam.Adam([self.means], numbers.speaker_rate)

  def act(
    self, meant: np.ndarray, sigma: float, rng: np.random.Generator
  ) -> np.ndarray:
    """Heights for payloads, (B, strokes), tried about the means."""
    means = self.means[meant]
    return means + sigma * rng.normal(size=means.shape)

  def learn(
    self,
    meant: np.ndarray,
    danced: np.ndarray,
    rewards: np.ndarray,
    sigma: float,
  ) -> None:
    """Takes what was earned by dances of payloads."""
    better = (rewards - rewards.mean())[:, None]
    gradient = np.zeros_like(self.means)
    push = better * (danced - self.means[meant]) / sigma**2
    np.add.at(gradient, meant, push / len(meant))
    self._adam.climb([gradient])
    np.clip(self.means, -1, 1, out=self.means)


class Listener:
  """Says payloads for tracks."""

  def __init__(
    self,
    payloads: int,
    channel: signals.Channel,
    numbers: Numbers,
    rng: np.random.Generator,
  ) -> None:
    """Begins with a network that says anything."""
    self._window = round((channel.strokes + 1) * signals.STROKE_S * 12.5)
    size = self._window + 1
    self._parts = [
      rng.normal(0, 1 / np.sqrt(size), (size, numbers.hidden)),
      np.zeros(numbers.hidden),
      rng.normal(0, 0.01, (numbers.hidden, payloads)),
      np.zeros(payloads),
    ]
    self._adam = adam.Adam(self._parts, numbers.listener_rate)

  def look(self, tracks: np.ndarray) -> np.ndarray:
    """What it makes of tracks, (B, window + 1).

    Heights from where it leaves its first place on, every second image, in the
    largest of them, and the logarithm of that.
    """
    heights = _filled(tracks)
    heights = heights - np.median(heights[:, :4], axis=1, keepdims=True)
    begins = np.argmax(abs(heights) > _LEFT_M, axis=1)
    at = begins[:, None] + 2 * np.arange(self._window)
    seen = np.take_along_axis(
      heights, np.minimum(at, heights.shape[1] - 1), axis=1
    )
    size = abs(seen).max(1, keepdims=True) + 1e-3
    return np.hstack([seen / size, np.log(size) / 3])

  def chances(self, looks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each payload, (B, payloads), and the hidden cells."""
    into, bias, out, last = self._parts
    cells = np.tanh(looks @ into + bias)
    scores = cells @ out + last
    scores -= scores.max(1, keepdims=True)
    chances = np.exp(scores)
    return chances / chances.sum(1, keepdims=True), cells

  def learn(
    self,
    looks: np.ndarray,
    said: np.ndarray,
    rewards: np.ndarray,
    chances: np.ndarray,
    cells: np.ndarray,
    entropy: float,
  ) -> None:
    """Takes what was earned by what it said, and what its doubt is worth."""
    better = (rewards - rewards.mean())[:, None] / len(said)
    push = -chances * better
    push[np.arange(len(said)), said] += better[:, 0]
    logs = np.log(chances + 1e-12)
    doubt = -(chances * logs).sum(1, keepdims=True)
    push -= entropy / len(said) * chances * (logs + doubt)
    inner = (push @ self._parts[2].T) * (1 - cells**2)
    self._adam.climb([
      looks.T @ inner, inner.sum(0), cells.T @ push, push.sum(0),
    ])  # fmt: skip


def _filled(tracks: np.ndarray) -> np.ndarray:
  """Heights, those that were not seen as in the image before, (B, frames)."""
  seen = tracks[:, :, 1] > 0
  last = np.where(seen, np.arange(seen.shape[1]), 0)
  last = np.maximum.accumulate(last, axis=1)
  return np.take_along_axis(tracks[:, :, 0], last, 1)


def train(
  payloads: int,
  channel: signals.Channel,
  numbers: Numbers = Numbers(),
  seed: int = 0,
) -> curve.Curve:
  """Lets a speaker and a listener learn from nothing.

  Args:
    payloads: How many there are to tell apart.
    channel: What is between them.
    numbers: How they learn.
    seed: Of all that is drawn.
  """
  rng = np.random.default_rng(seed)
  speaker = Speaker(payloads, channel.strokes, numbers, rng)
  listener = Listener(payloads, channel, numbers, rng)
  points = []
  for update in range(numbers.updates):
    if update % _EVERY == 0:
      right = understood(speaker, listener, channel, rng)
      points.append((update * numbers.batch, right))
    done = update / numbers.updates
    sigma = (
      numbers.first_sigma * (numbers.last_sigma / numbers.first_sigma) ** done
    )
    meant = rng.integers(payloads, size=numbers.batch)
    danced = speaker.act(meant, sigma, rng)
    looks = listener.look(channel.tracks(danced, rng))
    chances, cells = listener.chances(looks)
    drawn = rng.random((numbers.batch, 1))
    said = np.minimum((chances.cumsum(1) < drawn).sum(1), payloads - 1)
    rewards = (said == meant).astype(float)
    doubt = numbers.entropy * (1 - done)
    listener.learn(looks, said, rewards, chances, cells, doubt)
    speaker.learn(meant, danced, rewards, sigma)
  points.append(
    (
      numbers.updates * numbers.batch,
      understood(speaker, listener, channel, rng),
    )
  )
  episodes, right = np.array(points).T
  return curve.Curve(seed, episodes, right, speaker.means.copy())


def understood(
  speaker: Speaker,
  listener: Listener,
  channel: signals.Channel,
  rng: np.random.Generator,
  rounds: int = 64,
) -> float:
  """The share of payloads that a listener understands, without trying."""
  meant = np.tile(np.arange(len(speaker.means)), rounds)
  looks = listener.look(channel.tracks(speaker.means[meant], rng))
  chances, _ = listener.chances(looks)
  return float((chances.argmax(1) == meant).mean())
