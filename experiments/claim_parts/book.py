"""Every claim as data: what is flown for it, and how that is compared.

What documents say is not repeated here: it is read from them. Each command is
a small part of the one that stands above the table.
"""

from typing import Any

from waggle_tasks.experiments.claim_parts import (
  colony_claims,
  eye_claims,
  kinds,
  link_claims,
  sensing_claims,
  talk_claims,
  time_claims,
)

_DECOYS: dict[str, Any] = {
  'control': 'circles,diagonals,random_walk,navigation,swapped,repeated,'
  'half_frame'
}  # fmt: skip
_FEW_DECOYS: dict[str, Any] = {'control': 'random_walk,repeated,half_frame'}
_FAST = (
  '--half_width_m=0.12', '--start_height_m=0.25', '--gesture_s=2',
  '--initial_hover_s=3.2', '--settle_s=0.6', '--gap_s=2', '--lead_in_s=1.8',
)  # fmt: skip
_BARE = 'separators=off,final_null=off'


def _sweep(
  block: str,
  repeats: int,
  *flags: str,
  receiver: str = 'view_bank',
  observers: int = 5,
  how: str = kinds.CELLS,
  table: int | None = None,
  **grid: str,
) -> kinds.Claim:
  """Some cells of a sweep of random payloads."""
  command = (
    'sweep', f'--receiver={receiver}', '--payload=random',
    f'--observers={observers}', f'--repeats={repeats}', *flags,
    *(f'--grid={name}={values}' for name, values in grid.items()),
  )  # fmt: skip
  return kinds.Claim(block, how, command, table)


def _hidden(receiver: str) -> kinds.Claim:
  return _sweep(
    f'hidden-{receiver}', 1, '--replays=4', *_FAST, receiver=receiver,
    observers=1, how=kinds.PART, control='seven_bits,begun_anew,run_together',
    distance_m='1.3',
  )  # fmt: skip


def _disturbed(*flags: str, **grid: str) -> kinds.Claim:
  values: dict[str, Any] = grid  # None of the names of other arguments.
  return _sweep(
    'disturbances', 1, *flags, observers=2, how=kinds.PART, **values
  )


_SWAY = '--observer_drift_m=0.002', '--observer_yaw_drift_deg=0.1'

