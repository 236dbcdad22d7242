"""`waggle link`: what is flown, what is counted of it, and what is shown."""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import pathlib
import re
import subprocess

import pytest

from waggle_tasks.experiments.pages import link_page
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import (
  code_tables,
  figures,
  goodput,
  link_tables,
)
from waggle_tasks.experiments.studies import (
  case_rows,
  link_cases,
  link_conditions,
  link_schemes,
  link_study,
  pool,
  runner,
  sweep_cases,
)

Waggle = Callable[..., subprocess.CompletedProcess[str]]
Row = case_rows.SweepRow
LOST = {'decoded': None, 'start_s': None}


def plan(schemes: str, *conditions: str, **others: object) -> link_cases.Plan:
  usual = {
    'distances_m': [1.3], 'bearings_deg': [0.0], 'broadcasts': 1,
    'observers': 1,
  }  # fmt: skip
  wanted = conditions or ('calm',)
  return link_cases.Plan(
    link_schemes.parse(schemes), wanted, **(usual | others)
  )


def flown(
  make: object, fate: Callable[..., dict[str, object]], what: link_cases.Plan
) -> list[Row]:
  """Rows of a plan that nobody flew, by the fate of each broadcast."""
  return [make.row(each, fate, each.name) for each in link_cases.cases(what)[0]]


def not_delivered(*repeats: int) -> Callable[..., dict[str, object]]:
  return lambda case, number: LOST if case.repeat in repeats else {}


# Schemes.


def test_a_comma_parts_schemes_and_changes_of_a_code() -> None:
  text = 'paper x3, swift:check=crc4,parity=0 x2,swift:parity=0,brisk'
  found = link_schemes.parse(text)
  assert [each.name for each in found] == [
    'paper x3', 'swift:check=crc4,parity=0 x2', 'swift:parity=0', 'brisk',
  ]  # fmt: skip
  assert [each.receiver for each in found] == ['view_bank', *['joint'] * 3]
  # The paper says a message again in another dance, the others in one.
  assert [each.sendings for each in found] == [3, 1, 1, 1]
  assert [each.values['repeat'] for each in found] == [1, 2, 1, 1]


def test_ablations_of_the_paper_differ_in_what_reads_them() -> None:
  names = 'paper,paper without nulls,paper without final confirmation'
  cases, _ = link_cases.cases(plan(names))
  assert [case.receiver for case in cases] == [
    'view_bank', 'view_bank:separators=off', 'view_bank:final_null=off',
  ]  # fmt: skip
  assert len({case.scene for case in cases}) == 1


@pytest.mark.parametrize(
  ('text', 'said'),
  [
    ('', 'must each be a language'),
    ('swift,', 'must each be a language'),
    ('swift,swift', 'must name each once'),
    ('swft', 'Did you mean swift'),
    ('paper without null', 'Did you mean paper without nulls'),
    ('paper:parity=0', 'must each be a language'),
    ('swift x', "must each be a language .* got 'swift x'"),
    ('swift x0', "must have 1 to 100 rounds: got 'swift x0'"),
    ('swift x101', 'must have 1 to 100 rounds'),
    ('swift x2 x3', 'must each be a language'),
    ('swift:parity=9', "'swift:parity=9': `parity` must be between 0 and 6"),
    ('swift:parity=1,party=2', 'Did you mean parity'),
    ('swift:x3', 'must be NAME or NAME:check'),
  ],
)
def test_a_scheme_that_cannot_be_is_refused(text: str, said: str) -> None:
  with pytest.raises(link_schemes.SchemeError, match=said):
    link_schemes.parse(text)


# Cases.


@pytest.mark.parametrize('count', [1, 64, 100])
def test_bits_of_any_number_are_drawn_for_each_message(count: int) -> None:
  cases, _ = link_cases.cases(
    plan('swift', broadcasts=5, bits=f'random:{count}')
  )
  sent = [case.scene.bits for case in cases]
  assert {len(bits) for bits in sent} == {count}
  assert len({*sent}) > 1
  again, _ = link_cases.cases(
    plan('swift', broadcasts=5, bits=f'random:{count}')
  )
  assert [case.scene for case in again] == [case.scene for case in cases]


