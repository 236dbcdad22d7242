"""The broadcasts of a link: schemes by conditions by places."""

from collections.abc import Sequence
import dataclasses
import itertools
from typing import Any

import numpy as np

from waggle_tasks import errors
from waggle_tasks import fidelity as fidelity_lib
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.studies import (
  link_conditions,
  link_schemes,
  sweep_cases,
)
from waggle_tasks.protocol import checks

SCHEME, CONDITION = 'scheme', 'condition'
_MOST = 100_000


@dataclasses.dataclass(frozen=True)
class Plan:
  """What is to be flown.

  Attributes:
    schemes: Ways to send a message.
    conditions: Names of `link_conditions.CONDITIONS`.
    distances_m: Where observers stand...
    bearings_deg: ...and at which angles to the dance.
    broadcasts: How many messages are sent in each cell.
    observers: How many observers each of them has.
    bits: What is sent in place of a payload: characters of 0 and 1, or
      'random:64' for as many that each message draws; empty for payloads.
    fidelity: How much of each broadcast is made, see `Scenario.fidelity`.
  """

  schemes: Sequence[link_schemes.Scheme]
  conditions: Sequence[str]
  distances_m: Sequence[float]
  bearings_deg: Sequence[float]
  broadcasts: int
  observers: int
  bits: str = ''
  fidelity: str = fidelity_lib.PIXELS

  def __post_init__(self) -> None:
    for field in ('conditions', 'distances_m', 'bearings_deg'):
      link_schemes.once(field.rpartition('_')[0] or field, getattr(self, field))
    for name in self.conditions:
      checks.choice(
        'conditions', name, [*link_conditions.CONDITIONS],
        link_schemes.SchemeError,
      )  # fmt: skip
    checks.integer(
      'broadcasts', self.broadcasts, 1, _MOST, link_schemes.SchemeError
    )


def cases(plan: Plan) -> tuple[list[sweep_cases.Sample], list[str]]:
  """Every case of a plan, and what of it cannot be flown, with the reason.

  A cell whose scenario breaks a rule, such as gestures that four rotors cannot
  fly, is left out.

  Raises:
    WaggleError: if nothing can be flown.
  """
  out: list[sweep_cases.Sample] = []
  refused: list[str] = []  # Most reasons are those of all places.
  cells = itertools.product(
    plan.schemes, plan.conditions, plan.distances_m, plan.bearings_deg
  )
  for scheme, condition, distance_m, bearing_deg in cells:
    cell = {
      SCHEME: scheme.name, CONDITION: condition, 'distance_m': distance_m,
      'bearing_deg': bearing_deg,
    }  # fmt: skip
    try:
      out += [
        sample
        for number in range(plan.broadcasts)
        for sample in _message(scheme, cell, number, plan)
      ]
    except errors.WaggleError as error:
      refused.append(f'{scheme.name}, {condition}: {error}')
  if not out:
    raise link_schemes.SchemeError(f'nothing can be flown: {refused[0]}')
  return out, [*dict.fromkeys(refused)]


def _message(
  scheme: link_schemes.Scheme,
  cell: dict[str, Any],
  number: int,
  plan: Plan,
) -> list[sweep_cases.Sample]:
  """One message: as many broadcasts as the scheme sends it in."""
  condition = link_conditions.CONDITIONS[cell[CONDITION]]
  base = {
    **scenario_fields.defaults(), **scheme.values, **condition.values,
    'distance_m': cell['distance_m'], 'bearing_deg': cell['bearing_deg'],
    'observers': plan.observers, 'payload': sweep_cases.RANDOM,
    'bits': plan.bits, 'fidelity': plan.fidelity,
  }  # fmt: skip
  samples = [sweep_cases.draw({}, base | _drawn(condition, number), number)]
  if scheme.sendings > 1:  # The same payload, and seeds that follow from one.
    base |= {name: samples[0].values[name] for name in ('payload', 'seed')}
    samples = [
      sweep_cases.draw({}, base | _drawn(condition, number, sending), sending)
      for sending in range(scheme.sendings)
    ]
  return [
    dataclasses.replace(
      sample,
      cell=cell,
      repeat=number * scheme.sendings + sending,
      receiver=scheme.receiver,
    )
    for sending, sample in enumerate(samples)
  ]


def _drawn(
  condition: link_conditions.Condition, *numbers: int
) -> dict[str, float]:
  """What one broadcast draws of a condition: the same for every scheme."""
  rng = np.random.default_rng(numbers)
  return {
    name: round(float(rng.uniform(0.0, most)), 2)
    for name, most in condition.drawn.items()
  }
