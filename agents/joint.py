"""Reads a frame as a whole: every symbol by the agreed clock, from one view.

A frame is a path through the states of its alphabet. Viterbi's algorithm finds
the one that is nearest to what was seen (Forney 1973,
doi:10.1109/PROC.1973.9030). Each path that survives has a belief of its own of
how the dancer wanders and how its clock differs (per-survivor processing,
Raheli et al. 1995, doi:10.1109/26.380133).
"""

from collections.abc import Sequence

import numpy as np

from waggle_tasks.agents import lock as lock_lib
from waggle_tasks.agents import reading, slots, wander_chain

_Evidences = list[wander_chain.Evidence]


class Reader:
  """Reads one frame, whose START is known.

  Attributes:
    word: (N,) the symbols as they are read so far.
  """

  def __init__(self, frame: slots.Slots, found: lock_lib.Lock) -> None:
    """Reads the whole frame, symbol by symbol.

    Args:
      frame: What was seen in its slots.
      found: Its START.
    """
    self._frame = frame
    self._after = frame.shapes.after
    self._numbers = [slots.START, *range(frame.count + 1)]
    self._poses = [slots.Pose(found.home_px, 0.0, found.scale_px)]
    self._view, self.word = self._survive()
    self._nearest = self.word
    self._smooth()

  def again(self, word: np.ndarray) -> None:
    """Sees the frame as another word (N,), and what there is from there."""
    self.word = word
    self._smooth()

  def _survive(self) -> tuple[int, np.ndarray]:
    """The view and the symbols that cost least; poses are about theirs."""
    frame, poses = self._frame, self._poses
    num_views, num_states = frame.shapes.ends.shape[:2]
    beliefs = wander_chain.Beliefs.before((num_views, num_states))
    begun = frame.evidence(slots.START, poses[0])
    beliefs = beliefs.seen(begun[:, None])
    beliefs.cost[:, 1:] = np.inf  # A frame begins in the first state.
    steps: list[tuple[np.ndarray, np.ndarray]] = []
    for number in range(frame.count):
      best = np.unravel_index(int(beliefs.cost.argmin()), beliefs.cost.shape)
      move = beliefs.mean[best] * (1, 1, 1, 0)  # Of one scale for all.
      poses.append(poses[-1].moved(move))
      beliefs = beliefs.moved(move)
      found = frame.evidence(number, poses[-1])
      beliefs, step = self._step(beliefs[:, :, None].seen(found))
      steps.append(step)
    poses.append(poses[-1])
    ended = beliefs.seen(frame.evidence(frame.count, poses[-1]))
    return _trace(ended.cost, steps)

  def _step(
    self, each: wander_chain.Beliefs
  ) -> tuple[wander_chain.Beliefs, tuple[np.ndarray, np.ndarray]]:
    """One slot on: what survives, its symbol and the state before, (V, S)."""
    before = each.cost.argmin(axis=1)  # (V, M)
    least = each.cost.min(axis=1)
    groups = [
      np.flatnonzero(self._after == state)
      for state in range(each.cost.shape[1])
    ]
    picked = np.stack(
      [group[least[:, group].argmin(axis=1)] for group in groups], axis=1
    )
    views = np.arange(len(least))[:, None]
    came = before[views, picked]
    return each[views, came, picked], (picked, came)

  def _states(self, words: np.ndarray) -> np.ndarray:
    """(W, N + 1) the states before each symbol of words (W, N), and at END."""
    begin = np.zeros((len(words), 1), int)
    return np.concatenate([begin, self._after[words]], axis=1)

  def _index(self, number: int) -> tuple[int, ...]:
    """Which of the paths of a slot the word has."""
    if number == slots.START:
      return (self._view,)
    state = int(self._states(self.word[None])[0, number])
    if number == self._frame.count:
      return self._view, state
    return self._view, state, int(self.word[number])

  def _smooth(self) -> None:
    """Each slot's pose by all that was seen before and after it.

    END of levels is told by where it leads: it is judged by what came before
    it, and vouches for nothing. That of gestures is told by its shape.
    """
    frame, numbers, poses = self._frame, self._numbers, self._poses
    if frame.shapes.alphabet.states > 1:
      numbers, poses = numbers[:-1], poses[:-1]
    seen = [
      frame.evidence(number, pose)[self._index(number)]
      for number, pose in zip(numbers, poses, strict=True)
    ]
    found = wander_chain.Evidence(
      np.array([each.square for each in seen]),
      np.array([each.linear for each in seen]),
      np.array([each.rest for each in seen]),
    )
    moves = wander_chain.smooth(found, _steps(poses))
    pairs = zip(poses, moves, strict=True)
    poses = [pose.moved(move) for pose, move in pairs]
    self._poses = poses + poses[-1:] * (len(self._poses) - len(poses))
    named = zip(self._numbers, self._poses, strict=True)
    self._seen = [frame.evidence(*each)[self._view] for each in named]
    self._ideal = [
      frame.ideal(number, self._index(number))[self._view]
      for number in self._numbers
    ]

  def costs(self, words: np.ndarray) -> np.ndarray:
    """How far words (W, N) are from what was seen, each with its own wander."""
    return self._chain(words, self._seen, _steps(self._poses))

  def apart(self, words: np.ndarray) -> np.ndarray:
    """How far words (W, N) are from the one that is read, if all is seen."""
    steps = np.zeros((len(self._numbers) - 1, wander_chain.SIZE))
    return self._chain(words, self._ideal, steps)

  def _chain(
    self, words: np.ndarray, found: _Evidences, steps: np.ndarray
  ) -> np.ndarray:
    begun, *slotted, ended = found
    states = self._states(words)
    beliefs = wander_chain.Beliefs.before((len(words),)).seen(begun[None])
    for number, (each, step) in enumerate(
      zip(slotted, steps[:-1], strict=True)
    ):
      picked = each[states[:, number], words[:, number]]
      beliefs = beliefs.moved(step).seen(picked)
    return beliefs.moved(steps[-1]).seen(ended[states[:, -1]]).cost

  def judged(self) -> reading.Reading:
    """What the word stands on."""
    return reading.judge(
      self._frame, self.word, self._view, self._poses, self._mended()
    )

  def _mended(self) -> float:
    """How much nearer the nearest of all words is, see `reading.Reading`."""
    if (self._nearest == self.word).all():
      return 0.0
    words = np.stack([self.word, self._nearest])
    own, other = self.costs(words)
    return float((own - other) / self.apart(words[1:])[0])


def _steps(poses: Sequence[slots.Pose]) -> np.ndarray:
  """(N - 1, 4) how far each of poses is from the one before."""
  pairs = zip(poses[1:], poses[:-1], strict=True)
  return np.array([later.step(before) for later, before in pairs])


def _trace(
  cost: np.ndarray,  # (V, S)
  steps: list[tuple[np.ndarray, np.ndarray]],
) -> tuple[int, np.ndarray]:
  """The view and the symbols of the path that costs least."""
  view, state = np.unravel_index(int(cost.argmin()), cost.shape)
  word = []
  for symbols, befores in reversed(steps):
    word.append(int(symbols[view, state]))
    state = befores[view, state]
  return int(view), np.array(word[::-1], int)
