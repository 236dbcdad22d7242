"""Says where success falls below 90 %, by a logistic fit of each map."""

from collections.abc import Mapping

import numpy as np

from waggle_tasks.experiments.results import envelope, logistic

LEVEL = 0.9
_UNITS = {'angle': 'deg', 'distance': 'm'}


def lines(panel: envelope.Panel) -> list[str]:
  """A map's fit over viewing angle and distance, in words.

  Every observer that a message was sent to counts, with its true distance and
  the amount of its true angle.

  Args:
    panel: The map.

  Returns:
    Nothing when neither of the two varies.
  """
  sent = [
    outcome
    for row in panel.rows
    for outcome in row.outcomes
    if outcome.expected is not None
  ]
  values = {
    'angle': np.array([abs(o.true_angle_deg) for o in sent]),
    'distance': np.array([o.true_distance_m for o in sent]),
  }
  varying = {n: v for n, v in values.items() if len(np.unique(v)) > 1}
  if not varying:
    return []
  right = np.array([outcome.right for outcome in sent])
  head = f'{panel.title}: ' if panel.title else ''
  if right.all():
    return [
      f'{head}no logistic fit: all {len(right)} succeeded, so that no angle or'
      ' distance is found at which success falls below 90 %.'
    ]
  if not right.any():
    return [f'{head}no logistic fit: none of {len(right)} succeeded.']
  fit = logistic.fit(varying, right)
  if fit is None:
    return [
      f'{head}no logistic fit: success and failure are separated by'
      f' {" and ".join(varying)} ({right.sum()} of {len(right)} succeeded),'
      ' so that the likelihood has no maximum.'
    ]
  terms = [f'{slope:+.3g} {n}/{_UNITS[n]}' for n, slope in fit.slopes.items()]
  return [
    f'{head}logistic fit, maximum likelihood: logit p ='
    f' {fit.intercept:.3g} {" ".join(terms)}',
    *(f'  {_edge(fit, name, varying)}' for name in varying),
  ]


def _edge(
  fit: logistic.Fit, name: str, values: Mapping[str, np.ndarray]
) -> str:
  """Where success crosses 90 % as one predictor varies, in words."""
  # Both are values that were flown: the front view, the middle distance.
  shares = {'angle': 0.0, 'distance': 0.5}
  others = {
    n: float(np.quantile(v, shares[n], method='lower'))
    for n, v in values.items()
    if n != name
  }
  at = ''.join(f' at {n} {v:g} {_UNITS[n]}' for n, v in others.items())
  edge, tested = fit.crossing(name, others, LEVEL), values[name]
  unit = _UNITS[name]
  if not tested.min() <= edge <= tested.max():
    return (
      f'{name}: success does not cross 90 % between {tested.min():g} and'
      f' {tested.max():g} {unit}{at}'
    )
  side = 'beyond' if fit.slopes[name] < 0 else 'under'
  return f'{name}: success falls below 90 % {side} {edge:.3g} {unit}{at}'
