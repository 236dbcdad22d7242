"""The documents' own programs, run as they stand."""

import contextlib
import io
import json
import pathlib
import re

import pytest

DOCS = pathlib.Path(__file__).parents[1] / 'docs'


def run(program: str, namespace: dict[str, object]) -> str:
  """What a program prints."""
  out = io.StringIO()
  with contextlib.redirect_stdout(out):
    exec(compile(program, 'document', 'exec'), namespace)
  return out.getvalue()


def test_every_page_can_be_reached_from_the_first_one() -> None:
  index = (DOCS / 'index.md').read_text('utf-8')
  trees = re.findall(r'```{toctree}\n(.*?)```', index, re.DOTALL)
  listed = {line for tree in trees for line in tree.splitlines() if line}
  pages = {
    path.relative_to(DOCS).with_suffix('').as_posix()
    for kind in ('md', 'ipynb')
    for path in DOCS.rglob(f'*.{kind}')
  }
  assert {p for p in listed if not p.startswith(':')} == pages - {'index'}


def test_the_program_of_the_tutorial_reads_its_message() -> None:
  text = (DOCS / 'tutorial.md').read_text('utf-8')
  (program,) = re.findall(r'```python\n(.*?)```', text, re.DOTALL)
  assert run(program, {}) == (
    'observer_1 read 100010\nobserver_2 read 100010\n'
  )


@pytest.mark.slow
@pytest.mark.parametrize(
  'name',
  [
    'first_broadcast',
    pytest.param('compare_receivers', marks=pytest.mark.long),
  ],
)
def test_a_notebook_prints_what_it_shows(
  name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setenv('MPLBACKEND', 'agg')
  path = DOCS / 'notebooks' / f'{name}.ipynb'
  cells = json.loads(path.read_text('utf-8'))['cells']
  namespace: dict[str, object] = {}
  shown, printed = [], []
  for cell in cells:
    if cell['cell_type'] == 'code':
      printed.append(run(''.join(cell['source']), namespace))
      texts = [each.get('text', []) for each in cell['outputs']]
      shown.append(''.join(line for text in texts for line in text))
  assert printed == shown
  assert any(printed)
