"""A receiver from outside of the package, by its name alone, everywhere."""

from collections.abc import Callable
import json
import os
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest

from waggle_tasks.agents import receiver, receivers
from waggle_tasks.experiments.record import archive, nulls
from waggle_tasks.experiments.studies import ablations, variants

Waggle = Callable[..., subprocess.CompletedProcess[str]]
ROOT = pathlib.Path(__file__).parents[1]
DOCUMENT = (ROOT / 'docs' / 'receivers.md').read_text('utf-8')
WHOLE, TELLS = re.findall(r'```python\n(.*?)```', DOCUMENT, re.DOTALL)
SHORT = (
  '--half_width_m=0.12', '--start_height_m=0.25', '--gesture_s=2',
  '--initial_hover_s=3.2', '--settle_s=0.6', '--gap_s=2', '--lead_in_s=1.8',
)  # fmt: skip
NAME = 'plain:Plain:hold_s=2.9'


@pytest.fixture(scope='module')
def home(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
  """A folder that holds the documents' receiver."""
  folder = tmp_path_factory.mktemp('home')
  (folder / 'plain.py').write_text(WHOLE)
  return folder


@pytest.fixture(scope='module')
def flown(
  waggle: Waggle, home: pathlib.Path, tmp_path_factory: pytest.TempPathFactory
) -> tuple[pathlib.Path, str]:
  """A run folder of that receiver, and what was printed."""
  folder = tmp_path_factory.mktemp('runs') / 'run'
  child = waggle(
    'broadcast', f'--receiver={NAME}', '--raw', '--video', '--video_fps=1',
    '--view=observer_1', '--observers=1', '--payload=100110', *SHORT,
    f'--output={folder}', PYTHONPATH=str(home),
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  return folder, child.stdout


def test_the_documents_receiver_has_as_many_lines_as_they_say() -> None:
  lines = [line for line in WHOLE.splitlines() if line.strip()]
  readme = (ROOT / 'README.md').read_text('utf-8')
  assert f'a whole one in {len(lines)} lines' in ' '.join(readme.split())
  assert len(lines) < 40


@pytest.mark.slow
def test_it_reads_a_message_and_its_source_is_kept(
  flown: tuple[pathlib.Path, str],
) -> None:
  folder, said = flown
  assert 'Group passed: 1 of 1 observers decoded 100110.' in said
  assert archive.read_json(folder / 'config.json')['receiver'] == NAME
  assert 'plain' in archive.read_json(folder / 'provenance.json')['sources']


@pytest.mark.long
def test_its_raw_images_are_read_again_by_it_and_by_another(
  waggle: Waggle, home: pathlib.Path, flown: tuple[pathlib.Path, str]
) -> None:
  child = waggle(
    'decode', str(flown[0]), f'--receiver={NAME}',
    '--receiver=plain:Plain:levels=50,hold_s=2.8',
    PYTHONPATH=str(home),
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  same = f'{NAME}: message 100110; the same events as online, byte for byte'
  other = 'plain:Plain:levels=50,hold_s=2.8: message 100110'
  assert {same, other} <= {*child.stdout.splitlines()}


@pytest.mark.slow
def test_its_page_is_drawn_where_it_is_and_where_it_is_not(
  waggle: Waggle,
  home: pathlib.Path,
  flown: tuple[pathlib.Path, str],
  tmp_path: pathlib.Path,
) -> None:
  page = (flown[0] / 'index.html').read_text('utf-8')
  assert 'No track was kept.' in page
  assert 'Motions of observer_1' in page
  shutil.copytree(flown[0], tmp_path / 'run')
  for places in ({'PYTHONPATH': str(home)}, {}):
    child = waggle('report', 'run', cwd=tmp_path, **places)
    assert child.returncode == 0, child.stderr
    assert (tmp_path / 'run' / 'index.html').read_text('utf-8') == page


@pytest.fixture
def module(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[[str], str]:
  """Writes a module and returns its name, which no other test uses."""

  def write(text: str) -> str:
    name = f'own_{os.urandom(4).hex()}'
    (tmp_path / f'{name}.py').write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    return name

  return write


BARE = """
import dataclasses
from waggle_tasks.agents import receiver

@dataclasses.dataclass(frozen=True)
class Part:
  rate_hz: float = 3
  name: 'str | None' = None
  twice: int = 1

@dataclasses.dataclass(frozen=True)
class Numbers:
  part: Part = Part()
  on: bool = True
  off: bool = False
  count: int = 2
  sizes: tuple = (1, 2)
  twice: int = 1

  def __post_init__(self):
    if self.count > 9:
      raise ValueError(f'count is at most 9, not {self.count}')

class Bare(receiver.Receiver):
  DEFAULT = Numbers()
  def step(self, image, time_s):
    return ()
"""


def test_any_frozen_dataclass_takes_changes(
  module: Callable[[str], str],
) -> None:
  changes = 'rate_hz=2.5,name=a b,on=off,count=9'
  _, config = receivers.configured(f'{module(BARE)}:Bare:{changes}')
  assert (config.part.rate_hz, config.part.name) == (2.5, 'a b')
  assert (config.on, config.count, config.sizes) == (False, 9, (1, 2))


@pytest.mark.parametrize(
  ('text', 'name', 'error'),
  [
    (BARE, ':Bear', r"be a class of own_\w+, .* 'Bear'. Did you mean Bare"),
    (BARE, ':Numbers', r'`own_\w+:Numbers` must be a receiver: it lacks step'),
    (BARE, ':Bare:cont=1', "`receiver number` .*'cont'. Did you mean count"),
    (BARE, ':Bare:sizes=1', "must be one of .*: got 'sizes'"),
    (BARE, ':Bare:twice=2', '`twice` must be one number .*: it is part.twice'),
    (BARE, ':Bare:count=2.5', "`count` must be of type int: got '2.5'"),
    (BARE, ':Bare:rate_hz=nan', '`rate_hz` must be a finite number: got nan'),
    (BARE, ':Bare:on=1', '`on` must be one of'),
    (BARE, ':Bare:count=10', "must take 'count=10': count is at most 9"),
    (BARE, '', r"one of .*klt.* or package.module:Class: got 'own_\w+'"),
    (BARE, '/x.py:Bare', 'or package.module:Class: got'),
    (BARE, '.more:Bare', r"there is no module 'own_\w+.more'"),
    ('import nowhere', ':Bare', r'imported: own_\w+: ModuleNotFoundError'),
    ('1 / 0', ':Bare', r'imported: own_\w+: ZeroDivisionError'),
    ('def :', ':Bare', r'imported: own_\w+: SyntaxError'),
    ('import sys\nsys.exit()', ':Bare', 'imported: .*SystemExit'),
    ('Bare = 3', ':Bare', 'must be a receiver: it lacks step'),
    (
      'class Bare:\n  def step(self, image, time_s):\n    return ()',
      ':Bare',
      'must be a receiver: it lacks DEFAULT',
    ),
    (
      BARE.replace('DEFAULT = Numbers()', 'DEFAULT = 3'),
      ':Bare',
      'must be a frozen dataclass, or None .*: got 3',
    ),
    (
      BARE.replace('(frozen=True)\nclass Numbers', '\nclass Numbers'),
      ':Bare',
      'got Numbers, which is not frozen',
    ),
    (
      BARE.replace('image, time_s', 'image'),
      ':Bare',
      r'`step` of own_\w+:Bare must take \(image, time_s\)',
    ),
    (
      BARE + '  def __init__(self, agreement):\n    pass\n',
      ':Bare',
      r'must take \(agreement, config\)',
    ),
    (
      BARE.replace('(receiver.Receiver)', '')
      + '  def __init__(self, agreement, config):\n    self.track = None\n',
      ':Bare',
      'of which the last two may be None: it lacks segment',
    ),
  ],
)  # fmt: skip
def test_what_cannot_work_is_refused_before_it_is_flown(
  text: str, name: str, error: str, module: Callable[[str], str]
) -> None:
  with pytest.raises(receivers.ReceiverError, match=error):
    receivers.make(f'{module(text)}{name}')


@pytest.mark.slow
@pytest.mark.parametrize('command', ['suite', 'gallery', 'ablate', 'bench'])
def test_every_command_names_a_module_that_is_not_there(
  command: str, waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle(command, '--receiver=nowhere:Mine', cwd=tmp_path)
  assert child.returncode == 2
  assert "there is no module 'nowhere'" in child.stderr
  assert not [*tmp_path.iterdir()]


@pytest.mark.slow
def test_what_is_no_tuple_of_events_ends_in_one_line(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  (tmp_path / 'bare.py').write_text(BARE.replace('return ()', 'return None'))
  child = waggle(
    'broadcast', '--receiver=bare:Bare', '--control=no_send', cwd=tmp_path
  )
  assert child.returncode == 2
  said = '`step` of Bare must return a tuple of receiver.Event, mostly an empty'
  assert said in child.stderr.splitlines()[-1]


@pytest.mark.parametrize(
  ('returned', 'error'),
  [
    ('None', 'must return a tuple of receiver.Event, .*: got None at 2 s'),
    ('[]', r'must return a tuple of receiver.Event, .*: got \[\] at 2 s'),
    ('((time_s, "NULL"),)', 'must return a tuple of receiver.Event'),
    (
      '(event(2.0, "NULL", STATE),)',
      '`symbol` of an event of Bare must be Sym',
    ),
    ('(event(2.0, NULL, "start"),)', '`state` of an event of Bare must be St'),
    (
      '(event(2.0, NULL, STATE, message="000010"),)',
      "`message` of an event of Bare must be .*Payload .*: got '000010'",
    ),
    ('setattr(self, "track", 3) or ()', '`track` of Bare must be .*: got 3'),
    ('setattr(self, "segment", 3) or ()', '`segment` of Bare must be .*Segm'),
  ],
)
def test_what_nobody_could_use_is_refused_with_its_time(
  returned: str, error: str, module: Callable[[str], str]
) -> None:
  head = (
    'from waggle_tasks.agents.receiver import Event as event\n'
    'from waggle_tasks.protocol import frame, symbols\n'
    'NULL, STATE = symbols.Symbol.NULL, frame.State.START\n'
  )
  text = BARE.replace('return ()', f'return {returned}')
  reader = receivers.make(f'{module(head + text)}:Bare')
  image = np.zeros((480, 640, 3), np.uint8)
  with pytest.raises(receivers.ReceiverError, match=error):
    receiver.step(reader, image, 2.0)


def test_it_may_tell_what_its_nulls_take(module: Callable[[str], str]) -> None:
  plain = f'{module(WHOLE)}:Plain'
  assert nulls.needed_s(plain) is None
  head = 'from waggle_tasks.agents import description\n'
  telling = f'{module(f"{head}{WHOLE}{TELLS}")}:Plain'
  assert nulls.needed_s(telling) == pytest.approx(3.08)
  wrong = module(f'{BARE}  def describe(*_):\n    return 3')
  with pytest.raises(receivers.ReceiverError, match=r'`describe` of .* got 3'):
    nulls.needed_s(f'{wrong}:Bare')


def test_its_switches_are_what_is_ablated(module: Callable[[str], str]) -> None:
  name = f'{module(BARE)}:Bare:count=3'
  assert [each.receiver for each in ablations.of(name).values()] == [
    name, f'{name},on=off',
  ]  # fmt: skip
  receivers.make(f'{name},on=off')


def test_open_choices_but_for_the_papers_own_are_moved_with_it() -> None:
  moved = variants.of('plain:Plain')
  assert {each.receiver for each in moved.values()} == {'plain:Plain'}
  left_out = {*variants.VARIANTS} - {*moved}
  assert 'corners-few' in left_out
  assert 'dim' not in left_out


@pytest.mark.long
def test_an_edited_one_is_flown_anew(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  def identity() -> str:
    child = waggle(
      'sweep', '--receiver=bare:Bare', '--control=no_send', '--observers=1',
      '--duration_s=0.2', '--grid=distance_m=1.3', '--output=out',
      cwd=tmp_path,
    )  # fmt: skip
    assert child.returncode == 0, child.stderr
    (row,) = (tmp_path / 'out' / 'results.jsonl').read_text().splitlines()
    return json.loads(row)['identity']

  (tmp_path / 'bare.py').write_text(BARE)
  first = identity()
  (tmp_path / 'bare.py').write_text(f'{BARE}  # edited\n')
  assert identity() != first