def test_bits_that_are_given_are_those_of_every_message() -> None:
  cases, refused = link_cases.cases(plan('paper,swift', bits='0110'))
  assert [case.scene.bits for case in cases] == ['0110']
  assert 'says one payload once' in refused[0]


@pytest.mark.parametrize(
  ('bits', 'said'),
  [
    ('random', "'random:N' for N bits that are drawn: got 'random'"),
    ('random:x', "got 'random:x'"),
    ('random:0', '`bits` must be between 1 and 2048: got 0'),
    ('random:2049', '`bits` must be between 1 and 2048: got 2049'),
    ('012', "got '012'"),
  ],
)
def test_bits_that_cannot_be_sent_are_refused(bits: str, said: str) -> None:
  with pytest.raises(link_schemes.SchemeError, match=said):
    link_cases.cases(plan('swift', bits=bits))


def test_goodput_of_data_counts_their_bits_and_those_that_are_right(
  make: object,
) -> None:
  def fate(case: sweep_cases.Sample, number: int) -> dict[str, object]:
    del number
    bits = case.scene.bits
    read = [bits, f'{bits[:-1]}{1 - int(bits[-1])}', None][case.repeat]
    return {'decoded': read, 'start_s': None}

  rows = flown(make, fate, plan('swift', broadcasts=3, bits='random:64'))
  got = goodput.tally(rows)
  assert (got.bits, got.delivered, got.wrong) == (64, 1, 1)
  assert (got.right_bits, got.read_bits) == (127, 128)
  assert got.goodput == pytest.approx(64 / 3 / got.seconds)
  said = link_tables.report(rows, 285.0)
  assert ' bits right ' in said
  assert ' 99.22% ' in said
  assert 'bits right' not in link_tables.report(
    flown(make, not_delivered(), plan('swift')), 285.0
  )


def test_every_broadcast_is_its_own_whatever_else_is_asked_for() -> None:
  conditions = [*link_conditions.CONDITIONS]
  cases, refused = link_cases.cases(
    plan('brisk,swift,swift x2', *conditions, broadcasts=2)
  )
  assert len({case.name for case in cases}) == len(cases)
  assert len({case.values['seed'] for case in cases}) == len(cases)
  assert len({case.values['payload'] for case in cases}) > 20
  # Four rotors cannot fly what is quick sideways: that is told, once each.
  assert [line.partition(':')[0] for line in refused] == [
    'brisk, rotors', 'brisk, gusts1', 'brisk, gusts2',
  ]  # fmt: skip
  assert all('sideways' in line for line in refused)
  fewer, _ = link_cases.cases(plan('swift', 'blackouts'))
  assert fewer[0].scene in [case.scene for case in cases]


def test_black_outs_begin_when_each_broadcast_draws_it() -> None:
  cases, _ = link_cases.cases(plan('swift', 'blackouts', broadcasts=20))
  begins_s = [case.scene.sensor.blackout_s for case in cases]
  assert len({*begins_s}) > 15
  assert 0 <= min(begins_s) < 3
  assert 7 < max(begins_s) <= 10


def test_sendings_of_the_paper_have_one_payload_and_seeds_of_their_own() -> (
  None
):
  cases, _ = link_cases.cases(plan('paper,paper x3', broadcasts=3))
  single, again = cases[:3], cases[3:]
  payloads = [case.scene.payload for case in again]
  assert payloads[::3] == payloads[1::3] == payloads[2::3]
  seeds = {case.scene.seed for case in cases}
  assert len(seeds) == len(cases)
  assert [case.repeat for case in again] == [*range(9)]
  assert not {case.scene for case in single} & {case.scene for case in again}


@pytest.mark.parametrize(
  ('change', 'said'),
  [
    ({'broadcasts': 0}, '`broadcasts` must be between 1 and'),
    ({'observers': 0}, 'nothing can be flown: .*`observers` must be'),
    ({'distances_m': [9.0]}, 'nothing can be flown: .*`distance_m` must be'),
    ({'distances_m': []}, '`distances` must name each once'),
    ({'bearings_deg': [0.0, 0.0]}, '`bearings` must name each once'),
    ({'conditions': ['calm', 'calm']}, '`conditions` must name each once'),
    ({'conditions': ['nois']}, '`conditions` must be one of .* mean noise'),
  ],
)
def test_a_plan_that_cannot_be_flown_is_refused(
  change: dict[str, object], said: str
) -> None:
  with pytest.raises(link_schemes.SchemeError, match=said):
    link_cases.cases(dataclasses.replace(plan('swift'), **change))


