"""A logistic model of success, and where it falls below a level."""

from collections.abc import Mapping
import dataclasses
import math

import numpy as np
from scipy import optimize, special

# Log odds that a search which ends at slopes of 1e-5 cannot tell from none.
_NOTHING = 1e-4


@dataclasses.dataclass(frozen=True)
class Fit:
  """logit(p) = intercept + the sum of slope times value.

  Attributes:
    intercept: Log odds where every value is zero.
    slopes: By predictor, log odds for each of its units.
  """

  intercept: float
  slopes: Mapping[str, float]

  def crossing(
    self, name: str, others: Mapping[str, float], level: float
  ) -> float:
    """Where success is `level` as one predictor varies.

    Args:
      name: The predictor.
      others: The values of the others.
      level: A probability.

    Returns:
      Its value; infinite when it has no influence.
    """
    fixed = sum(self.slopes[n] * v for n, v in others.items() if n != name)
    slope = self.slopes[name]
    rest = special.logit(level) - self.intercept - fixed
    return float(rest / slope) if slope else math.inf


def fit(
  predictors: Mapping[str, np.ndarray], success: np.ndarray
) -> Fit | None:
  """The maximum likelihood fit, without a penalty.

  Args:
    predictors: (N,) values by name, each of more than one value.
    success: (N,) of bool.

  Returns:
    The fit; None when it does not exist, because the predictors separate
    success from failure or one of the two never happened (Albert and Anderson
    1984): the likelihood then grows without end.
  """
  columns = np.stack([*predictors.values()], axis=1)  # (N, P)
  centre, scale = columns.mean(axis=0), columns.std(axis=0)
  design = np.column_stack([np.ones(len(success)), (columns - centre) / scale])
  signs = np.where(success, 1.0, -1.0)  # (N,)
  if _is_separated(design * signs[:, None]):
    return None

  def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
    margins = signs * (design @ weights)
    gradient = -(signs * special.expit(-margins)) @ design
    return float(np.logaddexp(0.0, -margins).sum()), gradient

  found = optimize.minimize(loss, np.zeros(design.shape[1]), jac=True)
  weights = np.where(np.abs(found.x) < _NOTHING, 0.0, found.x)
  slopes = weights[1:] / scale
  intercept = weights[0] - slopes @ centre
  return Fit(
    float(intercept), dict(zip(predictors, map(float, slopes), strict=True))
  )


def _is_separated(signed: np.ndarray) -> bool:
  """Whether some weights put no success and no failure on the wrong side.

  Args:
    signed: (N, P) the design, failures with their sign turned.
  """
  rows = np.unique(signed, axis=0)
  # The largest sum of margins when none may be negative; zero if there is an
  # overlap.
  best = optimize.linprog(
    -rows.sum(axis=0), A_ub=-rows, b_ub=np.zeros(len(rows)), bounds=(-1, 1)
  )
  return -best.fun > 1e-9
