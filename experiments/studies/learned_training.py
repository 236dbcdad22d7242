"""Trains the network of a receiver on windows that are drawn.

Adam (Kingma and Ba 2015, arXiv:1412.6980) in numpy, with a step that falls to
nothing as half a cosine does; then what symbols look like and how far they lie
apart is measured on windows that it was not trained on. All is drawn from one
seed: the same seed and versions give the same weights.
"""

from collections.abc import Callable, Iterator
import dataclasses
import itertools

import numpy as np

from waggle_tasks.agents import network
from waggle_tasks.experiments.studies import learned_tracks

HIDDEN = (96, 64)
_BATCH, _POOL, _PASSES = 256, 8192, 6  # Windows, and how often each is seen.
_RATE, _MOMENTA, _TINY = 4e-3, (0.9, 0.999), 1e-8
_MOVES = 0.3  # Weight of what is told of poses beside the classes.
_COMPONENTS = 12
_SURE = 0.9995  # Of symbols, so many are within the limits.
_RIDGE = 1e-3
_BELIEVED = 0.9  # What is less probable is not.
_CALIBRATED = 16_000  # Windows by which limits are measured.


def train(
  tracks: learned_tracks.Tracks,
  seed: int,
  steps: int,
  report: Callable[[int, float], None],
) -> network.Network:
  """Trains a network.

  Args:
    tracks: Draws windows.
    seed: Of all that is drawn.
    steps: How many batches it learns from.
    report: Told the number of a step and its loss, now and then.
  """
  rng = np.random.default_rng(seed)
  layers = _fresh(rng, tracks)
  means = [np.zeros_like(each) for each in layers]
  squares = [np.zeros_like(each) for each in layers]
  batches: Iterator[learned_tracks.Batch] = iter(())
  for step in range(1, steps + 1):
    if (batch := next(batches, None)) is None:
      batches = _batches(tracks, rng)
      batch = next(batches)
    loss, slopes = _slopes(layers, batch, tracks.none)
    rate = _RATE * (1 + np.cos(np.pi * step / steps)) / 2
    for each, slope, mean, square in zip(
      layers, slopes, means, squares, strict=True
    ):
      mean += (1 - _MOMENTA[0]) * (slope - mean)
      square += (1 - _MOMENTA[1]) * (slope**2 - square)
      first = mean / (1 - _MOMENTA[0] ** step)
      second = square / (1 - _MOMENTA[1] ** step)
      each -= rate * first / (np.sqrt(second) + _TINY)
    if step % 250 == 0:
      report(step, loss)
  return _guarded(layers, tracks, rng)


def _batches(
  tracks: learned_tracks.Tracks, rng: np.random.Generator
) -> Iterator[learned_tracks.Batch]:
  """Batches of new windows, each of which comes a few times."""
  pool = tracks.draw(rng, _POOL)
  for _ in range(_PASSES):
    order = rng.permutation(_POOL).reshape(-1, _BATCH)
    for rows in order:
      yield pool[rows]


def _fresh(
  rng: np.random.Generator, tracks: learned_tracks.Tracks
) -> list[np.ndarray]:
  """Weights and biases of three layers, drawn (He et al. 2015)."""
  width = tracks.draw(rng, 1).inputs.shape[1]
  sizes = (width, *HIDDEN, tracks.none + 1 + network.MOVES)
  layers: list[np.ndarray] = []
  for low, high in itertools.pairwise(sizes):
    layers += [
      rng.normal(0, np.sqrt(2 / low), (low, high)).astype(np.float32),
      np.zeros(high, np.float32),
    ]  # fmt: skip
  return layers