def test_each_case_is_read_by_the_receiver_of_its_scheme(
  make: object, tmp_path: pathlib.Path
) -> None:
  read: list[tuple[str, str]] = []

  def engine(jobs: Sequence[pool.Job]) -> Iterator[pool.Done]:
    for job in jobs:
      case, reader, identity, _ = job.arguments
      read.append((case.cell['scheme'], reader))
      yield pool.Done(job, make.row(case, make.well, identity))

  cases, _ = link_cases.cases(plan('paper,paper without nulls,swift'))
  study = link_study.Link(cases)
  rows = runner.run(study, tmp_path / 'out', engine, 'waggle link')
  assert {*read} == {
    ('paper', 'view_bank'), ('swift', 'joint'),
    ('paper without nulls', 'view_bank:separators=off'),
  }  # fmt: skip
  # The same dance before two receivers is two results.
  assert len({row.identity for row in rows}) == 3
  again = runner.run(study, tmp_path / 'out', engine, 'waggle link')
  assert (again, len(read)) == (rows, 3)


# Counting.


def test_goodput_is_bits_times_share_over_seconds(make: object) -> None:
  rows = flown(make, not_delivered(1), plan('paper', broadcasts=4))
  got = goodput.tally(rows)
  assert got.seconds == pytest.approx(95.0)  # 92 s, and a null of 3 s.
  assert (got.messages, got.delivered, got.wrong, got.unseen) == (4, 3, 0, 1)
  assert got.goodput == pytest.approx(6 * 0.75 / 95)
  assert got.limits == pytest.approx((0.194, 0.994), abs=1e-3)
  assert got.wrong_limit == pytest.approx(1 - 0.05 ** (1 / 4))


def test_rounds_in_one_dance_take_their_time(make: object) -> None:
  one, three = (
    goodput.tally(flown(make, make.well, plan(name)))
    for name in ('swift', 'swift x3')
  )
  assert 2.5 * one.seconds < three.seconds < 3 * one.seconds


def test_a_given_airtime_holds_whole_messages_of_independent_fates() -> None:
  half = goodput.Tally(6, 10.0, 8, 4, 0, 4)
  assert [half.fits(s) for s in (9.9, 10.0, 29.0, 30.0)] == [0, 1, 2, 3]
  assert half.within(9.9) == 0
  assert half.within(30.0) == pytest.approx(1 - 0.5**3)
  # What is read first counts: a wrong one ends it.
  misled = goodput.Tally(6, 10.0, 4, 2, 1, 0)
  assert misled.within(20.0) == pytest.approx(0.5 + 0.25 * 0.5)
  assert goodput.Tally(6, 10.0, 4, 0, 0, 4).within(100.0) == 0


def test_of_blind_repetition_what_is_read_first_counts(make: object) -> None:
  fates = {
    1: {}, 2: {'decoded': '111111'},  # Delivered by the second of three.
    3: LOST, 4: {'decoded': '111111'}, 5: {},  # Wrong.
    6: LOST, 7: LOST, 8: LOST,
  }  # fmt: skip

  def fate(case: sweep_cases.Sample, number: int) -> dict[str, object]:
    del number
    return fates.get(case.repeat, LOST)

  rows = flown(make, fate, plan('paper x3', broadcasts=3))
  got = goodput.tally(rows)
  assert (got.messages, got.delivered, got.wrong, got.unseen) == (3, 1, 1, 1)
  assert got.seconds == pytest.approx(3 * 95.0)
  # A message whose broadcasts are not all flown yet does not count.
  assert {row.repeat for row in goodput.whole(rows[:8])} == {*range(6)}


def test_a_message_is_delivered_when_all_observers_have_it(
  make: object,
) -> None:
  def fate(case: sweep_cases.Sample, number: int) -> dict[str, object]:
    return LOST if case.repeat == number - 1 else {}

  several = plan('swift', broadcasts=3, observers=2)
  got = goodput.tally(flown(make, fate, several))
  assert (got.messages, got.delivered) == (3, 1)


