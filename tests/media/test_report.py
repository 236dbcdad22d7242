"""The page of a run, of a suite, and the command that makes them again."""

from collections.abc import Callable
import html
import html.parser
import itertools
import json
import pathlib
import re
import subprocess
from xml.etree import ElementTree

import numpy as np
import pytest

from waggle_tasks import plain, scenario
from waggle_tasks.experiments.pages import (
  document,
  markup,
  plot,
  run_page,
  suite_page,
)
from waggle_tasks.experiments.record import archive, encoding, traces

Waggle = Callable[..., subprocess.CompletedProcess[str]]
DATA = (
  'config.json', 'events.jsonl', 'result.json', 'provenance.json',
  'traces.npz', 'positions.npz',
)  # fmt: skip
# What follows a name with an attribute that loads or leads to something.
LINKS = re.compile(r'\b(?:src|href|action|poster|data)="([^"]*)"')


class Text(html.parser.HTMLParser):
  """The words of a page outside of style and script, in their order."""

  def __init__(self, page: str) -> None:
    super().__init__()
    self.words: list[str] = []
    self._silent = 0
    self.feed(page)

  def handle_starttag(self, tag: str, attrs: object) -> None:
    del attrs
    self._silent += tag in ('style', 'script')

  def handle_endtag(self, tag: str) -> None:
    self._silent -= tag in ('style', 'script')

  def handle_data(self, data: str) -> None:
    if not self._silent:
      self.words.append(data)

  def __str__(self) -> str:
    return ' '.join(' '.join(self.words).split())


@pytest.fixture(scope='module')
def page(recorded: object) -> str:
  return (recorded.folder / document.NAME).read_text(encoding='utf-8')


@pytest.fixture(scope='module')
def words(page: str) -> str:
  return str(Text(page))


def fail(folder: pathlib.Path) -> None:
  """Makes a run folder that of a failed run, with a motion unknown."""
  result = json.loads((folder / 'result.json').read_text())
  result['passed'] = False
  result['outcomes'][0] |= {
    'decoded': None, 'failures': ['message: none, <motion> 1 unknown'],
  }  # fmt: skip
  (folder / 'result.json').write_text(json.dumps(result))
  path = folder / 'events.jsonl'
  lines = [json.loads(line) for line in path.read_text().splitlines()]
  start = next(line for line in lines if line['symbol'] == 'START')
  start['symbol'] = start['recognition']['symbol'] = 'UNKNOWN'
  start['recognition'] |= {'reason': 'RMSE 0.1727 >= 0.17', 'rmse': 0.1727}
  start['rejection'] = 'expected START, got UNKNOWN, after 0 of 6 bits'
  path.write_text(''.join(json.dumps(line) + '\n' for line in lines))


def test_a_page_needs_nothing_but_files_beside_it(
  page: str, recorded: object
) -> None:
  links = set(LINKS.findall(page))
  assert 'composite.webm' in links
  for link in links:
    inside = link.startswith('#') and f'id="{link[1:]}"' in page
    assert inside or (recorded.folder / link).is_file(), link
  assert 'http' not in page.replace('http-equiv', '')
  assert '@import' not in page
  assert 'url(' not in page.replace('url(#stripes)', '')


@pytest.mark.slow
def test_the_command_makes_the_same_page_again_without_gl(
  waggle: Waggle, copied: pathlib.Path, page: str, no_gl: dict[str, str]
) -> None:
  (copied / document.NAME).unlink()
  child = waggle('report', str(copied), **no_gl)
  assert child.returncode == 0, child.stderr
  assert child.stdout == f'{copied / document.NAME}\n'
  assert (copied / document.NAME).read_text(encoding='utf-8') == page


def test_every_drawing_is_well_formed_and_says_what_it_shows(
  page: str,
) -> None:
  drawings = re.findall(r'<svg.*?</svg>', page, re.DOTALL)
  # Timelines, four panels for each of two observers, eight motions, the room
  # from above and from the front, eight gestures as flown, and the stripes.
  assert len(drawings) == 1 + 2 * 4 + 8 + 2 + 8 + 1
  for drawing in drawings:
    root = ElementTree.fromstring(drawing)
    assert root.get('aria-label') or root.find('defs') is not None


