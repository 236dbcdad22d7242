"""Parts from installed packages: by their names, in every command."""

from collections.abc import Callable, Iterator
import pathlib
import shutil
import subprocess
import sys

import pytest

import waggle_tasks
from waggle_tasks import doors, errors, layouts, scenarios
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.episodes import identity, outside

Waggle = Callable[..., subprocess.CompletedProcess[str]]
TEMPLATE = pathlib.Path(__file__).parents[1] / 'examples' / 'template'


@pytest.fixture(scope='session')
def site(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
  """A folder in which the template is installed, without a network."""
  home = tmp_path_factory.mktemp('doors')
  shutil.copytree(TEMPLATE, home / 'source')
  command = (
    sys.executable, '-m', 'pip', 'install', '--quiet', '--no-deps',
    '--no-index', '--no-build-isolation', '--no-compile',
    f'--target={home / "site"}', str(home / 'source'),
  )  # fmt: skip
  child = subprocess.run(command, capture_output=True, text=True, check=False)
  assert child.returncode == 0, child.stderr
  return home / 'site'


@pytest.fixture
def installed(
  site: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[None]:
  """Puts it where Python looks for packages."""
  monkeypatch.syspath_prepend(site)
  yield
  sys.modules.pop('waggle_template', None)


@pytest.fixture
def offered(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., None]:
  """Installs a package that offers what it is told to."""
  monkeypatch.syspath_prepend(tmp_path)

  def offer(package: str, group: str, **points: str) -> None:
    home = tmp_path / f'{package}-1.0.dist-info'
    home.mkdir()
    (home / 'METADATA').write_text(f'Name: {package}\nVersion: 1.0\n')
    lines = [f'{name} = {value}' for name, value in points.items()]
    text = '\n'.join([f'[waggle_tasks.{group}]', *lines, ''])
    (home / 'entry_points.txt').write_text(text)
    doors._listed.cache_clear()

  return offer


def test_the_template_is_short() -> None:
  lines = [
    line
    for path in TEMPLATE.iterdir()
    if path.suffix in ('.py', '.toml')
    for line in path.read_text('utf-8').splitlines()
  ]
  assert len(lines) <= 60


@pytest.mark.usefixtures('installed')
def test_every_part_of_the_template_is_found_by_its_name() -> None:
  assert 'waggle_template' not in sys.modules
  assert type(receivers.make('smooth')).__name__ == 'Smooth'
  _, numbers = receivers.configured('smooth:sigma_px=1.5')
  assert numbers.sigma_px == 1.5
  scene = scenarios.find('far', language='leisurely', layout='stairs')
  assert scene.agreement.language.pause_s == 2.0
  assert scene.poses()['observer_1'] == layouts.facing_performer(0.0, -1.3)
  changed = waggle_tasks.Scenario(language='leisurely:parity=1')
  assert changed.agreement.language.coding.parity == 1


@pytest.mark.usefixtures('installed')
def test_sources_of_what_is_offered_count_in_the_identity_of_results(
  site: pathlib.Path,
) -> None:
  plain = waggle_tasks.Scenario()
  stairs = waggle_tasks.Scenario(layout='stairs')
  for name, scene in (('smooth', plain), ('klt', stairs)):
    found = outside.paths(name, [scene])
    assert found['waggle_template'] == site / 'waggle_template.py'
  before = identity.of(plain, 'smooth', '')
  source = site / 'waggle_template.py'
  text = source.read_text()
  try:
    source.write_text(f'{text}# Changed.\n')
    assert identity.of(plain, 'smooth', '') != before
  finally:
    source.write_text(text)


@pytest.mark.slow
def test_a_command_takes_what_is_installed(
  waggle: Waggle, site: pathlib.Path, tmp_path: pathlib.Path
) -> None:
  child = waggle(
    'broadcast', '--receiver=smooth:sigma_px=0.6', '--language=leisurely',
    '--layout=stairs', '--observers=1', f'--output={tmp_path / "run"}',
    PYTHONPATH=str(site),
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  assert 'Group passed: 1 of 1 observers decoded 000010.' in child.stdout


def test_nothing_is_imported_before_its_name_is_looked_up(
  offered: Callable[..., None],
) -> None:
  offered('Broken', 'receivers', broken='no_such_module:Class')
  assert 'broken' in doors.names('receivers')
  receivers.make('klt')
  with pytest.raises(doors.DoorError, match='of Broken must be such'):
    receivers.make('broken')


@pytest.mark.parametrize(
  ('group', 'find'),
  [
    ('receivers', receivers.make),
    ('languages', lambda name: waggle_tasks.Scenario(language=name)),
    ('layouts', lambda name: waggle_tasks.Scenario(layout=name)),
    ('scenarios', scenarios.find),
  ],
)
def test_what_is_wrong_with_a_part_is_told_with_its_package(
  offered: Callable[..., None],
  group: str,
  find: Callable[[str], object],
) -> None:
  offered('One', group, twice='math:pi', number='math:pi', gone='math:pie')
  offered('Other', group, twice='math:tau')
  with pytest.raises(doors.DoorError, match="'twice' once: One and Other do"):
    find('twice')
  with pytest.raises(doors.DoorError, match="of One must be such that 'gone'"):
    find('gone')
  with pytest.raises(errors.WaggleError, match=r'number|3\.14'):
    find('number')
  with pytest.raises(errors.WaggleError, match='Did you mean twice'):
    find('twices')


def test_a_name_of_this_project_is_never_anothers(
  offered: Callable[..., None],
) -> None:
  offered('Thief', 'receivers', klt='math:pi')
  with pytest.raises(doors.DoorError, match="Thief must not offer 'klt'"):
    receivers.make('klt')
  offered('Poet', 'languages', swift='math:pi')
  with pytest.raises(doors.DoorError, match="Poet must not offer 'swift'"):
    waggle_tasks.Scenario(language='swift')
  # Scenarios are made as modules are imported: there this project's stands.
  offered('Mover', 'layouts', arc='math:pi')
  assert waggle_tasks.Scenario(layout='arc').poses()
  offered('Flyer', 'scenarios', broadcast='math:pi')
  assert scenarios.find('broadcast') == waggle_tasks.Scenario()


def test_dynamics_have_no_door_yet(offered: Callable[..., None]) -> None:
  offered('Flyer', 'dynamics', kites='math:pi')
  with pytest.raises(
    errors.ScenarioError, match='Flyer offers it, but dynamics cannot be added'
  ):
    waggle_tasks.Scenario(dynamics='kites')
