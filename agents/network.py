"""A small network that names what was seen in a slot, and knows what is none.

Two hidden layers; it gives a probability to every symbol, to END and to none of
them, and tells how the pose has changed: where the dancer wandered and how late
it is. It was trained on tracks that were drawn, see
`waggle_tasks.experiments.train_learned`. A network is sure of much that it has
never seen. So two distances guard it: what is left of a window once all that
symbols look like is taken out (reconstruction from principal components), and
how far the last layer is from that of the class (Lee et al. 2018, 'A Simple
Unified Framework for Detecting Out-of-Distribution Samples', NeurIPS). Outliers
took part in training as a class of their own (Hendrycks et al. 2019, 'Deep
Anomaly Detection with Outlier Exposure', ICLR).
"""

from collections.abc import Mapping
import dataclasses

import numpy as np

from waggle_tasks.agents import windows

MOVES = 3  # What it tells of a pose: right and down in m, lateness in s.


@dataclasses.dataclass(frozen=True)
class Answer:
  """What a window was taken for.

  Attributes:
    kind: The number of a symbol; after them come END, and none of them.
    probability: How sure it is.
    left: What is left of the window, as a share of the most that is left of a
      symbol.
    distance: The same of how far it is from its class.
    move: (3,) how the pose differs, see `MOVES`.
  """

  kind: int
  probability: float
  left: float
  distance: float
  move: np.ndarray


@dataclasses.dataclass(frozen=True, eq=False)
class Network:
  """Weights, all that was learned.

  Attributes:
    layers: Weights and biases of three layers: (D, H), (H,), and so on.
    unit_m: What counts as 1 of a place.
    units: (3,) what counts as 1 of `MOVES`.
    mean: (2 P,) of windows of symbols, in units.
    basis: (K, 2 P) their principal components.
    most_left: The most that is left of one, root mean square in units.
    centres: (C, H) the last layer of each class but none.
    precision: (H, H) inverse covariance about them.
    most_distance: The largest distance of one.
  """

  layers: tuple[np.ndarray, ...]
  unit_m: float
  units: np.ndarray
  mean: np.ndarray
  basis: np.ndarray
  most_left: float
  centres: np.ndarray
  precision: np.ndarray
  most_distance: float

  @property
  def kinds(self) -> int:
    """How many classes there are: symbols, END and none."""
    return len(self.centres) + 1

  def inputs(self, window: windows.Window, state: np.ndarray) -> np.ndarray:
    """(D,) what it looks at.

    Args:
      window: The window.
      state: (S,) 1 for where the dancer was before, zeros if not known; empty
        where it is always the same.
    """
    places = (window.places_m / self.unit_m).ravel()
    return np.concatenate([places, window.seen, state])

  def last(self, inputs: np.ndarray) -> np.ndarray:
    """(..., H) the last layer of inputs (..., D)."""
    one, bias, two, other = self.layers[:4]
    hidden = np.maximum(inputs @ one + bias, 0.0)
    return np.maximum(hidden @ two + other, 0.0)

  def left(self, places: np.ndarray, seen: np.ndarray) -> float:
    """What is left of places (P, 2), in units, where they were seen (P,)."""
    rows = np.repeat(seen > 0, 2)
    if not rows.any():
      return np.inf
    off = (places.ravel() - self.mean)[rows]
    parts = self.basis[:, rows].T
    found, *_ = np.linalg.lstsq(parts, off, rcond=1e-6)
    return float(np.sqrt(np.mean((off - parts @ found) ** 2)))

  def distances(self, last: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """(N,) how far last layers (N, H) are from those of their classes (N,)."""
    off = last - self.centres[kinds]
    return np.sqrt(np.einsum('ni,ij,nj->n', off, self.precision, off))

  def read(self, window: windows.Window, state: np.ndarray) -> Answer:
    """Names a window; see `inputs`."""
    last = self.last(self.inputs(window, state))
    out = last @ self.layers[4] + self.layers[5]
    logits, move = out[:-MOVES], out[-MOVES:] * self.units
    odds = np.exp(logits - logits.max())
    kind = int(logits.argmax())
    probability = float(odds[kind] / odds.sum())
    left = self.left(window.places_m / self.unit_m, window.seen)
    distance = np.inf
    if kind < len(self.centres):
      distance = float(self.distances(last[None], np.array([kind]))[0])
    return Answer(
      kind, probability, left / self.most_left, distance / self.most_distance,
      move,
    )  # fmt: skip

  def arrays(self) -> dict[str, np.ndarray]:
    """All of it by name, as it is kept in a file, in single precision."""
    plain = {
      field.name: getattr(self, field.name)
      for field in dataclasses.fields(self)
      if field.name != 'layers'
    }
    plain |= {f'layer_{k}': each for k, each in enumerate(self.layers)}
    return {name: np.asarray(each, np.float32) for name, each in plain.items()}

  @classmethod
  def of(cls, arrays: Mapping[str, np.ndarray]) -> 'Network':
    """What `arrays` gave, in double precision."""
    found = {name: np.asarray(each, float) for name, each in arrays.items()}
    layers = tuple(
      found[f'layer_{k}']
      for k in range(sum(name.startswith('layer_') for name in arrays))
    )
    return cls(
      layers, float(found['unit_m']), found['units'], found['mean'],
      found['basis'], float(found['most_left']), found['centres'],
      found['precision'], float(found['most_distance']),
    )  # fmt: skip
