"""What rotors did is kept, read back, and shown on the page of a run."""

from collections.abc import Callable
import dataclasses
import pathlib
import subprocess

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments import broadcast
from waggle_tasks.experiments.pages import document
from waggle_tasks.experiments.record import archive, flown, verdicts

Waggle = Callable[..., subprocess.CompletedProcess[str]]
SOME = flown.Flown(
  np.linspace(0.0, 0.2, 5),
  np.full((5, 4), 0.066),
  np.ones((5, 3)),
  np.full((5, 3), 0.01),
  np.zeros((5, 3)),
)


def test_flights_are_read_as_they_were_written(tmp_path: pathlib.Path) -> None:
  path = tmp_path / flown.NAME
  assert flown.load(path) == {}  # Of vehicles without rotors there are none.
  flown.save(path, {'performer': SOME, 'observer_1': SOME})
  first = path.read_bytes()
  again = flown.load(path)
  assert [*again] == ['performer', 'observer_1']
  for field in dataclasses.fields(flown.Flown):
    np.testing.assert_array_equal(
      getattr(again['performer'], field.name), getattr(SOME, field.name)
    )
  flown.save(path, again)
  assert path.read_bytes() == first


@pytest.mark.parametrize('damage', ['empty', 'half', 'other'])
def test_damaged_flights_are_refused_by_name(
  damage: str, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / flown.NAME
  flown.save(path, {'performer': SOME})
  if damage == 'other':
    np.savez(path, **{'performer.tilt_rad': np.zeros(3)})
  else:
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2 if damage == 'half' else 0])
  with pytest.raises(flown.FlownError, match='must be a file of flights'):
    flown.load(path)


@pytest.mark.slow
def test_a_run_with_rotors_shows_what_they_did(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  folder = tmp_path / 'run'
  child = waggle(
    'broadcast', '--dynamics=rotors', '--estimator=lighthouse', '--wind_mps=1',
    '--gusts', '--control=no_send', '--observers=1', '--duration_s=0.8',
    '--camera_width_px=64', '--camera_height_px=64', f'--output={folder}',
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  times_s = archive.load(folder).times_s
  flights = flown.load(folder / flown.NAME)
  assert [*flights] == ['performer', 'observer_1']
  for each in flights.values():
    assert each.thrusts_n.shape == (len(times_s), 4)
    np.testing.assert_allclose(
      each.thrusts_n.sum(axis=1), 0.027 * 9.81, rtol=0.1
    )
    assert each.tilt_rad.max() > 0.03
    assert np.linalg.norm(each.air_mps.mean(axis=0)) > 0.5
    assert np.abs(each.error_m).max() > 1e-5
  page = (folder / document.NAME).read_text(encoding='utf-8')
  assert '<h2>Rotors</h2>' in page
  for word in ('tilt', 'thrust', 'estimate', 'air', 'what a rotor can'):
    assert f'>{word}<' in page or word in page
  assert f'href="{flown.NAME}"' in page


def test_a_broadcast_tells_both_errors_of_an_estimate() -> None:
  outcome = verdicts.Outcome(
    'observer_1', '000010', '000010', error_m=0.012, estimate_error_m=0.001
  )
  verdict = verdicts.Verdict((outcome,))
  scene = scenario.Scenario(dynamics='rotors', estimator='mocap', observers=1)
  header, _, row, *_ = broadcast.report(scene, verdict).splitlines()
  assert 'by estimate' in header
  assert row.split()[-5:-2] == ['-', '12.0', '1.0']
  plain = broadcast.report(scenario.Scenario(observers=1), verdict)
  assert 'by estimate' not in plain
