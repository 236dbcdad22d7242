"""Levels of fidelity: one scenario and one seed, with pictures or without."""

from collections.abc import Callable
import dataclasses
import json
import pathlib
import subprocess
from typing import Any

import numpy as np
import pytest

from waggle_tasks import errors, registry, scenario
from waggle_tasks.experiments.episodes import (
  ladder_row,
  ladder_table,
  low_level,
  sight_lines,
  track_errors,
  track_level,
  word_level,
)
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.results import ladder_tables
from waggle_tasks.experiments.studies import (
  ladder_flight,
  ladder_study,
  sweep_cases,
)

Waggle = Callable[..., subprocess.CompletedProcess[str]]
SWIFT = {'language': 'swift', 'observers': 1}


def scene(**values: object) -> scenario.Scenario:
  return scenario_fields.make({**SWIFT, 'fidelity': 'tracks', **values})


def read(**values: object) -> list[str | None]:
  """What each observer reads of tracks."""
  verdict, _ = low_level.run(scene(**values), 'joint')
  return [outcome.decoded for outcome in verdict.outcomes]


@pytest.fixture(scope='module')
def rendered() -> ladder_row.Row:
  """A broadcast on both levels, in which all hover and images are lost."""
  values = {
    **scenario_fields.defaults(), **SWIFT, 'payload': '101101',
    'performer_hover': 'mocap', 'observer_hover': 'mocap',
    'dropped_share': 0.2, 'jitter_m': 0.01, 'distance_m': 1.0,
    'bearing_deg': 30.0,
  }  # fmt: skip
  case = dataclasses.replace(sweep_cases.draw({}, values, 0), receiver='joint')
  cell = {'condition': 'own', 'distance_m': 1.0, 'bearing_deg': 30.0}
  case = dataclasses.replace(case, cell=cell)
  return ladder_flight.fly(lambda done_s: None, case, 'identity', True)


def test_a_rendered_message_is_read_of_its_track_too(
  rendered: ladder_row.Row,
) -> None:
  assert rendered.pixels == rendered.tracks == rendered.sent == '101101'
  assert rendered.pixels_s > 3 * rendered.tracks_s


def test_the_target_is_seen_where_geometry_has_it(
  rendered: ladder_row.Row,
) -> None:
  # The same jitter, hover and losses were drawn: else it would be off by many.
  assert rendered.track is not None
  assert max(rendered.track.spread_px) < 3
  assert np.abs(rendered.track.bias_px).max() < 6
  assert rendered.track.lost < 0.1


def test_a_case_is_the_same_at_every_level() -> None:
  values = {**scenario_fields.defaults(), **SWIFT, 'payload': 'random'}
  drawn = [
    sweep_cases.draw({}, {**values, 'fidelity': level}, 3)
    for level in ('pixels', 'tracks', 'symbols')
  ]
  assert len({(each.scene.seed, each.scene.payload) for each in drawn}) == 1


def test_an_observer_gets_the_images_that_a_sensor_lets_through() -> None:
  lossy = {'dropped_share': 0.4, 'late_frames': 3, 'repeated_share': 0.2}
  pixels = scene(fidelity='pixels', duration_s=3.0, seed=5, **lossy)
  environment = registry.environment(pixels)
  for each in environment.task.observers:
    each.observables.camera.enabled = False
  try:
    timestep, came_s = environment.reset(), set()
    rest = [np.zeros(spec.shape) for spec in environment.action_spec()]
    for action, seen in zip(rest, timestep.observation, strict=True):
      action[:3] = seen['position_m']
    while not timestep.last():
      came_s.add(round(float(timestep.observation[0]['time_s']), 6))
      timestep = environment.step(rest)
  finally:
    environment.close()
  (sight,) = sight_lines.of(dataclasses.replace(pixels, fidelity='tracks'))
  told_s = [round(time_s, 6) for time_s, _ in sight.images()]
  assert set(told_s) >= came_s
  assert set(told_s) - came_s <= {round(float(sight.times_s[-1]), 6)}


def test_what_is_read_of_tracks_follows_from_the_seed() -> None:
  first, again = (track_level.read(scene(seed=3), 'joint') for _ in range(2))
  assert first == again
  other = track_level.read(scene(seed=4), 'joint')
  assert [e.clear for e in first[0]] != [e.clear for e in other[0]]


