"""`waggle claims`: what documents say, and what is found to be otherwise."""

from collections.abc import Callable
import pathlib
import shutil
import subprocess

import pytest

from waggle_tasks.experiments.claim_parts import (
  arithmetic,
  book,
  check,
  compare,
  documents,
  finding,
  kinds,
)

Waggle = Callable[..., subprocess.CompletedProcess[str]]
ROOT = pathlib.Path(__file__).parents[1]


@pytest.fixture(scope='module')
def library() -> documents.Library:
  return documents.read(ROOT)


@pytest.fixture
def copied(tmp_path: pathlib.Path) -> pathlib.Path:
  """A copy of the documents, to be changed by hand."""
  shutil.copy(ROOT / 'README.md', tmp_path)
  (tmp_path / 'docs').mkdir()
  for path in (ROOT / 'docs').glob('*.md'):
    shutil.copy(path, tmp_path / 'docs')
  return tmp_path


def block(*lines: str) -> documents.Block:
  return documents.Block('docs/x.md', 10, lines)


def wrong(found: list[finding.Finding]) -> list[finding.Finding]:
  return [each for each in found if each.verdict == finding.DIFFERS]


def test_every_block_has_a_claim_and_its_figures_fit_each_other(
  library: documents.Library,
) -> None:
  assert wrong(check.figures(library)) == []
  assert {each.block for each in book.CLAIMS.values()} == {*library.blocks}


@pytest.mark.parametrize('name', book.SENTENCES)
def test_the_numbers_of_a_sentence_are_those_of_the_tables(
  library: documents.Library, name: str
) -> None:
  found = check.sentence(book.SENTENCES[name], library)
  assert found.verdict == finding.AGREES, found.words


def test_unchanged_documents_agree(
  waggle: Waggle, copied: pathlib.Path
) -> None:
  names = f'figures,together,timings,{",".join(book.SENTENCES)}'
  child = waggle('claims', f'--only={names}', f'--root={copied}')
  assert child.returncode == 0, child.stdout + child.stderr
  assert '0 differ' in child.stdout.splitlines()[-1]
  (timings,) = [x for x in child.stdout.splitlines() if ' timings ' in x]
  assert timings.startswith('not checked')


def in_block(library: documents.Library, name: str, part: str) -> str:
  """The first line of a block that holds a text."""
  return next(x for x in library.blocks[name].lines if part in x)


@pytest.mark.parametrize(
  ('claim', 'name', 'part', 'old', 'new'),
  [
    ('figures', 'map', '100', '5/5 ', '4/5 '),  # A count.
    ('figures', 'map', '100', '48-100', '58-100'),  # Its limits.
    ('figures', 'grazing', 'right: ', '/48', '/49'),  # A total.
    ('figures', 'far', 'wrong messages: 0', ': 0 in', ': 1 in'),
    ('figures', 'decoys', 'unauthorised', 'at most 0.', 'at most 0.0'),
    ('figures', 'paper', 'One observer', '1/1', '0/1'),
    ('figures', 'paper', 'One observer', '1/1', ' - '),  # No count.
    ('figures', 'paper', 'messages correct', '68.4', '78.4'),
    ('figures', 'paper-view-bank', 'Half-span 45', 'Pass', 'Fail'),
    ('figures', 'sensitivity', 'seed 4', '44', '45'),
    ('figures', 'event-logs', 'one-observer', ' equal', 'differ'),
    ('together', 'together', 'right: ', 'right: 3', 'right: 2'),
    ('main-totals', 'main-totals', 'broadcasts', '13/17', '14/17'),
  ],
)
def test_a_figure_that_was_changed_by_hand_is_named(
  copied: pathlib.Path, library: documents.Library,
  claim: str, name: str, part: str, old: str, new: str,
) -> None:  # fmt: skip
  before = library.blocks[name]
  line = in_block(library, name, part)
  assert old in line
  path = copied / before.document
  lines = path.read_text(encoding='utf-8').splitlines()
  at = lines.index(line, before.first - 1)
  lines[at] = line.replace(old, new, 1)
  path.write_text('\n'.join(lines) + '\n', encoding='utf-8')
  changed = documents.read(copied)
  if claim == 'figures':
    found = wrong(check.figures(changed))
  else:
    found = wrong(check.claim(book.CLAIMS[claim], changed, workers=1))
  assert found
  for each in found:
    document, _, number = each.place.partition(':')
    assert document == before.document
    assert 0 <= int(number) - before.first < len(before.lines)


def test_a_number_of_a_sentence_that_was_changed_is_named(
  waggle: Waggle, copied: pathlib.Path
) -> None:
  path = copied / 'README.md'
  text = path.read_text(encoding='utf-8')
  path.write_text(text.replace('reads 53/53', 'reads 52/53'), encoding='utf-8')
  child = waggle('claims', '--only=readme-view-bank', f'--root={copied}')
  assert child.returncode == 1
  assert 'DIFFERS     readme-view-bank' in child.stdout
  assert "says 'reads 52/53 and passes', made '53, 53'" in child.stdout


SMALL = kinds.Claim(
  'small', kinds.CELLS,
  (
    'sweep', '--control=no_send', '--duration_s=1', '--observers=1',
    '--grid=distance_m=0.8,1.3', '--grid=noise_sigma=0',
  ),
)  # fmt: skip


