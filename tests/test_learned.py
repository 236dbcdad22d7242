"""The receiver that has learned what symbols look like."""

from collections.abc import Callable
import dataclasses
import pathlib
import subprocess
import sys
import types

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import (
  group,
  klt,
  learned_weights,
  lock,
  network,
  receiver,
  receivers,
  slots,
  windows,
)
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.experiments.studies import learned_tracks, learned_training
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import controls, decoys, gestures, payload, sights

IMAGE = np.zeros((16, 16, 3), np.uint8)
Read = Callable[..., list[str]]


def agreed(language: str) -> agreement_lib.Agreement:
  return scenario.Scenario(language=language).agreement


class Told:
  """A tracker that is told where the target is."""

  def __init__(self, tracks: list[klt.Track]) -> None:
    self.anchor_px = tracks[0].centre_px
    self.ghost = types.SimpleNamespace(anchor_px=self.anchor_px)
    self._tracks = iter(tracks)

  def step(self, image: np.ndarray, time_s: float) -> list[klt.Track]:
    del image, time_s
    return [next(self._tracks)]


def dance(
  agreement: agreement_lib.Agreement, control: str, bits: str, seed: int
) -> list[klt.Track]:
  """A track of a dance from somewhere, as a tracker would see it."""
  rng = np.random.default_rng(seed)
  said = payload.Payload.from_bits(bits, agreement.units)
  told = controls.perform(control, said, seed, agreement, 0.0).schedule
  times_s = np.arange(0.0, told.end_s + 4.0, 0.04)
  offsets_m = np.zeros((len(times_s), 3))
  for row, at_s in zip(offsets_m, times_s, strict=True):
    place = told.motion(float(at_s))[0]
    row[: len(place)] = place
  angle, away_m = np.radians(rng.uniform(-60, 60)), rng.uniform(0.8, 3.0)
  (places_m,) = sights.project(offsets_m, np.array([angle]), away_m)
  places_m += rng.normal(0.0, 0.002, places_m.shape)
  places_px = places_m * agreement.camera.focal_px / away_m + (320.0, 240.0)
  return [
    klt.Track(float(at_s), place_px, 0.0, 100, 1.0, True)
    for at_s, place_px in zip(times_s, places_px, strict=True)
  ]


def read(
  agreement: agreement_lib.Agreement, tracks: list[klt.Track]
) -> list[str]:
  """The messages of a track."""
  reader = receivers.make('learned', agreement)
  reader._tracker = Told(tracks)
  events = [e for track in tracks for e in reader.step(IMAGE, track.time_s)]
  return [e.message.bits for e in events if e.message is not None]


@pytest.fixture(autouse=True)
def any_size(monkeypatch: pytest.MonkeyPatch) -> None:
  """Images that nobody looks at may be small."""
  monkeypatch.setattr('waggle_tasks.protocol.camera.MIN_SIDE_PX', 16)


@pytest.mark.slow
@pytest.mark.parametrize(
  ('language', 'place'),
  [
    ('swift', {'distance_m': 2.0, 'bearing_deg': 60}),
    pytest.param('paper', {}, marks=pytest.mark.long),
  ],
)
def test_a_message_is_read_and_flown(language: str, place: dict) -> None:
  scene = scenario.Scenario(
    observers=1, language=language, payload='011010', **place
  )
  flown = rollout.run(scene, 'learned')
  (outcome,) = evaluator.evaluate(scene, flown).outcomes
  assert outcome.decoded == '011010'
  assert not outcome.failures
  events = flown.events['observer_1']
  (end,) = [e for e in events if isinstance(e, receiver.Event) and e.word]
  assert end.word == scene.agreement.word('011010')
  assert end.clear >= 0.9


@pytest.mark.slow
@pytest.mark.parametrize('language', ['swift', 'paper'])
def test_tracks_are_read_from_everywhere(language: str) -> None:
  words = '000000', '101101', '111111', '010010'
  for seed, bits in enumerate(words if language == 'swift' else words[1:2]):
    tracks = dance(agreed(language), 'none', bits, seed)
    assert read(agreed(language), tracks) == [bits]


@pytest.mark.parametrize(
  ('language', 'control'),
  [
    pytest.param(
      language,
      control,
      marks=[pytest.mark.long] * (language == 'paper' or bool(number % 4)),
    )
    for language in learned_weights.TRAINED
    for number, control in enumerate(decoys.DECOYS)
  ],
)
def test_what_is_no_message_is_none(language: str, control: str) -> None:
  tracks = dance(agreed(language), control, '101101', 0)
  assert read(agreed(language), tracks) == []


def test_a_symbol_that_the_code_would_contradict_is_no_erasure() -> None:
  """START twice, and a word of which the code would make another one."""
  agreement = agreed('swift')
  tracks = dance(agreement, 'repeated', '101011', 1_000_009)
  assert read(agreement, tracks) == []


