"""Tiers of the board: frozen suites of scenes, as values.

A scene is what it changes in a scenario of one observer, see `scenario_fields`.
Its seed and its payload are drawn, see `board_cases`. What is changed here
makes another suite: then `VERSION` is raised, and boards of both are not
merged.
"""

from collections.abc import Mapping
import dataclasses
from typing import Any

from waggle_tasks import errors, scenario

VERSION = 1
LANGUAGES = PAPER, SWIFT, GENTLE = scenario.PAPER, 'swift', 'gentle'
RECORDINGS = 'recordings'


class BoardError(errors.WaggleError):
  """A board that cannot be flown, or boards that do not go together."""


@dataclasses.dataclass(frozen=True)
class Scene:
  """One scene of a tier.

  Attributes:
    name: Its own in the tier.
    values: What it changes in a scenario.
    languages: In which languages it is danced.
  """

  name: str
  values: Mapping[str, Any]
  languages: tuple[str, ...] = (PAPER, SWIFT)


@dataclasses.dataclass(frozen=True)
class Tier:
  """A suite of scenes that have something in common.

  Attributes:
    text: What it asks of a receiver, for people.
    scenes: Its scenes.
    shown: Names of those that its picture shows.
    jitter_m: How far vehicles are from their places, along each axis.
  """

  text: str
  scenes: tuple[Scene, ...]
  shown: tuple[str, ...]
  jitter_m: float = 0.03  # So that the dancer is not in the middle.


# In the paper's language the first hover is drawn, so that nobody learns when a
# dance begins; other languages have theirs.
HOVER_S = 4.0, 7.0
# How often a scene is danced in each language: a dance of the paper's takes
# fifteen times as long.
BROADCASTS = {PAPER: 1, SWIFT: 3, GENTLE: 1}

# Cameras by name; what is added here joins the tier.
CAMERAS: Mapping[str, Mapping[str, Any]] = {
  'small': {'camera_width_px': 320, 'camera_height_px': 240},
  'large': {'camera_width_px': 1280, 'camera_height_px': 720},
  'wide': {'camera_fovy_deg': 90.0},
  'narrow, 2 m': {'camera_fovy_deg': 45.0, 'distance_m': 2.0},
  '31 Hz': {'rate_hz': 31.25},
  '50 Hz': {'rate_hz': 50.0},
  'noise': {'noise_sigma': 10.0},
  'few photons': {'photons': 200.0},
  'exposure': {'exposure_s': 0.03},
  'flicker': {'flicker_share': 0.1, 'flicker_hz': 48.0},
  'light doubled': {'step_gain': 2.0, 'step_s': 5.0},
  'images lost': {'dropped_share': 0.3},
  'images repeated': {'repeated_share': 0.2},
  'images late': {'late_frames': 5},
  'black-outs': {
    'blackout_s': 3.0, 'blackout_length_s': 1.0, 'blackout_every_s': 6.0,
  },
}  # fmt: skip


def _rotors(**values: object) -> dict[str, Any]:
  return {'dynamics': 'rotors', **values}


_FLOWN = PAPER, GENTLE  # What four rotors can fly.
_MOCAP = {'performer_hover': 'mocap', 'observer_hover': 'mocap'}