@pytest.mark.slow
def test_what_is_flown_again_is_set_beside_the_document() -> None:
  said = block(
    'distance_m \\ noise_sigma          0          5',
    '------------------------  ---------  ---------',
    '0.8                       1/1 3-100   0/1 0-97',
    '1.3                        0/1 0-97   0/1 0-97',
  )
  library = documents.Library({'small': said}, [], {})
  (found,) = check.claim(SMALL, library, workers=1)
  assert found.verdict == finding.DIFFERS
  assert found.place == 'docs/x.md:13'
  assert found.words == "says '0/1 0-97', made '1/1 3-100'"


def test_a_block_that_is_gone_is_a_difference() -> None:
  library = documents.Library({}, [], {})
  (found,) = check.claim(book.CLAIMS['paper'], library, workers=1)
  assert found.verdict == finding.DIFFERS
  assert '<!-- claim: paper -->' in found.words


SUITE = (
  'standard: configuration  N  correct  paper  group  paper',
  '-----------------------  -  -------  -----  -----  -----',
  'Default, forward         3      3/3    3/3   Pass   Pass',
  'Half-span 45 deg         3      1/3    1/3   Fail   Fail',
  'messages correct: 4/6',
  '',
  'failures:',
  '  span-45, observer_1: message: none',
)


@pytest.mark.parametrize(
  ('line', 'old', 'new', 'place'),
  [
    (2, '3/3    3/3', '2/3    3/3', 'docs/x.md:12'),
    (3, 'Fail', 'Pass', 'docs/x.md:13'),
    (7, 'none', '000010', 'docs/x.md:17'),
  ],
)
def test_rows_and_failures_are_compared_word_by_word(
  line: int, old: str, new: str, place: str
) -> None:
  printed = documents.block_of('\n'.join(SUITE))
  assert wrong(compare.rows(block(*SUITE), printed)) == []
  lines = [*SUITE]
  lines[line] = lines[line].replace(old, new, 1)
  (found,) = wrong(compare.rows(block(*lines), printed))
  assert found.place == place


@pytest.mark.parametrize(
  ('whole', 'some', 'fits'),
  [
    ('53/53', '4/4', True), ('53/53', '3/4', False), ('0/17', '0/2', True),
    ('0/17', '1/2', False), ('44/53', '3/4', True), ('4/5', '1/3', False),
  ],
)  # fmt: skip
def test_counts_of_a_part_are_held_against_the_whole(
  whole: str, some: str, fits: bool
) -> None:
  head = ('receiver  messages', '--------  --------')
  said, made = (block(*head, f'klt       {x:>8}') for x in (whole, some))
  assert (wrong(compare.part(said, made)) == []) is fits


def _maps(columns: str, near: str, far: str) -> documents.Block:
  """A sweep's map for each of two shares of images that are lost."""
  rule = '  '.join('-' * len(title) for title in columns.split('  '))
  lines = []
  for share, counts in (('0', near), ('0.3', far)):
    lines += [
      f'dropped share = {share}:',
      columns,
      rule,
      f'0.6        {counts}',
      '',
    ]
  return block(*lines)


@pytest.mark.parametrize(
  ('made', 'far', 'fits'),
  [
    ('distance_m  swapped', '1/2    ', True),
    ('distance_m  swapped', '2/2    ', False),
    ('distance_m  unknown', '2/2    ', False),
  ],
)
def test_a_part_may_have_fewer_columns_of_each_map(
  made: str, far: str, fits: bool
) -> None:
  whole = _maps(
    'distance_m  repeated  swapped', ' 4/4       4/4', ' 4/4       1/4'
  )
  part = _maps(made, ' 2/2', f' {far}')
  assert (wrong(compare.part(whole, part)) == []) is fits


def test_a_table_ends_where_its_columns_do() -> None:
  (table,) = block(*SUITE).tables
  assert table.header[0] == 'standard: configuration'
  assert [row[0] for row in table.rows] == [
    'Default, forward', 'Half-span 45 deg'
  ]  # fmt: skip
  assert table.place(1) == 13


def test_impossible_counts_are_a_difference() -> None:
  (found,) = arithmetic.check(block('right: 5/4 exposures (125.00%)'))
  assert found.verdict == finding.DIFFERS


def test_a_claim_that_stands_twice_is_refused(copied: pathlib.Path) -> None:
  path = copied / 'README.md'
  text = path.read_text(encoding='utf-8')
  path.write_text(f'{text}\n<!-- claim: paper -->\n\n```\nx\n```\n')
  with pytest.raises(documents.DocumentError, match='paper stands twice'):
    documents.read(copied)


def test_a_block_without_a_claim_is_named(copied: pathlib.Path) -> None:
  path = copied / 'docs' / 'sweeps.md'
  path.write_text('```\nright: 5/5\n```\n')
  (found,) = wrong(check.figures(documents.read(copied)))
  assert found.place == 'docs/sweeps.md:2'


def test_the_list_names_every_claim_and_its_command(waggle: Waggle) -> None:
  child = waggle('claims', '--list')
  assert child.returncode == 0
  for name, each in book.CLAIMS.items():
    assert f'\n{name} ' in child.stdout
    assert ' '.join(each.command) in child.stdout


def test_bad_input_is_one_line(waggle: Waggle) -> None:
  child = waggle('claims', '--only=papre')
  assert child.returncode == 2
  (line,) = child.stderr.splitlines()
  assert 'Did you mean' in line


def test_documents_that_are_not_there_are_named(tmp_path: pathlib.Path) -> None:
  with pytest.raises(documents.DocumentError, match=r'`root` .*README\.md'):
    documents.read(tmp_path)
