"""Claims about conversations."""

from waggle_tasks.experiments.claim_parts import kinds

CLAIMS = {
  'converse': kinds.Claim(
    'converse', kinds.UNCHECKED, detail='a test holds such a conversation'
  ),
  'converse-dropped': kinds.Claim(
    'converse-dropped', kinds.TEXT,
    ('converse', '--times=3', '--tries=8', '--dropped_share=0.3'),
  ),
  'converse-five': kinds.Claim(
    'converse-five', kinds.TEXT,
    ('converse', '--times=4', '--listeners=5', '--seed=10'),
  ),
  'converse-hidden': kinds.Claim(
    'converse-hidden', kinds.UNCHECKED, detail='each takes minutes'
  ),
  'converse-relay': kinds.Claim(
    'converse-relay', kinds.TEXT, ('converse', '--mission=relay', '--times=1')
  ),
  'converse-dancers': kinds.Claim(
    'converse-dancers', kinds.UNCHECKED, detail='a slow test holds another one'
  ),
  'converse-rules': kinds.Claim(
    'converse-rules', kinds.TEXT,
    ('converse', '--times=1000', '--loss=0.3', '--tries=12'),
  ),
  'converse-blind': kinds.Claim(
    'converse-blind', kinds.TEXT,
    ('converse', '--blind', '--tries=7', '--times=1000', '--loss=0.3'),
  ),
}  # fmt: skip