TIERS: Mapping[str, Tier] = {
  'paper': Tier(
    'the places of the paper: what every receiver should read',
    (
      Scene('one observer', {}),
      Scene('three observers', {'observers': 3}),
      Scene('five, to 40 degrees', {'observers': 5, 'half_span_deg': 40.0}),
      Scene('1.0 m', {'observers': 3, 'distance_m': 1.0}),
      Scene('1.6 m', {'observers': 3, 'distance_m': 1.6}),
      Scene('line', {'observers': 3, 'layout': 'line'}),
      Scene('jitter', {'observers': 3, 'jitter_m': 0.01}),
      Scene('no dance', {'control': 'no_send'}),
      Scene('broken off', {'control': 'interrupted'}, (PAPER,)),
      Scene(
        'broken off', {'control': 'interrupted', 'stop_s': 4.0,
        'duration_s': 20.0}, (SWIFT,),
      ),
      Scene('a symbol too many', {'control': 'seven_bits'}),
    ),
    ('one observer', 'five, to 40 degrees', '1.6 m', 'line'),
    jitter_m=0.0,
  ),
  'envelope': Tier(
    'near and far, from the front and from the side, in calm and in noise',
    (
      Scene('0.6 m', {'distance_m': 0.6}),
      Scene('0.6 m, 60 degrees', {'distance_m': 0.6, 'bearing_deg': 60.0}),
      Scene('1.3 m, 45 degrees', {'bearing_deg': 45.0}),
      Scene('1.3 m, -75 degrees', {'bearing_deg': -75.0}),
      Scene('2 m, 30 degrees', {'distance_m': 2.0, 'bearing_deg': 30.0}),
      Scene('2 m, noise', {'distance_m': 2.0, 'noise_sigma': 10.0}),
      Scene('3 m', {'distance_m': 3.0}),
      Scene('3 m, -60 degrees', {'distance_m': 3.0, 'bearing_deg': -60.0}),
      Scene(
        '1.3 m, 30 degrees, noise', {'bearing_deg': 30.0, 'noise_sigma': 20.0}
      ),
      Scene('half of two messages', {'control': 'half_frame'}),
      Scene(
        'begun anew, 2 m', {'control': 'begun_anew', 'distance_m': 2.0}
      ),
    ),
    ('0.6 m', '1.3 m, -75 degrees', '2 m, noise', '3 m'),
  ),
  'camera': Tier(
    'other cameras than the paper\'s, and what spoils their images',
    (
      *(Scene(name, values) for name, values in CAMERAS.items()),
      Scene(
        'a symbol too few, images lost',
        {'control': 'five_bits', 'dropped_share': 0.3},
      ),
      Scene(
        'two dances, black-outs',
        {'control': 'run_together', **CAMERAS['black-outs']},
      ),
    ),
    ('small', 'wide', 'few photons', 'narrow, 2 m'),
  ),
  'room': Tier(
    'rooms full of things, sunlight and shadows',
    (
      Scene('cluttered floor', {'floor': 'clutter'}),
      Scene('cluttered walls', {'walls': 'clutter'}),
      Scene(
        'cluttered walls, all sway', {'walls': 'clutter', **_MOCAP}
      ),
      Scene('sun', {'sun': 'fixed'}),
      Scene('moving sun', {'sun': 'moving'}),
      Scene('dim', {'brightness': 0.4}),
      Scene('furniture', {'furniture': 1}),
      Scene('more furniture, 2 m', {'furniture': 2, 'distance_m': 2.0}),
      Scene(
        'furniture, from the side', {'furniture': 3, 'bearing_deg': -40.0}
      ),
      Scene('furniture, all sway', {'furniture': 4, **_MOCAP}),
      Scene('end first, furniture', {'control': 'end_first', 'furniture': 5}),
    ),
    (
      'cluttered walls', 'moving sun', 'furniture', 'furniture, from the side',
    ),
  ),
  'motion': Tier(
    'vehicles that hover and fly as real ones do',
    (
      Scene('the dancer sways, mocap', {'performer_hover': 'mocap'}),
      Scene(
        'the observer sways, lighthouse', {'observer_hover': 'lighthouse'}
      ),
      Scene('the observer sways, mocap', {'observer_hover': 'mocap'}),
      Scene('all sway, mocap', _MOCAP),
      Scene(
        'all sway, flow deck',
        {'performer_hover': 'flow_deck', 'observer_hover': 'flow_deck'},
      ),
      Scene('rotors', _rotors(), _FLOWN),
      Scene('rotors, mocap', _rotors(estimator='mocap'), _FLOWN),
      Scene('rotors, lighthouse', _rotors(estimator='lighthouse'), _FLOWN),
      Scene('rotors, flow deck', _rotors(estimator='flow_deck'), _FLOWN),
      Scene('rotors, gusts', _rotors(wind_mps=1.0, gusts=True), _FLOWN),
      Scene('a walk, all sway', {'control': 'random_walk', **_MOCAP}),
    ),
    ('the observer sways, mocap', 'rotors, gusts'),
  ),
  'crowd': Tier(
    'others fly behind the dancer, and a board passes before it',
    (
      Scene('one bystander', {'bystanders': 1}),
      Scene('two bystanders', {'bystanders': 2}),
      Scene('four bystanders', {'bystanders': 4}),
      Scene('a board passes', {'occluder_every_s': 5.0}),
      Scene(
        'a wide board passes',
        {'occluder_every_s': 8.0, 'occluder_width_m': 0.4},
      ),
      Scene('bystanders, a board', {'bystanders': 2, 'occluder_every_s': 8.0}),
      Scene(
        'bystanders, from the side', {'bystanders': 2, 'bearing_deg': 40.0}
      ),
      Scene(
        'no dance, four bystanders', {'control': 'no_send', 'bystanders': 4}
      ),
      Scene(
        'a symbol too many, a board',
        {'control': 'seven_bits', 'occluder_every_s': 5.0},
      ),
    ),
    ('two bystanders', 'four bystanders', 'a wide board passes'),
  ),
  # The films' own values are in `video.board_films`.
  RECORDINGS: Tier(
    'films of a dance, encoded and decoded again',
    tuple(
      Scene(name, {})
      for name in (
        'vp8', 'vp8, large', 'h264', 'h264, small', 'h264, 30 Hz',
        'h264, 15 Hz', 'h264, grey', 'h264, bright',
      )
    ),
    ('h264, small', 'h264, bright'),
  ),
}  # fmt: skip
