"""What is drawn anew at each reset: fields of the scenario by a generator."""

from collections.abc import Callable, Mapping

import numpy as np

from waggle_tasks import scenario

# From a generator and the scenario as it is asked for: fields and new values.
Draw = Callable[[np.random.Generator, scenario.Scenario], Mapping[str, object]]


def payload(
  rng: np.random.Generator, scene: scenario.Scenario
) -> Mapping[str, object]:
  """Any payload that leads somewhere, each as likely: waiting earns nothing."""
  units = scene.units
  value = rng.integers(2 ** (1 + units.heading_bits))
  distance = rng.integers(1, 2**units.distance_bits)
  heading = f'{value:0{1 + units.heading_bits}b}'
  return {'payload': f'{heading}{distance:0{units.distance_bits}b}'}


def place_and_payload(
  rng: np.random.Generator, scene: scenario.Scenario
) -> Mapping[str, object]:
  """The same, from 1 to 1.6 m, from 45 degrees to either side."""
  return {
    **payload(rng, scene),
    'distance_m': float(rng.uniform(1.0, 1.6)),
    'bearing_deg': float(rng.uniform(-45.0, 45.0)),
  }


def nothing(
  rng: np.random.Generator, scene: scenario.Scenario
) -> Mapping[str, object]:
  """The scenario as it is; only its seed is drawn."""
  del rng, scene
  return {}


DRAWS: Mapping[str, Draw] = {
  'payload': payload,
  'place_and_payload': place_and_payload,
  'nothing': nothing,
}