@pytest.mark.parametrize(
  ('values', 'expected'),
  [
    ({'observers': 2, 'distance_m': 0.9}, ['000010'] * 2),
    ({'noise_sigma': 4.0, 'bearing_deg': -50.0}, ['000010']),
    ({'bits': '1101', 'language': 'rapid'}, ['1101']),
    ({'blackout_s': 0.0, 'blackout_length_s': 600.0}, [None]),
    ({'blackout_s': 3.0, 'blackout_length_s': 2.0}, [None]),
    (
      {'blackout_s': 3.0, 'blackout_length_s': 2.0, 'repeat': 2},
      ['000010'],
    ),
    ({'control': 'interrupted', 'stop_s': 4.0, 'duration_s': 15.0}, [None]),
    ({'control': 'no_send'}, [None]),
    ({'control': 'black_input', 'observers': 2}, ['000010', None]),
  ],
)
def test_tracks_are_read_as_pictures_are(
  values: dict[str, Any], expected: list[str | None]
) -> None:
  assert read(**values) == expected


@pytest.mark.parametrize(
  'control', ['swapped', 'half_frame', 'five_bits', 'circles']
)
def test_what_is_no_message_is_read_of_no_track(control: str) -> None:
  assert read(control=control, seed=2) == [None]


@pytest.mark.parametrize(
  ('values', 'named'),
  [
    ({'dynamics': 'rotors'}, '`dynamics` must be'),
    ({'occluder_every_s': 5.0}, '`occluder_every_s` must be 0.0'),
    ({'eye': 'phone'}, "`eye` must be 'ideal' .* got 'phone'"),
    ({'photons': 100.0}, '`photons` must be 0.0'),
    ({'blackout_length_s': 1.0, 'blackout_share': 0.5}, '`blackout_share`'),
    ({'performer_hover': 'mocap'}, '`observer_hover`'),
    ({'camera_width_px': 320}, '`camera_width_px`'),
    ({'fidelity': 'paths'}, "'tracks'"),
  ],
)
def test_what_was_not_measured_is_refused(
  values: dict[str, Any], named: str
) -> None:
  with pytest.raises(errors.ScenarioError, match=named):
    scene(**values)


@pytest.mark.parametrize(
  ('values', 'reader', 'named'),
  [
    ({}, 'view_bank', "`receiver` must be 'joint'"),
    ({'distance_m': 3.9}, 'joint', '`distance_m` must be'),
    ({'bearing_deg': 80.0}, 'joint', '`bearing_deg` must be'),
    ({'noise_sigma': 20.0}, 'joint', '`noise_sigma` must be'),
    ({'fidelity': 'symbols', 'noise_sigma': 5.0}, 'joint', 'conditions'),
    ({'fidelity': 'symbols', 'control': 'swapped'}, 'joint', '`control`'),
    ({'fidelity': 'symbols', 'language': 'brisk'}, 'joint', '`language`'),
  ],
)
def test_what_the_table_does_not_tell_is_refused(
  values: dict[str, Any], reader: str, named: str
) -> None:
  with pytest.raises(ladder_table.LadderError, match=named):
    low_level.check([scene(**values)], reader)


def test_no_environment_is_made_of_a_level_without_pictures() -> None:
  with pytest.raises(errors.ScenarioError, match=r'`fidelity` must be'):
    registry.environment(scene())


def test_errors_that_are_drawn_are_those_that_were_fitted() -> None:
  track = ladder_table.Track(
    (1.0, -2.0), (0.0, 0.02), (0.5, 0.8), (0.3, 0.9), 0.1, 3.0, 30.0
  )
  (sight,) = sight_lines.of(scene(repeat=60))
  places_px, seen = track_errors.draw(
    sight, track, 1.0, np.random.default_rng(0)
  )
  frames = np.arange(len(seen))
  found = track_errors.fit(sight, frames, places_px, seen, 30.0)
  assert found is not None
  assert found.spread_px == pytest.approx(track.spread_px, rel=0.1)
  assert found.memory == pytest.approx(track.memory, abs=0.05)
  assert found.bias_px == pytest.approx(track.bias_px, abs=0.2)
  assert found.slope == pytest.approx(track.slope, abs=0.003)
  assert found.lost == pytest.approx(0.1, abs=0.02)
  assert found.run == pytest.approx(3.0, rel=0.15)


def test_a_target_that_was_not_found_is_not_read() -> None:
  table = ladder_table.read()
  cells = tuple(dataclasses.replace(c, tracks=()) for c in table.cells)
  blind = dataclasses.replace(table, cells=cells)
  assert track_level.read(scene(), 'joint', blind) == [[]]


@pytest.mark.slow
def test_words_are_read_as_often_as_was_measured() -> None:
  cells = tuple(
    ladder_table.Cell('calm', 1.0, angle, 1000, read, 0, (0.2,), ())
    for angle, read in ((0.0, 900), (60.0, 300))
  )
  table = ladder_table.Table('', 'swift', 'joint', '', '', cells)
  shares = {
    angle: np.mean(
      [
        word_level.read(
          scene(
            fidelity='symbols', seed=seed, distance_m=1.0, bearing_deg=angle
          ),
          table,
        )[0].correct
        for seed in range(100)
      ]
    )
    for angle in (0.0, 30.0, 60.0)
  }
  assert shares[0.0] == pytest.approx(0.9, abs=0.1)
  assert shares[30.0] == pytest.approx(0.6, abs=0.15)
  assert shares[60.0] == pytest.approx(0.3, abs=0.15)