def test_a_symbol_that_was_hidden_is_filled_by_the_code() -> None:
  tracks = dance(agreed('swift'), 'none', '101101', 1)
  begin_s = 1.65 + 0.52 + 0.73  # The hover, and START.
  hidden = [
    dataclasses.replace(each, valid=not 0 <= each.time_s - begin_s < 0.7)
    for each in tracks
  ]
  assert read(agreed('swift'), hidden) == ['101101']


@pytest.mark.long
def test_a_bit_of_the_paper_that_was_hidden_is_not_guessed() -> None:
  tracks = dance(agreed('paper'), 'none', '101101', 1)
  hidden = [
    dataclasses.replace(each, valid=not 16 <= each.time_s < 23)
    for each in tracks
  ]
  assert read(agreed('paper'), hidden) == []


def test_the_same_track_is_read_the_same_way() -> None:
  agreement = agreed('swift')
  tracks = dance(agreement, 'none', '101101', 2)
  runs = []
  for _ in range(2):
    reader = receivers.make('learned', agreement)
    reader._tracker = Told(tracks)
    runs.append([e for t in tracks for e in reader.step(IMAGE, t.time_s)])
  assert runs[0] == runs[1] != []


@pytest.mark.parametrize(
  'agreement',
  [
    agreed('brisk'),
    agreement_lib.Agreement(codebook=gestures.v_codebook(half_width_m=0.2)),
  ],
  ids=['brisk', 'other gestures'],
)
def test_a_language_that_it_has_not_learned_is_refused(
  agreement: agreement_lib.Agreement,
) -> None:
  error = r"`language` must be one of \['paper', 'swift'\]"
  with pytest.raises(group.ReceiverError, match=error):
    receivers.make('learned', agreement)


@pytest.mark.parametrize(
  ('change', 'error'),
  [
    ('max_misfit=0.1', "`max_misfit` must not be given with 'learned'"),
    ('min_probability=0.3', '`min_probability` must be between 0.5 and 1'),
    ('max_left=-1', '`max_left` must be between 0 and 10'),
    ('sure=1', '`receiver number` must be one of'),
  ],
)
def test_numbers_that_it_does_not_take_are_refused(
  change: str, error: str
) -> None:
  with pytest.raises(group.ReceiverError, match=error):
    receivers.configured(f'learned:{change}')


def test_weights_that_were_changed_are_refused(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setattr(learned_weights, 'path', lambda name: tmp_path / name)
  learned_weights._read.cache_clear()
  with pytest.raises(group.ReceiverError, match='`swift` must be beside'):
    receivers.make('learned', agreed('swift'))
  (tmp_path / 'swift').write_bytes(b'0')
  with pytest.raises(group.ReceiverError, match='SHA-256 is another'):
    receivers.make('learned', agreed('swift'))


@pytest.mark.parametrize('name', learned_weights.TRAINED)
def test_weights_are_small(name: str) -> None:
  assert 10_000 < learned_weights.path(name).stat().st_size < 200_000


def test_what_was_not_seen_has_no_place_in_a_window() -> None:
  rows = [(0.04 * k, 320.0 + k, 240.0) for k in range(10)]
  pose = slots.Pose(np.array([320.0, 240.0]), 0.0, 100.0)
  found = windows.of(lock.Samples.of(rows), 0.0, 1.0, pose)
  seen = windows.times_s(1.0) <= 0.36 + 0.1
  np.testing.assert_array_equal(found.seen, seen)
  assert not found.places_m[~seen].any()
  np.testing.assert_allclose(
    found.places_m[:5, 0], windows.times_s(1.0)[:5] / 4, atol=1e-9
  )


@pytest.mark.long
def test_training_learns_and_weights_are_kept_as_they_are() -> None:
  spoken = agreed('swift').spoken
  tracks = learned_tracks.Tracks(spoken.alphabet, spoken.confirm_s)
  losses: list[float] = []
  found = learned_training.train(
    tracks, 3, 500, lambda step, loss: losses.append(loss)
  )
  assert losses[1] < losses[0] < 1.5  # By chance it is 2.3.
  kept = network.Network.of(found.arrays())
  for name, array in found.arrays().items():
    np.testing.assert_array_equal(array, kept.arrays()[name])


@pytest.mark.long
def test_the_weights_of_the_package_come_of_its_own_command(
  tmp_path: pathlib.Path,
) -> None:
  run = [sys.executable, '-m', 'waggle_tasks.experiments.train_learned']
  subprocess.run(
    [*run, 'swift', f'--output={tmp_path}'], check=True, timeout=500
  )
  (made,) = tmp_path.iterdir()
  # Libraries of other builds round elsewise.
  with np.load(made) as new, np.load(learned_weights.path('swift')) as kept:
    for name in kept:
      np.testing.assert_allclose(new[name], kept[name], rtol=0.05, atol=0.05)


@pytest.mark.slow
def test_training_refuses_a_language_that_there_is_not() -> None:
  run = [sys.executable, '-m', 'waggle_tasks.experiments.train_learned']
  child = subprocess.run(
    [*run, 'swfit'], capture_output=True, text=True, timeout=100
  )
  assert child.returncode == 2
  assert '`language` must be one of' in child.stderr
