"""Claims that differ from run to run, such as times; see `book`."""

from waggle_tasks.experiments.claim_parts import kinds

_WHY = {
  'symbols': 'takes minutes',
  'timings': 'times and memory, which differ between runs',
  'learners': 'times, which differ between runs',
  'dance': 'what is learned differs a little between kinds of processors',
  'learned-reading': 'what is learned differs a little between processors',
  'board': 'its times are those of one machine',
  'pictures': 'a test compares pictures with every run',
}
CLAIMS = {
  name: kinds.Claim(name, kinds.UNCHECKED, detail=why)
  for name, why in _WHY.items()
}
