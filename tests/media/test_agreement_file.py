"""Agreements by name and as files, and the command that writes them."""

from collections.abc import Callable
import json
import pathlib
import subprocess

import pytest

from waggle_tasks import errors, plain, scenario
from waggle_tasks.experiments.record import agreement_file, writer
from waggle_tasks.protocol import agreement, languages, mocom

Waggle = Callable[..., subprocess.CompletedProcess[str]]


@pytest.mark.parametrize(
  ('name', 'expected'),
  [
    ('paper', agreement.Agreement()),
    ('mocom', mocom.AGREEMENT),
    ('swift', scenario.Scenario(language='swift').agreement),
    ('swift:parity=0', scenario.Scenario(language='swift:parity=0').agreement),
    ('brisk', scenario.Scenario(language='brisk').agreement),
  ],
)
def test_a_name_is_an_agreement_and_its_file_is_the_same(
  name: str, expected: agreement.Agreement, tmp_path: pathlib.Path
) -> None:
  found = agreement_file.find(name)
  assert found == expected
  path = tmp_path / 'x.json'
  path.write_text(agreement_file.text(found))
  assert agreement_file.find(str(path)) == expected


def test_the_configuration_of_a_run_is_an_agreement(
  tmp_path: pathlib.Path,
) -> None:
  scene = scenario.Scenario(language='rapid', camera_fovy_deg=50.0)
  path = tmp_path / 'config.json'
  path.write_text(json.dumps(writer.config(scene, 'joint')))
  assert agreement_file.find(str(path)) == scene.agreement


def test_a_language_of_ones_own_is_an_agreement(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'own.json'
  path.write_text(json.dumps(plain.to_plain(languages.LANGUAGES['swift'])))
  assert agreement_file.find(str(path)) == agreement_file.find('swift')


def test_some_fields_alone_change_the_papers(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'x.json'
  path.write_text('{"codebook": {"half_width_m": 0.2}, "units": {}}')
  found = agreement_file.find(str(path))
  assert found.codebook.lowest_m == -0.2
  assert found.pauses == agreement.Agreement().pauses


@pytest.mark.parametrize(
  ('text', 'match'),
  [
    ('{', 'must be one of paper, mocom'),
    ('[]', 'must hold a JSON object'),
    ('{}', '`agreement` must be a table'),
    ('{"codebok": {}}', 'Did you mean codebook'),
    ('{"agreement": {"pauses": {"gap_s": -1}}}', '`pauses.gap_s` must be'),
    ('{"camera": {"focal_px": "long"}}', '`camera.focal_px` must be'),
    ('{"format": 99, "agreement": {}}', 'a newer one wrote'),
    ('{"alphabet": {"count": 3}}', 'alphabet'),
  ],
)
def test_a_file_that_is_none_is_refused_with_its_reason(
  text: str, match: str, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'x.json'
  path.write_text(text)
  with pytest.raises(errors.WaggleError, match=match) as caught:
    agreement_file.find(str(path))
  assert 'x.json' in str(caught.value)


@pytest.mark.parametrize(
  ('name', 'match'),
  [
    ('mocon', 'Did you mean mocom'),
    ('swift:parity=99', 'parity'),
    ('nowhere.json', 'No such file'),
  ],
)
def test_a_name_of_nothing_is_refused(name: str, match: str) -> None:
  with pytest.raises(errors.WaggleError, match=match):
    agreement_file.find(name)


def test_the_command_prints_a_file_that_is_read_again(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle('agreement', 'mocom')
  assert child.returncode == 0, child.stderr
  path = tmp_path / 'mine.json'
  path.write_text(child.stdout)
  assert agreement_file.find(str(path)) == mocom.AGREEMENT