def _slopes(
  layers: list[np.ndarray], batch: learned_tracks.Batch, none: int
) -> tuple[float, list[np.ndarray]]:
  """The loss of a batch, and how it changes with each weight."""
  one, bias, two, other, three, last_bias = layers
  inputs = batch.inputs.astype(np.float32)
  hidden = np.maximum(inputs @ one + bias, 0.0)
  last = np.maximum(hidden @ two + other, 0.0)
  out = last @ three + last_bias
  logits, moves = out[:, : -network.MOVES], out[:, -network.MOVES :]
  logits = logits - logits.max(axis=1, keepdims=True)
  odds = np.exp(logits)
  odds /= odds.sum(axis=1, keepdims=True)
  count, rows = len(inputs), np.arange(len(inputs))
  own = np.maximum(odds[rows, batch.kinds], 1e-12)
  told = (batch.kinds != none)[:, None]
  off = (moves - batch.moves) * told
  loss = -np.log(own).mean() + _MOVES * (off**2).mean()
  odds[rows, batch.kinds] -= 1.0
  pull = np.concatenate(
    [odds / count, 2 * _MOVES * off / off.size], axis=1, dtype=np.float32
  )
  slopes = [last.T @ pull, pull.sum(axis=0)]
  pull = (pull @ three.T) * (last > 0)
  slopes = [hidden.T @ pull, pull.sum(axis=0), *slopes]
  pull = (pull @ two.T) * (hidden > 0)
  return float(loss), [inputs.T @ pull, pull.sum(axis=0), *slopes]


def _guarded(
  layers: list[np.ndarray],
  tracks: learned_tracks.Tracks,
  rng: np.random.Generator,
) -> network.Network:
  """The network with what its two distances need."""
  batch = _symbols(tracks, rng)
  whole = batch.seen.all(axis=1)
  flat = batch.places[whole].reshape(np.count_nonzero(whole), -1)
  mean = flat.mean(axis=0)
  _, _, basis = np.linalg.svd(flat - mean, full_matrices=False)
  bare = network.Network(
    tuple(layers), tracks.unit_m, tracks.units, mean, basis[:_COMPONENTS], 1.0,
    np.zeros((0, HIDDEN[1])), np.eye(HIDDEN[1]), 1.0,
  )  # fmt: skip
  last = bare.last(batch.inputs)
  centres = np.array(
    [last[batch.kinds == kind].mean(axis=0) for kind in range(tracks.none)]
  )
  off = last - centres[batch.kinds]
  spread = off.T @ off / len(off)
  ridge = _RIDGE * np.trace(spread) / len(spread)
  precision = np.linalg.inv(spread + ridge * np.eye(len(spread)))
  ready = dataclasses.replace(bare, centres=centres, precision=precision)
  other = _symbols(tracks, rng)
  left = [
    ready.left(*each) for each in zip(other.places, other.seen, strict=True)
  ]
  far = ready.distances(ready.last(other.inputs), other.kinds)
  ready = dataclasses.replace(
    ready,
    most_left=float(np.quantile(left, _SURE)),
    most_distance=float(np.quantile(far, _SURE)),
  )
  return network.Network.of(ready.arrays())  # As it will be read again.


def _symbols(
  tracks: learned_tracks.Tracks, rng: np.random.Generator
) -> learned_tracks.Batch:
  """Windows of symbols and of END."""
  batch = tracks.draw(rng, _CALIBRATED)
  return batch[np.flatnonzero(batch.kinds != tracks.none)]


def score(
  found: network.Network, tracks: learned_tracks.Tracks, seed: int
) -> str:
  """How well windows are read that it has not seen, in words.

  Args:
    found: The network.
    tracks: Draws windows.
    seed: Of what is drawn.
  """
  batch = tracks.draw(np.random.default_rng(seed), _CALIBRATED)
  last = found.last(batch.inputs)
  out = last @ found.layers[4] + found.layers[5]
  logits = out[:, : -network.MOVES]
  odds = np.exp(logits - logits.max(axis=1, keepdims=True))
  sure = odds.max(axis=1) / odds.sum(axis=1) >= _BELIEVED
  kinds = logits.argmax(axis=1)
  named = np.flatnonzero(sure & (kinds != tracks.none))
  far = found.distances(last[named], kinds[named]) > found.most_distance
  left = np.array([found.left(batch.places[k], batch.seen[k]) for k in named])
  said = np.zeros(len(kinds), bool)
  said[named[~far & (left <= found.most_left)]] = True
  good = batch.kinds != tracks.none
  right = said & (kinds == batch.kinds)
  return (
    f'right {right[good].mean():.2%}, wrong {(said & ~right)[good].mean():.3%},'
    f' not sure {(~said)[good].mean():.2%}; of what is none'
    f' {said[~good].mean():.2%} taken for something'
  )
