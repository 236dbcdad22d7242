"""What a scenario changes of the default one, said on pages and in films."""

import dataclasses

import pytest

from waggle_tasks import scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.record import (
  changes,
  eye_fields,
  scenario_fields,
  writer,
)
from waggle_tasks.experiments.video import film, panel
from waggle_tasks.protocol import gestures
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import hover

# A value of each field that is not its default.
OTHERS = {
  'control': 'interrupted', 'layout': 'line', 'payload': '111111',
  'duration_s': 9.0, 'camera': 'full', 'floor': 'plain', 'walls': 'clutter',
  'sun': 'moving', 'shadows': True, 'bystanders': 2, 'observers': 2,
  'seed': 7, 'black_observer': 1, 'late_frames': 3, 'stop_s': 20.0,
  'occluder_mps': 1.5, 'step_gain': 2.0, 'half_span_deg': 20.0,
  'heading_step_deg': 30.0, 'flicker_hz': 3.0, 'photons': 100.0,
  'occluder_every_s': 30.0, 'rate_hz': 50.0, 'camera_width_px': 320,
  'camera_height_px': 240, 'heading_bits': 4, 'distance_bits': 3,
  'performer_hover': 'mocap', 'observer_hover': 'flow_deck',
  'hover_log': scenario_fields.table()['hover_log'].told(
    hover.Spectrum(*[(0.5,) * hover.BANDS] * 6)
  ),
  'language': 'swift', 'bits': '01', 'repeat': 2,
  'dynamics': 'rotors', 'estimator': 'mocap', 'gusts': True, 'downwash': True,
  'safety': 'avoid', 'meaning': 'place', 'furniture': 3, 'fidelity': 'tracks',
  'eye': 'webcam', 'lens': 'fisheye', 'grey': True, 'mosaic': True,
  'well_electrons': 100.0, 'codec': 'jpeg', 'jpeg_quality': 50, 'h264_crf': 30,
}  # fmt: skip


def value(name: str) -> object:
  """A value that is not the default of a field."""
  if name in OTHERS:
    return OTHERS[name]
  usual = scenario_fields.defaults()[name]
  return usual * 0.9 if usual else 0.01


def made(**values: object) -> scenario.Scenario:
  usual = scenario_fields.defaults()
  return scenario_fields.make(eye_fields.filled(usual | values, usual))


def test_the_default_scenario_changes_nothing() -> None:
  assert changes.of(scenario.Scenario()) == []


@pytest.mark.parametrize('name', scenario_fields.defaults())
def test_every_field_that_is_changed_is_said(name: str) -> None:
  other = value(name)
  extra = {}
  if name.startswith('occluder'):
    extra = {'occluder_every_s': 20.0}
  if name.endswith('_bits'):
    extra = {'payload': '0000010'}
  if name == 'hover_log':
    extra = {'performer_hover': 'log'}
  if name in ('estimator', 'wind_mps', 'gusts', 'downwash'):
    extra = {'dynamics': 'rotors'}
  if name in ('bits', 'repeat', 'fidelity'):
    extra = {'language': 'swift'}
  if name in ('k1', 'k2', 'k3', 'p1', 'p2'):
    extra = {'lens': 'brown'}
  if name == 'k4':
    extra = {'lens': 'fisheye'}
  if name == 'gusts':
    extra['wind_mps'] = 1.0
  said = changes.of(made(**{**extra, name: other}))
  assert any(each.startswith(f'{name}=') for each in said)
  assert len(said) == 1 + len(extra.keys() - {name})


def test_what_is_said_makes_the_same_scenario() -> None:
  scene = made(noise_sigma=5.0, shadows=True, gesture_s=4.0, bystanders=1)
  read = {}
  for each in changes.of(scene):
    name, _, text = each.partition('=')
    read[name] = scenario_fields.parse(name, text)
  assert made(**read) == scene


def test_an_archived_configuration_says_the_same() -> None:
  scene = made(noise_sigma=5.0, gap_s=2.5, half_width_m=0.2)
  fields = writer.config(scene, 'klt')['scenario']
  assert changes.among(fields) == changes.of(scene)


def test_a_layout_and_a_codebook_of_ones_own_are_named() -> None:
  usual = gestures.v_codebook()
  book = gestures.Codebook(
    tuple(
      dataclasses.replace(each, corners_m=((0, 0), (0.2, 0.1), (0, 0)))
      if each.symbol is Symbol.END
      else each
      for each in usual.gestures
    )
  )
  scene = scenario.Scenario(layout=layouts.Line(1.3, 0.6), codebook=book)
  assert changes.of(scene) == ['layout=Line', 'codebook=own']


def test_a_film_has_room_for_every_change() -> None:
  names = [*scenario_fields.defaults()]
  changed = [f'{name}=0.123456' for name in names]
  lines = panel.notes(changed)
  assert ', '.join(lines) == ', '.join(changed)
  plan = film.layout.plan(3, 1.0, len(lines))
  assert plan.notes.bottom <= min(each.top for each in plan.observers)
  for line in lines:
    assert film.page.panel.pen.width_px(line, 13) <= plan.notes.width
