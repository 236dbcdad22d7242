"""Tracks as CSV: what is one, and what is refused in which line."""

from collections.abc import Callable
import pathlib
import subprocess

import numpy as np
import pytest
import tracks_kit as kit

from waggle_tasks import scenario
from waggle_tasks.experiments.video import recordings, track_file
from waggle_tasks.protocol import mocom, payload, performance

Waggle = Callable[..., subprocess.CompletedProcess[str]]
Part = recordings.RecordingPart
FOCAL_PX = 400.0


def places(
  path: pathlib.Path, text: str, part: Part = Part()
) -> list[list[float]]:
  """Times with places and widths of a file."""
  path.write_text(text, encoding='utf-8')
  file = track_file.TrackFile(path, FOCAL_PX)
  return [[t, *place.tolist()] for place, t in file.places(part)]


@pytest.fixture
def path(tmp_path: pathlib.Path) -> pathlib.Path:
  return tmp_path / 'x.csv'


NAN = np.nan


@pytest.mark.parametrize(
  ('text', 'expected'),
  [
    ('1,2,3\n2,4,5\n', [[0, 2, 3, NAN], [1, 4, 5, NAN]]),
    ('time,x,y\n1,2,3\n2,4,5\n', [[0, 2, 3, NAN], [1, 4, 5, NAN]]),
    (
      '# of mine\ny_px, time_ms ,other,x_px\n\n3,1000,a,2\n5,1500,b,4\n',
      [[0, 2, 3, NAN], [0.5, 4, 5, NAN]],
    ),
    (
      'time_us,x_px,y_px,width_px\n0,1,2,9\n1e6,,,\n2e6,nan,NaN,8\n',
      [[0, 1, 2, 9], [1, NAN, NAN, NAN], [2, NAN, NAN, 8]],
    ),
    (
      'time_s,x_m,up_m,width_m\n0,0,0,.13\n1,.13,-.26,.13\n',
      [[0, 0, 0, 40], [1, 40, 80, 40]],
    ),
    (
      'time_s,x_mm,y_mm\n0,0,0\n1,130,260\n',
      [[0, 0, 0, NAN], [1, 40, 80, NAN]],
    ),
  ],
)
def test_columns_are_known_by_their_names_and_units(
  path: pathlib.Path, text: str, expected: list[list[float]]
) -> None:
  np.testing.assert_allclose(places(path, text), expected, atol=1e-9)


@pytest.mark.parametrize(
  ('text', 'match'),
  [
    ('time_s,x_px\n0,1\n', 'line 1: columns must be one time'),
    ('time_s,x_px,y_ft\n0,1,2\n', 'line 1: columns must be one time'),
    ('time_s,x_px,y_m\n0,1,2\n', 'line 1: all places must be in one unit'),
    ('time_s,x_px,y_px,up_px\n0,1,2,3\n', 'line 1: columns must be one time'),
    ('time_s,x_px,x_m,y_px\n0,1,2,3\n', 'line 1: only one column may'),
    ('0,1,2\n1,left,2\n', "line 2: x must be a number.*'left'"),
    ('0,1,2\n\n1,2\n', 'line 3: x and y must both be there'),
    ('0,1,2\n1,2,inf\n', 'line 2: y must be a number'),
    ('0,1,2\n,2,3\n', 'line 2: there must be a time'),
    ('0,1,2\n1,1,2\n0.5,1,2\n', 'line 3: the time must be later than 1 s'),
    ('0,1,2\n0,1,2\n', 'line 2: the time must be later'),
    (
      'time,x,y,width\n0,1,2,3\n1,1,2,0\n',
      'line 3: the width must be positive',
    ),
    ('time,x,y\n0,1,2\n', 'at least 2 places: got 1'),
    ('', 'at least 2 places: got 0'),
    ('0,1,2\n9000,1,2\n', 'at most 3600 s long'),
    ('0,1,"2\n', 'no CSV'),
  ],
)
def test_a_line_that_is_none_is_refused_with_its_number(
  path: pathlib.Path, text: str, match: str
) -> None:
  with pytest.raises(recordings.RecordingError, match=match):
    places(path, text)


