"""How learners learned."""

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Curve:
  """How one seed learned.

  Attributes:
    seed: Of all that was drawn.
    episodes: (N,) played before each point.
    right: (N,) share of payloads that were understood, of what is not tried but
      chosen.
    means: (payloads, strokes) the language in the end, where one is learned.
  """

  seed: int
  episodes: np.ndarray
  right: np.ndarray
  means: np.ndarray | None = None