def test_what_was_seen_and_not_believed_is_refused(make: object) -> None:
  rows = flown(make, not_delivered(0, 1), plan('swift', broadcasts=2))
  (seen,) = rows[0].outcomes
  outcomes = (dataclasses.replace(seen, events=2),)
  rows[0] = dataclasses.replace(rows[0], outcomes=outcomes)
  got = goodput.tally(rows)
  assert (got.refused, got.unseen) == (1, 1)


# Tables and pages.


@pytest.fixture(scope='module')
def rows(make: object) -> list[Row]:
  """Two schemes in two conditions from two distances; noise loses a half."""

  def fate(case: sweep_cases.Sample, number: int) -> dict[str, object]:
    del number
    is_lost = case.cell['condition'] == 'noise' and case.repeat
    return LOST if is_lost else {}

  wide = plan(
    'swift,swift x3', 'calm', 'noise', broadcasts=2, distances_m=[1.0, 2.0]
  )
  return flown(make, fate, wide)


def cells(line: str) -> list[str]:
  return re.split(' {2,}', line)


def test_the_table_has_a_line_for_each_scheme_and_condition(
  rows: list[Row],
) -> None:
  text = link_tables.report(rows, 65.5)
  head, _, *lines = text.splitlines()
  assert cells(head)[:4] == ['scheme', 'condition', 's', 'delivered']
  assert [cells(line)[:5] for line in lines[:4]] == [
    ['swift', 'calm', '6.5', '4/4', '39-100'],
    ['swift', 'noise', '6.5', '2/4', '6-94'],
    ['swift x3', 'calm', '18.9', '4/4', '39-100'],
    ['swift x3', 'noise', '18.9', '2/4', '6-94'],
  ]
  noisy = cells(lines[1])
  assert noisy[5:9] == ['0', '52.7%', '0', '2']
  assert noisy[9:] == ['0.459', '10 x: 99.9%', '50-100']
  assert cells(lines[0])[-2:] == ['10 x: 100.0%', '99-100']
  by_distance = text.split('\n\n')[1].splitlines()
  assert cells(by_distance[2])[:4] == ['swift', '1', '6.5', '3/4']
  assert 'losses are independent' in ' '.join(text.split())
  assert 'wrong messages: 0 in 16 messages; at most 17.075%' in text


def test_what_may_be_lost_is_not_rounded_to_certain(rows: list[Row]) -> None:
  lines = link_tables.report(rows, 600.0).splitlines()
  assert cells(lines[2])[-2] == '91 x: 100.0%'
  assert cells(lines[3])[-2] == '91 x: > 99.9%'


def test_an_airtime_that_holds_no_message_has_no_share(rows: list[Row]) -> None:
  line = link_tables.report(rows, 6.0).splitlines()[2]
  assert cells(line)[-2:] == ['-', '-']


@pytest.mark.slow
def test_the_page_and_the_picture_follow_from_the_rows(
  rows: list[Row], tmp_path: pathlib.Path
) -> None:
  page = link_page.write(tmp_path / 'made', rows).read_text(encoding='utf-8')
  for words in ('0 wrong messages', 'swift x3', 'noise of 10 grey levels'):
    assert words in page
  assert '--language=swift --noise_sigma=10.0' in re.sub(
    r' --(repeat|payload|seed|observers|distance_m)=\S+', '', page
  )
  assert not re.search(r'(src|href)="(?!data:)', page)
  text = (tmp_path / 'made' / 'summary.txt').read_text(encoding='utf-8')
  assert text.startswith('scheme')
  if figures.can_draw():
    drawn = (tmp_path / 'made' / 'link.svg').read_text(encoding='utf-8')
    for words in ('messages delivered', 'bit/s', 'swift x3', 'noise'):
      assert words in drawn
    assert 'data:image/svg+xml' in page


