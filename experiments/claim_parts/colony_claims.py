"""Claims about levels of fidelity and about swarms, as data; see `book`."""

from waggle_tasks.experiments.claim_parts import kinds


def _swarms(block: str, *flags: str) -> kinds.Claim:
  """Some cases of a colony."""
  command = 'colony', '--conditions=perfect,blackouts', *flags
  return kinds.Claim(block, kinds.ROWS, command)


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
      '--grid=distance_m=0.6,2', '--grid=dropped_share=0,0.3',
    ),
  ),
  'hostile-tracks-brisk': kinds.Claim(
    'hostile-tracks-brisk', kinds.UNCHECKED,
    detail='five thousand tracks take a quarter of an hour',
  ),
  'nest-choice': _swarms(
    'nest-choice', '--vehicles=10', '--ratios=0.5,0.9'
  ),
  'nest-noise': _swarms(
    'nest-noise', '--vehicles=100', '--ratios=0.8', '--noises=0,1'
  ),
  'nest-list': _swarms(
    'nest-list', '--model=list', '--value=10', '--vehicles=10',
    '--ratios=0.5,0.9',
  ),
}  # fmt: skip