def test_the_verdict_comes_first_with_a_chip_for_each_observer(
  words: str,
) -> None:
  assert words.split('group passed')[0].count('observer') == 0
  assert '\u2713 group passed 1 of 1 decoded 000010' in words
  assert '\u2713 observer_1 000010' in words
  assert '\u2713 observer_2 no message' in words
  assert 'What failed' not in words
  assert 'waited, as it should' in words


def test_the_head_tells_all_that_is_unlike_the_default(words: str) -> None:
  head = words.split('Timeline')[0]
  assert 'black_input; payload 000010' in head
  assert 'half-span 10\u00b0' in head
  changed = head.split('Changed: ')[1]
  assert changed.strip() == (
    'half_width_m=0.12, start_height_m=0.25, gesture_s=2,'
    ' initial_hover_s=3.2, settle_s=0.6, lead_in_s=1.8'
  )


def test_a_run_of_the_defaults_changes_nothing(copied: pathlib.Path) -> None:
  config = json.loads((copied / 'config.json').read_text())
  config['scenario'] = plain.to_plain(scenario.Scenario(observers=2))
  (copied / 'config.json').write_text(json.dumps(config))
  page = run_page.write(copied).read_text(encoding='utf-8')
  assert 'Changed' not in str(Text(page))


def test_the_dance_is_seen_from_the_front(page: str, recorded: object) -> None:
  way_m = recorded.rollout.positions_m['performer']
  (drawing,) = re.findall(
    r'<svg(?:(?!</svg>).)*the room from the front.*?</svg>', page, re.DOTALL
  )
  maps = html.unescape(re.search(r'data-maps="([^"]*)"', drawing)[1])
  (x, *_), (z, low_m, bottom, scale) = json.loads(maps)
  assert (x, z) == (0, 2)
  line = re.search(r'<polyline points="([^"]+)"', drawing)[1]
  rows = [float(pair.split(',')[1]) for pair in line.split()]
  heights_m = [low_m + (row - bottom) / scale for row in rows]
  assert min(heights_m) == pytest.approx(way_m[:, 2].min(), abs=0.002)
  assert max(heights_m) == pytest.approx(way_m[:, 2].max(), abs=0.002)


def test_a_run_that_failed_shows_its_failures_before_everything_else(
  copied: pathlib.Path,
) -> None:
  fail(copied)
  page = run_page.write(copied).read_text(encoding='utf-8')
  words = str(Text(page))
  assert words.index('\u2717 group FAILED') < words.index('What failed')
  assert words.index('What failed') < words.index('Timeline')
  assert 'observer_1 : message: none, <motion> 1 unknown' in words
  assert '&lt;motion&gt;' in page
  assert 'RMSE 0.1727 >= 0.17' in words
  assert 'expected START, got UNKNOWN' in words
  assert 'RMSE 0.173 < 0.17 \u2717' in words


def test_each_motion_has_its_scores_beside_their_limits(
  words: str, recorded: object
) -> None:
  motions = [
    event
    for event in recorded.rollout.events['observer_1']
    if getattr(event, 'recognition', None)
  ]
  assert len(motions) == 8
  for number, event in enumerate(motions, 1):
    scores = event.recognition
    assert (
      f'motion {number}, {event.time_s:.2f} s {event.symbol}' in words
    )  # fmt: skip
    assert (
      f'RMSE {scores.rmse:.3f} < 0.17 \u2713 margin {scores.margin:.3f} > 0.075'
      f' \u2713 closure {scores.closure:.3f} < 0.18 \u2713 span, px'
      f' {scores.span_px:.1f} \u2265 28 \u2713'
    ) in words


def test_limits_are_those_of_the_runs_own_receiver(
  copied: pathlib.Path,
) -> None:
  config = json.loads((copied / 'config.json').read_text())
  config['receiver'] = 'klt:max_rmse=0.25,on_px_s=4.5'
  (copied / 'config.json').write_text(json.dumps(config))
  words = str(Text(run_page.write(copied).read_text(encoding='utf-8')))
  assert '< 0.25 \u2713' in words
  assert 'motion begins over 4.5 px/s and ends under 2.5 px/s' in words


def test_smallest_distances_are_those_of_the_flight(
  words: str, recorded: object
) -> None:
  ways = recorded.rollout.positions_m
  for a, b in itertools.combinations(ways, 2):
    apart_m = np.sqrt(((ways[a] - ways[b]) ** 2).sum(axis=1))
    assert f'{a}, {b} {apart_m.min():.3f}' in words


