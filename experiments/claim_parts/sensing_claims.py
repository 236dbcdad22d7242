"""Claims of receivers beside each other, as those of `book`."""

from waggle_tasks.experiments.claim_parts import kinds

_SWEEP = (
  'sweep', '--language=swift', '--observers=1', '--payload=random',
  '--repeats=1',
)  # fmt: skip
_GRID = '--bearing_deg=30', '--grid=distance_m=2.5', '--grid=noise_sigma=0'

CLAIMS = {
  'anywhere': kinds.Claim(
    'anywhere',
    kinds.CELLS,
    (
      *_SWEEP[:-1],
      '--repeats=2',
      '--receiver=seeker',
      '--grid=aside_deg=-20',
      '--grid=above_m=-0.5,0',
    ),
  ),
  **{
    f'eyes-{name}': kinds.Claim(
      f'eyes-{name}', kinds.CELLS, (*_SWEEP, f'--receiver={name}', *_GRID)
    )
    for name in ('joint', 'learned', 'events')
  },
  **{
    f'eyes-hidden-{name}': kinds.Claim(
      f'eyes-hidden-{name}',
      kinds.PART,
      (
        *_SWEEP,
        f'--receiver={name}',
        f'--replays={replays}',
        '--grid=control=seven_bits',
      ),
    )
    for name, replays in (('learned', 6), ('events', 3))
  },
  'trained': kinds.Claim(
    'trained', kinds.UNCHECKED, detail='training takes half a minute of a core'
  ),
  'eyes-paper': kinds.Claim(
    'eyes-paper', kinds.UNCHECKED, detail='of one dance, which all of them read'
  ),
  'eyes-cost': kinds.Claim(
    'eyes-cost', kinds.UNCHECKED, detail='times, which differ between runs'
  ),
}
