"""Claims about levels of fidelity and about swarms, as data; see `book`."""

from waggle_tasks.experiments.claim_parts import kinds

CLAIMS = {
  'ladder': kinds.Claim('ladder', kinds.TEXT, ('ladder',)),
  'ladder-agreement': kinds.Claim(
    'ladder-agreement', kinds.UNCHECKED,
    detail='a hundred renderings take half an hour',
  ),
  'hostile-tracks': kinds.Claim(
    'hostile-tracks', kinds.PART,
    (
      'sweep', '--fidelity=tracks', '--receiver=joint', '--language=swift',
      '--observers=1', '--payload=random', '--repeats=2',
      '--grid=control=swapped,half_frame,seven_bits',
      '--grid=distance_m=0.6,2', '--grid=dropped_share=0.3',
    ),
  ),
  'nest-choice': kinds.Claim(
    'nest-choice', kinds.ROWS,
    ('colony', '--vehicles=10', '--ratios=0.5,0.9'),
  ),
}  # fmt: skip