def test_commanded_and_flown_displacements_stand_side_by_side(
  words: str,
) -> None:
  assert 'observer_1 0.000, 0.400, 0.000 0.000, 0.400, 0.000 0.00' in words
  assert 'observer_2 \u2013 stayed within 0.0 mm' in words


def test_the_command_and_the_sources_are_told(
  words: str, recorded: object
) -> None:
  origin = archive.read_json(recorded.folder / 'provenance.json')
  assert 'The command that runs it again: waggle x' in words
  assert origin['source_digest'] in words
  assert f'mujoco {origin["versions"]["mujoco"]}' in words


def test_what_a_command_holds_is_shown_and_not_run(
  copied: pathlib.Path,
) -> None:
  path = copied / 'provenance.json'
  origin = json.loads(path.read_text())
  origin['command'] = 'waggle </script><script>alert(1)</script>'
  path.write_text(json.dumps(origin))
  page = run_page.write(copied).read_text(encoding='utf-8')
  assert '<script>alert' not in page
  assert '&lt;script&gt;alert(1)' in page


def test_a_page_without_a_video_says_how_to_make_one(
  copied: pathlib.Path,
) -> None:
  (copied / 'composite.webm').unlink()
  page = run_page.write(copied).read_text(encoding='utf-8')
  assert '<video' not in page
  assert '`waggle broadcast --video` makes one' in page


def test_videos_of_several_pages_can_be_chosen(copied: pathlib.Path) -> None:
  for name in ('composite-2.webm', 'composite-10.webm'):
    (copied / name).touch()
  page = run_page.write(copied).read_text(encoding='utf-8')
  assert re.findall('data-film="([^"]+)"', page) == [
    'composite.webm', 'composite-2.webm', 'composite-10.webm'
  ]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize('name', DATA)
def test_a_missing_file_is_named(
  waggle: Waggle, copied: pathlib.Path, name: str
) -> None:
  (copied / name).unlink()
  child = waggle('report', str(copied))
  assert child.returncode == 2
  (line,) = child.stderr.splitlines()
  assert name in line