def test_without_matplotlib_all_but_the_picture_is_written(
  rows: list[Row], tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setattr(figures, 'can_draw', lambda: False)
  link_page.write(tmp_path / 'made', rows)
  names = {path.name for path in (tmp_path / 'made').iterdir()}
  assert names == {'summary.txt', 'index.html'}


def test_no_whole_message_yet_is_said(
  make: object, tmp_path: pathlib.Path
) -> None:
  rows = flown(make, make.well, plan('paper x3'))[:2]
  with pytest.raises(archive.ArchiveError, match='no whole message yet'):
    link_page.write(tmp_path, rows)


def test_codes_are_counted_on_a_channel() -> None:
  text = code_tables.report(2000)
  lines = text.split('\n\n')[1].splitlines()
  head, first = cells(lines[0]), cells(lines[2])
  assert first[0] == 'check=none,parity=0'
  assert len(lines) == 2 + 2 * 2 * 7
  for line in lines[2:]:
    got = dict(zip(head, cells(line), strict=True))
    shares = [float(got[name]) for name in ('right', 'wrong', 'refused')]
    assert sum(shares) == pytest.approx(1, abs=2e-3)
    rate = 6 * shares[0] / float(got['s'])
    assert float(got['bit/s']) == pytest.approx(rate, abs=0.02)


# As its user sees it.


@pytest.mark.slow
def test_a_link_is_flown_and_goes_on_where_it_was_ended(
  here: Waggle, tmp_path: pathlib.Path
) -> None:
  line = (
    'link', '--schemes=swift:parity=0,check=none,swift', '--conditions=calm',
    '--broadcasts=1', '--workers=1', '--output=out',
  )  # fmt: skip
  done = here(*line)
  assert done.returncode == 0, done.stderr
  assert [cells(each)[:4] for each in done.stdout.splitlines()[2:4]] == [
    ['swift:parity=0,check=none', 'calm', '5.1', '1/1'],
    ['swift', 'calm', '6.5', '1/1'],
  ]
  folder = tmp_path / 'out'
  assert '2 broadcasts, out/index.html' in done.stdout
  before = (folder / 'results.jsonl').read_bytes()
  # Ended before the second case: a half line is in the journal.
  journal = folder / case_rows.JOURNAL
  first = journal.read_bytes().splitlines(keepends=True)[0]
  journal.write_bytes(first + b'{"half')
  for name in ('results.jsonl', 'index.html'):
    (folder / name).unlink()
  again = here(*line)
  assert again.returncode == 0, again.stderr
  assert (folder / 'results.jsonl').read_bytes() == before
  assert again.stdout == done.stdout
  assert journal.read_bytes().startswith(first)
  assert journal.read_bytes().count(b'\n') == 2
  # Its page comes back from the data.
  page = (folder / 'index.html').read_bytes()
  (folder / 'index.html').unlink()
  report = here('report', 'out')
  assert report.returncode == 0, report.stderr
  assert (folder / 'index.html').read_bytes() == page


FLAGS = {
  '--schemes=swft': '`schemes` must each be .* Did you mean swift',
  '--schemes=swift:parity=9': '`parity` must be between 0 and 6',
  '--conditions=storm': '`conditions` must be one of .*calm',
  '--conditions=': '`conditions` must name each once',
  '--distances=near': "`distances` must be numbers: got 'near'",
  '--distances=9': 'nothing can be flown: .*`distance_m` must be between',
  '--bearings=0,0': '`bearings` must name each once',
  '--broadcasts=0': '`broadcasts` must be between 1 and',
  '--observers=0': '`observers` must be between 1 and 64: got 0',
  '--airtime_s=-1': '--airtime_s must be positive, finite: got -1.0',
  '--airtime_s=nan': '--airtime_s must be positive, finite: got nan',
  '--codes --messages=0': '`messages` must be between 1 and',
  '--schemes=brisk --conditions=rotors': 'nothing can be flown: brisk, rotors',
  'folder': "takes only flags, --name=value: got 'folder'",
}


@pytest.fixture(scope='module')
def answers(
  tmp_path_factory: pytest.TempPathFactory, ask: Callable[..., list]
) -> dict[str, tuple[int | str, str, list[str]]]:
  """Exit status, output and what is left of each line of `FLAGS`."""
  lines = [['link', *line.split()] for line in FLAGS]
  folder = tmp_path_factory.mktemp('bad')
  return dict(zip(FLAGS, ask(lines, folder), strict=True))


@pytest.mark.parametrize('line', FLAGS)
def test_bad_input_is_one_line_and_leaves_nothing(
  answers: dict[str, tuple[int | str, str, list[str]]], line: str
) -> None:
  status, said, left = answers[line]
  assert status == 2, said
  assert said.count('\n') == 1
  assert said.startswith('waggle link: ')
  assert re.search(FLAGS[line], said)
  assert left == []
