"""Medians of small tables, which are taken for every picture."""

import numpy as np


def of(values: np.ndarray) -> np.ndarray:
  """The median along the first axis.

  It is what `np.median` gives for tables that hold numbers only, and several
  times faster for as few values as a picture's edges are.

  Args:
    values: (N,) or (N, M), at least one row.

  Returns:
    () or (M,).
  """
  half = len(values) // 2
  if len(values) % 2:
    return np.partition(values, half, axis=0)[half]
  low, high = half - 1, half + 1
  return np.partition(values, (low, half), axis=0)[low:high].mean(axis=0)