@pytest.mark.parametrize('name', DATA)
@pytest.mark.parametrize('how', ['cut short', 'something else'])
def test_a_damaged_file_is_named(
  copied: pathlib.Path, name: str, how: str
) -> None:
  path = copied / name
  data = path.read_bytes()
  cut = data[: len(data) // 2 + 1]
  path.write_bytes(cut if how == 'cut short' else b'dance')
  before = (copied / document.NAME).read_bytes()
  with pytest.raises((archive.ArchiveError, traces.TraceError), match=name):
    run_page.write(copied)
  assert (copied / document.NAME).read_bytes() == before


@pytest.mark.parametrize('name', DATA[:4])
def test_data_without_what_a_run_leaves_is_refused(
  copied: pathlib.Path, name: str
) -> None:
  (copied / name).write_text('{}')
  with pytest.raises(archive.ArchiveError, match=r'is damaged|no run left'):
    run_page.write(copied)


def test_a_page_that_cannot_be_drawn_loses_no_run(
  copied: pathlib.Path,
  monkeypatch: pytest.MonkeyPatch,
  capsys: pytest.CaptureFixture[str],
) -> None:
  def fail(*_: object) -> None:
    raise ZeroDivisionError('of a plot')

  before = {p.name: p.read_bytes() for p in copied.iterdir() if p.is_file()}
  monkeypatch.setattr(run_page, 'draw', fail)
  run_page.leave(copied)
  after = {p.name: p.read_bytes() for p in copied.iterdir() if p.is_file()}
  assert after == before
  (line,) = capsys.readouterr().err.splitlines()
  assert 'of a plot' in line
  assert 'its data are whole, and `waggle report FOLDER` makes the page' in line


def rewrite(path: pathlib.Path, **changes: object) -> None:
  """Changes fields of a JSON file; those that are None are taken out."""
  table = json.loads(path.read_text(encoding='utf-8')) | changes
  kept = {name: each for name, each in table.items() if each is not None}
  path.write_text(json.dumps(kept), encoding='utf-8')


JSON = ('config.json', 'result.json', 'provenance.json')


@pytest.mark.parametrize('name', JSON)
def test_data_of_a_newer_program_are_refused_by_their_format(
  copied: pathlib.Path, name: str
) -> None:
  rewrite(copied / name, format=encoding.FORMAT + 1, new={})
  error = f'{name} must be 1 to 2 for this program: got 3, .* update waggle'
  with pytest.raises(encoding.FormatError, match=error):
    run_page.write(copied)


@pytest.mark.parametrize('odd', ['2', 0, True, 1.5, [2]])
def test_a_format_that_is_none_is_refused(
  copied: pathlib.Path, odd: object
) -> None:
  rewrite(copied / 'config.json', format=odd)
  with pytest.raises(encoding.FormatError, match='must be a number: got'):
    archive.read_config(copied / 'config.json')


def test_a_run_of_the_oldest_format_has_the_same_page(
  copied: pathlib.Path, page: str
) -> None:
  for name in JSON:
    rewrite(copied / name, format=None, agreement=None)
  run_page.write(copied)
  assert (copied / document.NAME).read_text(encoding='utf-8') == page


def test_a_run_from_before_a_field_was_known_has_its_default(
  copied: pathlib.Path,
) -> None:
  path = copied / 'config.json'
  scene = json.loads(path.read_text(encoding='utf-8'))['scenario']
  del scene['tolerance'], scene['drift'], scene['seed']
  rewrite(path, scenario=scene, agreement=None, format=None)
  run_page.write(copied)
  made = archive.read_scenario(path)
  assert (made.seed, made.drift) == (0, scenario.Scenario().drift)


@pytest.mark.parametrize(
  ('change', 'field'),
  [
    ({'mood': 1}, '`event.mood`'),
    ({'kind': 'echo'}, '`kind`'),
    ({'kind': []}, '`kind`'),
  ],
)
def test_an_event_that_is_not_known_is_of_a_newer_program_not_damaged(
  copied: pathlib.Path, change: dict[str, object], field: str
) -> None:
  path = copied / 'events.jsonl'
  first, *rest = path.read_text(encoding='utf-8').splitlines()
  first = json.dumps(json.loads(first) | change)
  path.write_text('\n'.join([first, *rest]), encoding='utf-8')
  with pytest.raises(archive.ArchiveError, match=r'jsonl, line 1, ') as caught:
    run_page.write(copied)
  said = str(caught.value)
  assert 'a newer one may have written it' in said
  assert f'{field} must be one of' in said
  assert 'damaged' not in said


def test_the_scenario_of_a_run_is_made_again(recorded: object) -> None:
  path = recorded.folder / 'config.json'
  assert archive.read_scenario(path) == recorded.scene
  config = archive.read_config(path)
  assert config.agreement == recorded.scene.agreement
  assert config.receiver == 'klt'


def test_what_receivers_saw_comes_back_as_it_was(recorded: object) -> None:
  run = archive.load(recorded.folder)
  assert run.events == recorded.rollout.events
  assert [*run.positions_m] == [*recorded.rollout.positions_m]
  for name, trace in recorded.rollout.traces.items():
    again = run.traces[name]
    np.testing.assert_array_equal(again.centre_px, trace.centre_px)
    np.testing.assert_array_equal(again.valid, trace.valid)
    assert len(again.motions) == len(trace.motions)
    for ours, theirs in zip(again.motions, trace.motions, strict=True):
      assert ours.begin_s == theirs.begin_s
      np.testing.assert_array_equal(ours.path_px, theirs.path_px)


def test_equal_traces_are_equal_bytes(
  recorded: object, tmp_path: pathlib.Path
) -> None:
  traces.save(tmp_path / 'traces.npz', recorded.rollout.traces)
  data = (tmp_path / 'traces.npz').read_bytes()
  assert data == (recorded.folder / 'traces.npz').read_bytes()


@pytest.mark.parametrize(
  ('low', 'high', 'length', 'logarithmic', 'wanted'),
  [
    (0.0, 104.0, 990, False, [0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100]),
    (-1.1, 1.1, 200, False, [-1, 0, 1]),
    (0.0, 7.0, 400, False, [0, 2, 4, 6]),
    (0.01, 1000.0, 110, True, [0.01, 0.1, 1, 10, 100, 1000]),
  ],
)
def test_ticks_are_round_numbers(
  low: float, high: float, length: float, logarithmic: bool,
  wanted: list[float],
) -> None:  # fmt: skip
  scale = plot.Scale(low, high, 0.0, length, logarithmic)
  assert scale.ticks() == pytest.approx(wanted)


def test_text_is_escaped_and_markup_is_not() -> None:
  inner = markup.tag('b', 'a < b & c')
  assert inner == '<b>a &lt; b &amp; c</b>'
  whole = markup.tag('p', inner, None, 1.50, class_='x"y', hidden=True, id=None)
  assert whole == '<p class="x&quot;y" hidden>' + inner + '1.5</p>'


OUTCOME = {'observer': 'observer_1', 'expected': None, 'failures': []}
ROWS = [
  {
    'case': 'default', 'group': 'standard', 'label': 'Default', 'observers': 2,
    'expecting': 2, 'correct': 2, 'passed': True, 'receiver': 'klt',
    'simulated_s': 100.0, 'identity': 'a', 'scenario': {},
    'published': {'correct': 2, 'passed': True},
    'outcomes': [OUTCOME],
  },
  {
    'case': 'span-40', 'group': 'standard', 'label': '<b>Span</b>',
    'observers': 2, 'expecting': 2, 'correct': 1, 'passed': False,
    'receiver': 'klt', 'simulated_s': 100.0, 'identity': 'a', 'scenario': {},
    'published': {'correct': 1, 'passed': False},
    'outcomes': [OUTCOME | {'failures': ['RMSE 0.173']}],
  },
  {
    'case': 'far', 'group': 'supplemental', 'label': 'Far', 'observers': 1,
    'expecting': 1, 'correct': 0, 'passed': False, 'receiver': 'klt',
    'simulated_s': 100.0, 'identity': 'a', 'scenario': {},
    'published': {'correct': 1, 'passed': True},
    'outcomes': [OUTCOME | {'failures': ['support 2 < 5']}],
  },
]  # fmt: skip


@pytest.fixture
def suite(tmp_path: pathlib.Path) -> pathlib.Path:
  lines = ''.join(json.dumps(row) + '\n' for row in ROWS)
  (tmp_path / 'results.jsonl').write_text(lines)
  return tmp_path


@pytest.mark.slow
def test_a_suites_page_shows_what_differs_first_and_links_every_run(
  waggle: Waggle, suite: pathlib.Path, no_gl: dict[str, str]
) -> None:
  child = waggle('report', str(suite), **no_gl)
  assert child.returncode == 0, child.stderr
  page = (suite / document.NAME).read_text(encoding='utf-8')
  words = str(Text(page))
  assert '\u2717 1 of 3 cases are not as expected' in words
  failed = words[words.index('What failed') : words.index('configuration')]
  assert failed.index('support 2 < 5') < failed.index('RMSE 0.173')
  assert 'Far (supplemental), not as expected' in failed
  assert 'Span</b> (standard), as published' in failed
  links = set(LINKS.findall(page))
  assert links == {f'cases/{row["case"]}/index.html' for row in ROWS}


def test_a_suites_groups_are_never_pooled(suite: pathlib.Path) -> None:
  page = suite_page.write(suite).read_text(encoding='utf-8')
  words = str(Text(page))
  standard, supplemental = words.split(' supplemental configuration')
  assert 'broadcasts passed: 1/2 (50.00%), paper 1/2' in standard
  assert 'messages correct: 3/4 (75.00%), paper 3/4' in standard
  assert 'broadcasts passed: 0/1 (0.00%), paper 1/1' in supplemental
  assert 'Default 2 2/2 2/2 Pass Pass \u2713 as published' in standard
  assert '\u2717 fails, unlike published' in supplemental


@pytest.mark.parametrize('text', ['', 'dance\n', '[1]\n', '{}\n'])
def test_damaged_results_are_refused(tmp_path: pathlib.Path, text: str) -> None:
  (tmp_path / 'results.jsonl').write_text(text)
  with pytest.raises(archive.ArchiveError, match=r'results\.jsonl'):
    suite_page.write(tmp_path)


def test_results_of_a_newer_suite_are_refused(suite: pathlib.Path) -> None:
  path = suite / 'results.jsonl'
  text = json.dumps(ROWS[0] | {'format': 3, 'new': 1})
  path.write_text(f'{path.read_text()}{text}\n')
  error = r'results.jsonl, line 4, must be 1 to 2 for this program: got 3'
  with pytest.raises(encoding.FormatError, match=error):
    suite_page.write(suite)


@pytest.mark.parametrize('arguments', [[], ['a', 'b']])
def test_the_command_takes_one_folder(
  waggle: Waggle, arguments: list[str]
) -> None:
  child = waggle('report', *arguments)
  assert child.returncode == 2
  assert 'takes one FOLDER' in child.stderr