def test_what_is_no_file_or_no_text_is_refused(path: pathlib.Path) -> None:
  with pytest.raises(recordings.RecordingError, match='cannot be read'):
    track_file.TrackFile(path, FOCAL_PX)
  path.write_bytes(b'\xff\xfe\x00,1,2\n')
  with pytest.raises(recordings.RecordingError, match='no text'):
    track_file.TrackFile(path, FOCAL_PX)


def test_only_the_part_that_was_asked_for_is_read(path: pathlib.Path) -> None:
  text = ''.join(f'{k / 10},{k},0\n' for k in range(50))
  rows = places(path, text, Part(start_s=1.0, end_s=2.0, speed=2.0))
  assert [row[1] for row in rows] == [*range(10, 21)]
  assert rows[0][0] == pytest.approx(2.0)
  with pytest.raises(recordings.RecordingError, match='`start` must lie'):
    places(path, text, Part(start_s=9.0))


def test_places_that_are_too_near_in_time_are_one(path: pathlib.Path) -> None:
  text = ''.join(f'{k / 1000},{k},0\n' for k in range(100))
  assert len(places(path, text)) == 10


def written(
  path: pathlib.Path, rows: tuple[np.ndarray, np.ndarray]
) -> pathlib.Path:
  lines = [f'{t:.4f},{x:.2f},{y:.2f}' for t, (x, y) in zip(*rows, strict=True)]
  path.write_text('\n'.join(['time_s,x_px,y_px', *lines]))
  return path


@pytest.mark.slow
def test_the_command_reads_tracks_and_says_why_it_does_not(
  waggle: Waggle, path: pathlib.Path
) -> None:
  dance = scenario.Scenario(language='swift', payload='101101')
  rows = kit.seen(dance.agreement, dance.performance)
  track = str(written(path, rows))
  child = waggle('decode', track, '--agreement=swift')
  assert child.returncode == 0, child.stderr
  assert child.stdout.endswith('joint: message 101101\n')
  assert 'the target seen in 100.0 %' in child.stdout
  cut = waggle('decode', track, '--agreement=swift', '--start=2')
  assert cut.returncode == 1
  assert 'the track begins in motion: no rest to learn' in cut.stdout
  assert cut.stdout.endswith('joint: no message\n')


BAD = {
  '--roi=0,0,99,99': '`roi` is about pictures',
  '--fps=25': '`fps` is about pictures',
  '--receiver=klt': 'for tracks',
  '--config=x': '`agreement` and `config` say the same',
  '--camera=0': '`camera` takes no FOLDER|RECORDING beside it',
}


@pytest.mark.slow
def test_flags_that_say_nothing_of_a_track_are_refused(
  ask: Callable[..., list], path: pathlib.Path
) -> None:
  path.write_text('0,1,2\n1,1,2\n')
  lines = [['decode', path.name, '--agreement=swift', flag] for flag in BAD]
  answers = ask(lines, path.parent)
  for (status, said, _), expected in zip(answers, BAD.values(), strict=True):
    assert (status, expected in said) == (2, True), said


@pytest.mark.slow
def test_the_command_reads_mocom_with_nulls_that_its_gaps_hold(
  waggle: Waggle, path: pathlib.Path
) -> None:
  message = payload.Payload.from_bits('100101')
  flown = performance.Performance(
    mocom.timeline(message, np.random.RandomState(3)), says=message
  )
  rows = kit.seen(mocom.AGREEMENT, flown)
  child = waggle('decode', str(written(path, rows)), '--agreement=mocom')
  assert child.returncode == 0, child.stdout
  assert child.stdout.endswith('view_bank:hold_s=1.02: message 100101\n')