CLAIMS = {
  'main-job': kinds.Claim('main-job', kinds.TEXT, ('broadcast',)),
  'main-totals': kinds.Claim('main-totals', kinds.COPY, detail='paper'),
  'map-far-aside': _sweep(
    'map', 5, observers=1, noise_sigma='10', distance_m='3.0', bearing_deg='75'
  ),
  'map-near': _sweep(
    'map', 5, observers=1, noise_sigma='0', distance_m='0.6', bearing_deg='0'
  ),
  'noisy': _sweep(
    'noisy', 5, observers=1, noise_sigma='20', distance_m='1.6',
    bearing_deg='45',
  ),
  'far': _sweep(
    'far', 3, observers=1, noise_sigma='10', distance_m='4.0', bearing_deg='45'
  ),
  'grazing': _sweep(
    'grazing', 3, observers=1, noise_sigma='0', distance_m='2.5',
    bearing_deg='85',
  ),
  'klt-map': _sweep(
    'klt-map', 3, receiver='klt', observers=1, distance_m='1.3,2.0',
    bearing_deg='45',
  ),
  'payloads': kinds.Claim(
    'payloads', kinds.PART,
    ('sweep', '--receiver=view_bank', '--grid=payload=010101,111111'),
  ),
  'sway-default': kinds.Claim(
    'sway-default', kinds.PART,
    (
      'sweep', '--receiver=view_bank', '--repeats=1', '--observers=1',
      '--grid=observer_drift_m=0.002', '--grid=observer_yaw_drift_deg=0.1',
    ),
  ),
  # Pictures of a camera that sways are drawn whole, which takes long.
  'sway-more': _sweep(
    'sway', 1, '--observer_yaw_drift_deg=0.3', observers=1, how=kinds.PART,
    observer_drift_m='0.005',
  ),
  'sway-noise': _sweep(
    'sway', 1, *_SWAY, observers=1, how=kinds.PART, noise_sigma='10'
  ),
  'sway-dancer': _sweep(
    'sway', 1, how=kinds.PART, performer_drift_m='0.002'
  ),
  'hover': kinds.Claim('hover', kinds.TEXT, ('drift',)),
  'crossings': kinds.Claim(
    'crossings', kinds.UNCHECKED, detail='a thousand crossings take 13 minutes'
  ),
  'languages': kinds.Claim('languages', kinds.TEXT, ('languages',)),
  'gentle': _sweep(
    'gentle', 1, '--language=gentle', '--dynamics=rotors', receiver='joint',
    observers=1, distance_m='3.0', bearing_deg='75',
  ),
  'hover-dancer': _sweep(
    'hover-dancer', 2, '--performer_hover=mocap', observers=1,
    distance_m='1.6', bearing_deg='45',
  ),
  'hover-both': _sweep(
    'hover-both', 1, '--performer_hover=mocap', '--observer_hover=mocap',
    observers=1, distance_m='1.6', bearing_deg='0',
  ),
  'hover-observers': _sweep(
    'hover-observers', 1, '--observer_hover=mocap', observers=1,
    distance_m='1.3', bearing_deg='0',
  ),
  'clutter': _sweep('clutter', 2, '--floor=clutter', table=0, walls='clutter'),
  'clutter-sway': _sweep(
    'clutter', 1, '--floor=clutter', *_SWAY, observers=1, how=kinds.PART,
    walls='clutter',
  ),
  'blackout': _sweep(
    'disturbances', 2, '--blackout_length_s=2', table=0, blackout_s='60'
  ),
  'brightness': _disturbed('--shadows', brightness='1.5'),
  'bystanders': _disturbed(bystanders='2'),
  'dropped': _disturbed(dropped_share='0.3'),
  'exposure': _disturbed(exposure_s='0.04'),
  'flicker': _disturbed(flicker_share='0.2'),
  'freeze': _disturbed('--freeze_length_s=6', freeze_s='93'),
  'jitter': _disturbed(jitter_m='0.03'),
  'late': _disturbed(late_frames='25'),
  'occluder': _disturbed(occluder_every_s='20'),
  'blackout-part': _sweep(
    'disturbances', 2, '--blackout_length_s=2', '--blackout_share=0.4',
    table=10, blackout_s='30',
  ),
  'photons': _disturbed(photons='100'),
  'repeated': _disturbed(repeated_share='0.3'),
  'step': _disturbed('--step_s=40', step_gain='2'),
  'sun': _disturbed(sun='moving'),
  'decoys': _sweep('decoys', 1, how=kinds.PART, **_DECOYS),
  'decoys-wide': _sweep(
    'decoys-wide', 1, '--distance_m=1.0', '--half_span_deg=75', how=kinds.PART,
    **_FEW_DECOYS,
  ),
  'decoys-noise': _sweep(
    'decoys-noise', 1, '--noise_sigma=10', how=kinds.PART, **_FEW_DECOYS
  ),
  # Of the receiver that it speaks of: the tables of others are left out.
  'together': kinds.Claim(
    'together', kinds.SUM,
    detail='klt-map klt view_bank:max_repeated=1 distinct hidden-klt'
    ' hidden-view_bank last-rest',
  ),
  'distinct': kinds.Claim(
    'distinct', kinds.UNCHECKED, detail='arithmetic of the counts told above it'
  ),
  'living-cameras': kinds.Claim(
    'living-cameras', kinds.UNCHECKED, detail='of an older test of life'
  ),
  'hidden-klt': _hidden('klt'),
  'hidden-view_bank': _hidden('view_bank'),
  'frozen': _sweep(
    'last-rest', 2, '--freeze_length_s=600', observers=3, table=1,
    freeze_s='94', noise_sigma='5',
  ),
  'frozen-klt': _sweep(
    'last-rest', 2, '--freeze_length_s=600', observers=3, table=0,
    receiver='klt', freeze_s='93', noise_sigma='0',
  ),
  'paper': kinds.Claim(
    'paper', kinds.ROWS,
    (
      'suite', '--case=one-observer,two-observers,distance-1-0,span-45,'
      'four-forward,no-send,black-input',
    ),
  ),
  'paper-view-bank': kinds.Claim(
    'paper-view-bank', kinds.ROWS,
    (
      'suite', '--receiver=view_bank',
      '--case=one-observer,distance-1-0,span-45',
    ),
  ),
  'sensitivity': kinds.Claim(
    'sensitivity', kinds.PART,
    (
      'sensitivity', '--variant=start-low,eye-back,jitter-3',
      '--case=distance-1-0',
    ),
  ),
  'ablations': kinds.Claim(
    'ablations', kinds.PART, ('ablate', '--case=one-observer,distance-1-0')
  ),
  'ablations-decoys': _sweep(
    'ablations-decoys', 1, receiver=f'view_bank:{_BARE}', how=kinds.PART,
    control='half_frame',
  ),
  'ablations-decoys-klt': _sweep(
    'ablations-decoys', 1, receiver=f'klt:{_BARE},forward_backward=off',
    how=kinds.PART, control='half_frame',
  ),
  'boundary': kinds.Claim(
    'boundary', kinds.TEXT, ('boundary', '--half_span_deg=45')
  ),
  'event-logs': kinds.Claim(
    'event-logs', kinds.ROWS, ('bench', '--check_events', '--suite=controls')
  ),
  **colony_claims.CLAIMS,
  **eye_claims.CLAIMS,
  **link_claims.CLAIMS,
  **sensing_claims.CLAIMS,
  **talk_claims.CLAIMS,
  **time_claims.CLAIMS,
}  # fmt: skip

_RIGHT = r'^right: (\d+)/(\d+) exposures'
SENTENCES = {
  'readme-map': kinds.Sentence(
    'README.md', r'read (\S+) of the (\S+) messages of this map',
    ('map', 'noisy', 'far', 'grazing'), _RIGHT,
  ),
  'readme-klt': kinds.Sentence(
    'README.md', r'`klt` read (\S+) of (\d+)', ('klt-map',), _RIGHT
  ),
  'readme-exposures': kinds.Sentence(
    'README.md', r'In all of (\S+) exposures', ('together',),
    r'^right: \d+/(\d+) ',
  ),
  'readme-limit': kinds.Sentence(
    'README.md', r'at most (\S+) %, with 95 % confidence', ('distinct',),
    r'^(\S+)%$',
  ),
  'readme-view-bank': kinds.Sentence(
    'README.md', r'reads (\d+)/(\d+) and passes', ('paper-view-bank',),
    r'^messages correct: (\d+)/(\d+) ',
  ),
  'readme-groups': kinds.Sentence(
    'README.md', r'and passes (\d+)/(\d+) from', ('paper-view-bank',),
    r'^broadcasts passed: (\d+)/(\d+) ',
  ),
}  # fmt: skip
