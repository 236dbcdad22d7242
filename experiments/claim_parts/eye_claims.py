"""Claims of docs/cameras.md, see `book`."""

from waggle_tasks.experiments.claim_parts import kinds

CLAIMS = {
  'eyes': kinds.Claim(
    'eyes', kinds.CELLS,
    (
      'sweep', '--receiver=joint', '--language=swift', '--observers=1',
      '--payload=random', '--duration_s=7.5', '--repeats=3',
      '--grid=eye=ai_deck',
    ),
  ),
  'eye-costs': kinds.Claim(
    'eye-costs', kinds.UNCHECKED, detail='times, which differ between runs'
  ),
}  # fmt: skip
