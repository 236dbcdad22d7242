"""Claims of messages in seconds, and of what hides parts; see `book`."""

from waggle_tasks.experiments.claim_parts import kinds

_SWEEP = (
  'sweep', '--language=swift', '--observers=1', '--payload=random',
)  # fmt: skip

CLAIMS = {
  'link-map': kinds.Claim(
    'link-map', kinds.CELLS,
    (
      *_SWEEP, '--repeats=5', '--grid=noise_sigma=10', '--grid=distance_m=3.0',
      '--grid=bearing_deg=0,75',
    ),
  ),
  'link-hidden': kinds.Claim(
    'link-hidden', kinds.PART,
    (
      *_SWEEP, '--repeats=1', '--replays=10',
      '--grid=control=seven_bits,begun_anew,run_together',
      '--grid=distance_m=1.3',
    ),
  ),
  'link': kinds.Claim(
    'link', kinds.ROWS,
    (
      'link', '--schemes=swift,swift x3', '--conditions=calm,blackouts',
      '--broadcasts=4',
    ),
  ),
  'link-bears': kinds.Claim(
    'link-bears', kinds.ROWS,
    (
      'link', '--schemes=swift x3', '--conditions=mocap,bystanders',
      '--broadcasts=6',
    ),
  ),
  'link-long': kinds.Claim(
    'link-long', kinds.UNCHECKED, detail='fifty messages of half a minute'
  ),
  'link-hover': kinds.Claim(
    'link-hover', kinds.ROWS,
    ('link', '--schemes=swift', '--conditions=rotors', '--broadcasts=20'),
  ),
  'link-paper': kinds.Claim(
    'link-paper', kinds.ROWS,
    (
      'link', '--schemes=paper', '--conditions=mocap',
      '--broadcasts=2',
    ),
  ),
  'link-places': kinds.Claim(
    'link-places', kinds.ROWS,
    (
      'link', '--schemes=swift', '--conditions=calm,noise', '--broadcasts=1',
      '--distances=0.6,1.3,3', '--bearings=0,60',
    ),
  ),
  'link-codes': kinds.Claim(
    'link-codes', kinds.UNCHECKED, detail='ten million messages take minutes'
  ),
}  # fmt: skip
