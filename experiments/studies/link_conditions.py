"""Conditions of a link by name: what disturbs it."""

from collections.abc import Mapping
import dataclasses
from typing import Any


@dataclasses.dataclass(frozen=True)
class Condition:
  """What disturbs a broadcast.

  Attributes:
    text: What it is, for people.
    values: What it changes in a scenario, see `scenario_fields`.
    drawn: What each broadcast draws for itself, evenly from 0 to this, s.
  """

  text: str
  values: Mapping[str, Any] = dataclasses.field(default_factory=dict)
  drawn: Mapping[str, float] = dataclasses.field(default_factory=dict)


def _hover(name: str) -> dict[str, Any]:
  return {'performer_hover': name, 'observer_hover': name}


def _wind(speed_mps: float) -> dict[str, Any]:
  return {'dynamics': 'rotors', 'wind_mps': speed_mps, 'gusts': True}


CONDITIONS = {
  'calm': Condition('nothing'),
  'noise': Condition('noise of 10 grey levels', {'noise_sigma': 10.0}),
  'mocap': Condition('all hover as under motion capture', _hover('mocap')),
  'lighthouse': Condition('all hover as with Lighthouse', _hover('lighthouse')),
  'drop30': Condition('30 % of images do not come', {'dropped_share': 0.3}),
  'blackouts': Condition(
    'black for 2 s of every 10 s',
    {'blackout_length_s': 2.0, 'blackout_every_s': 10.0},
    {'blackout_s': 10.0},
  ),
  'board': Condition('a board passes every 5 s', {'occluder_every_s': 5.0}),
  'bystanders': Condition('two more vehicles fly', {'bystanders': 2}),
  'sun': Condition('the sun moves', {'sun': 'moving'}),
  'rotors': Condition('four rotors, calm air', {'dynamics': 'rotors'}),
  'gusts1': Condition('four rotors, 1 m/s with gusts', _wind(1.0)),
  'gusts2': Condition('four rotors, 2 m/s with gusts', _wind(2.0)),
}