def test_few_frames_leave_open_how_often_words_are_read() -> None:
  few, many = (
    ladder_table.Cell('calm', 1.0, 0.0, count, count, 0, (), ())
    for count in (3, 300)
  )
  rng, spreads = np.random.default_rng(0), []
  for cell in (few, many):
    table = ladder_table.Table('', 'swift', 'joint', '', '', (cell,))
    spreads.append(word_level.shares([cell], table, 4000, rng).std())
  assert spreads[0] > 5 * spreads[1]


def test_the_table_of_the_package_is_whole() -> None:
  table = ladder_table.read()
  assert len(table.cells) == 100
  assert sum(cell.wrong for cell in table.cells) == 0
  assert all(cell.read <= cell.sent for cell in table.cells)
  assert table.language == ladder_study.LANGUAGE
  assert len(ladder_tables.measured(table).splitlines()) == 7


@pytest.mark.parametrize('text', ['', '{}', '{"format": 2, "cells": 3}'])
def test_a_damaged_table_is_refused(tmp_path: pathlib.Path, text: str) -> None:
  path = tmp_path / 'ladder.json'
  path.write_text(text)
  with pytest.raises(ladder_table.LadderError, match=r'must be a table'):
    ladder_table.read(path)


def test_a_table_is_written_as_it_is_read(tmp_path: pathlib.Path) -> None:
  table = ladder_table.read()
  path = tmp_path / 'again.json'
  path.write_text(ladder_table.text(table))
  assert ladder_table.read(path) == table
  assert json.loads(path.read_text())['command'].startswith('waggle ladder')


def test_levels_that_differ_are_told_apart() -> None:
  right = ladder_row.Row(
    identity='', condition='calm', distance_m=1.0, angle_deg=0.0, sent='1',
    pixels='1', tracks='1',
  )  # fmt: skip
  missed = dataclasses.replace(right, tracks=None)
  assert ladder_tables.Agreement.of([right] * 5 + [missed]).inside
  apart = ladder_tables.Agreement.of([right] * 2 + [missed] * 6)
  assert not apart.inside
  assert (apart.only_pixels, apart.only_tracks) == (6, 0)


@pytest.mark.slow
def test_a_sweep_of_tracks_needs_no_pictures(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle(
    'sweep', '--fidelity=tracks', '--language=swift', '--observers=1',
    '--grid=distance_m=0.8,2.2', '--payload=random', '--workers=1',
    '--output=made', cwd=tmp_path,
  )  # fmt: skip
  assert done.returncode == 0, done.stderr
  rows = (tmp_path / 'made' / 'results.jsonl').read_text().splitlines()
  tables = [json.loads(row) for row in rows]
  assert [table['renderer'] for table in tables] == ['none'] * 2
  assert all(table['outcomes'][0]['right'] for table in tables)


@pytest.mark.slow
def test_a_broadcast_without_pictures_prints_what_was_read(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle(
    'broadcast', '--fidelity=symbols', '--language=swift', '--observers=1',
    cwd=tmp_path,
  )  # fmt: skip
  assert done.returncode == 0, done.stderr
  assert '1 of 1 observers decoded 000010' in done.stdout
  bad = waggle('broadcast', '--fidelity=tracks', cwd=tmp_path)
  assert bad.returncode == 2
  assert '`language`' in bad.stderr or '`receiver`' in bad.stderr
  assert not [*tmp_path.iterdir()]


def test_a_ladder_is_not_measured_and_compared_at_once(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle('ladder', '--measure', '--validate', cwd=tmp_path)
  assert done.returncode == 2
  assert '`measure` and `validate`' in done.stderr


@pytest.mark.parametrize(
  ('control', 'seed', 'payload', 'distance_m', 'dropped_share'),
  [
    ('repeated', 3611760087, '010100', 0.6, 0.0),
    ('repeated', 4026767841, '110010', 2.0, 0.0),
    ('start_repeated', 3538090164, '000101', 2.0, 0.3),
    ('begun_anew', 2770043873, '001000', 2.0, 0.3),
  ],
)
def test_a_word_with_one_wrong_level_is_not_mended(
  control: str, seed: int, payload: str, distance_m: float, dropped_share: float
) -> None:
  # Each is one level beside a word of the code, which a wander could explain.
  assert read(
    control=control, seed=seed, payload=payload, distance_m=distance_m,
    dropped_share=dropped_share,
  ) == [None]  # fmt: skip
