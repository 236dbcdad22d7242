"""Adam (Kingma and Ba, 2015, arXiv:1412.6980), by numpy."""

import numpy as np


class Adam:
  """Moves numbers along their gradient, each at a pace of its own."""

  def __init__(self, values: list[np.ndarray], rate: float) -> None:
    """Takes the arrays that it changes, and its step."""
    self._values, self._rate, self._count = values, rate, 0
    self._mean = [np.zeros_like(each) for each in values]
    self._square = [np.zeros_like(each) for each in values]

  def climb(self, gradients: list[np.ndarray]) -> None:
    """One step up."""
    self._count += 1
    for value, gradient, mean, square in zip(
      self._values, gradients, self._mean, self._square, strict=True
    ):
      mean += 0.1 * (gradient - mean)
      square += 0.001 * (gradient**2 - square)
      first = mean / (1 - 0.9**self._count)
      second = square / (1 - 0.999**self._count)
      value += self._rate * first / (np.sqrt(second) + 1e-8)
