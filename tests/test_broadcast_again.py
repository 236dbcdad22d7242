"""`waggle broadcast --config`: a run is flown again, as it was or changed."""

from collections.abc import Callable
import json
import pathlib
import subprocess

import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.record import archive, writer
from waggle_tasks.protocol import gestures, timing

Waggle = Callable[..., subprocess.CompletedProcess[str]]

SCENE = scenario.Scenario(
  control='no_send',
  observers=1,
  duration_s=0.2,
  seed=7,
  jitter_m=0.01,
  codebook=gestures.v_codebook(half_width_m=0.2),
  pauses=timing.Timing(gap_s=2.5),
)


@pytest.fixture
def config(tmp_path: pathlib.Path) -> pathlib.Path:
  """The config.json of a run."""
  path = tmp_path / 'config.json'
  path.write_text(json.dumps(writer.config(SCENE, 'view_bank')))
  return path


@pytest.mark.slow
def test_a_run_is_flown_again_with_its_receiver(
  waggle: Waggle, config: pathlib.Path, tmp_path: pathlib.Path
) -> None:
  child = waggle(
    'broadcast', f'--config={config}', '--output=run', cwd=tmp_path
  )
  assert child.returncode == 0, child.stderr
  again = tmp_path / 'run' / 'config.json'
  assert json.loads(again.read_text()) == json.loads(config.read_text())


@pytest.mark.slow
def test_flags_beside_it_change_what_it_says(
  waggle: Waggle, config: pathlib.Path, tmp_path: pathlib.Path
) -> None:
  given = (
    f'--config={config}', '--output=run', '--seed=3', '--noise_sigma=2',
    '--gesture_s=8', '--receiver=klt',
  )  # fmt: skip
  child = waggle(
    'broadcast', f'--config={config}', *given, '--output=run', cwd=tmp_path
  )
  assert child.returncode == 0, child.stderr
  path = tmp_path / 'run' / 'config.json'
  made = archive.read_scenario(path)
  assert archive.read_config(path).receiver == 'klt'
  assert (made.seed, made.sensor.noise_sigma) == (3, 2.0)
  assert made.codebook == gestures.v_codebook(0.2, duration_s=8.0)
  assert (made.pauses, made.jitter_m) == (SCENE.pauses, 0.01)
  command = archive.read_json(tmp_path / 'run' / 'provenance.json')['command']
  assert f'--config={config}' in command


def test_a_scenario_that_cannot_be_made_is_told_with_its_field(
  config: pathlib.Path,
) -> None:
  table = json.loads(config.read_text())
  table['scenario']['pauses']['gap_s'] = -1
  config.write_text(json.dumps(table))
  error = r'json is damaged: `scenario\.pauses\.gap_s` must be between 0 and 60'
  with pytest.raises(archive.ArchiveError, match=error):
    archive.read_scenario(config)
  table['scenario'] = {'layout': {'Rows': {'radius_m': 1.0}}}
  config.write_text(json.dumps(table))
  error = r"`scenario\.layout` must be a table .*'package\.module:Class'"
  with pytest.raises(archive.ArchiveError, match=error):
    archive.read_scenario(config)


@pytest.mark.slow
def test_a_config_that_is_not_there_is_named(waggle: Waggle) -> None:
  child = waggle('broadcast', '--config=nothing.json')
  assert child.returncode == 2
  error = '`config` must be the config.json of a run: nothing.json is no file'
  assert child.stderr == f'waggle broadcast: {error}\n'
