"""Films that cameras, phones and editors make: read in full, or said why not.

Each is read with PyAV, and without it by OpenCV as far as OpenCV can.
"""

from collections.abc import Callable
import fractions
import pathlib
import resource
import signal
import struct
import subprocess
import sys

import cv2
import numpy as np
import pytest

from waggle_tasks.experiments.video import encoders, recordings

av = pytest.importorskip('av')
small = pytest.importorskip('small_films', exc_type=ImportError)

Waggle = Callable[..., subprocess.CompletedProcess[str]]
Part = recordings.RecordingPart
MENDS = r"pip install 'waggle-tasks\[video\]'"


@pytest.fixture
def no_pyav(monkeypatch: pytest.MonkeyPatch) -> None:
  """Has the import of PyAV fail, as where it is not installed."""
  monkeypatch.setitem(sys.modules, 'av', None)
  name = 'waggle_tasks.experiments.video.pyav_film'
  monkeypatch.delitem(sys.modules, name, raising=False)
  package = sys.modules['waggle_tasks.experiments.video']
  monkeypatch.delattr(package, 'pyav_film', raising=False)


def read(
  path: pathlib.Path, part: Part = Part(), fps: float | None = None
) -> tuple[list[np.ndarray], list[float], recordings.Recording]:
  """All pictures, their times, and the recording."""
  with recordings.Recording(path, fps) as recording:
    pairs = [(i.copy(), t) for i, t in recording.frames(part)]
  return [i for i, _ in pairs], [t for _, t in pairs], recording


def assert_whole(path: pathlib.Path, fps: float | None = None) -> None:
  """Whether a film gives all its pictures, rightly, in their times."""
  images, times_s, recording = read(path, fps=fps)
  np.testing.assert_allclose(times_s, np.arange(75) / 25, atol=2e-3)
  size = recording.width, recording.height
  for image, wanted in zip(images, small.pictures(size), strict=True):
    # Encoders blur; left-over memory and mixed-up pictures are far away.
    assert np.abs(image.astype(int) - wanted).mean() < 6


KINDS = {
  'mp4': {},
  'matroska': {'name': 'x.mkv'},
  'quicktime': {'name': 'x.mov'},
  'flash': {'name': 'x.flv'},
  'transport stream': {'name': 'x.ts'},
  'later transport stream': {'name': 'x.ts', 'begin_s': 30},
  'begins at 30 s': {'begin_s': 30},
  'matroska begins at 30 s': {'name': 'x.mkv', 'begin_s': 30},
  'longer sound': {'sound_s': 10.0},
  'matroska, longer sound': {'name': 'x.mkv', 'sound_s': 10.0},
  'transport stream, longer sound': {'name': 'x.ts', 'sound_s': 10.0},
  'shorter sound': {'name': 'x.mkv', 'sound_s': 1.0},
  'mpeg-4 avi': {'name': 'x.avi', 'codec': 'mpeg4'},
  'motion jpeg': {'name': 'x.avi', 'codec': 'mjpeg', 'pixels': 'yuvj420p'},
  'hevc': {'codec': 'libx265', 'options': {'x265-params': 'log-level=none'}},
  'vp8': {'name': 'x.webm', 'codec': 'libvpx'},
  'vp9': {'name': 'x.webm', 'codec': 'libvpx-vp9'},
  '10 bit': {'pixels': 'yuv420p10le'},
  '4:2:2': {'pixels': 'yuv422p'},
  '4:4:4': {'pixels': 'yuv444p'},
  'prores': {
    'name': 'x.mov', 'codec': 'prores_ks', 'pixels': 'yuv422p10le',
  },
  'odd size': {
    'name': 'x.mkv', 'codec': 'ffv1', 'pixels': 'bgr0', 'size': (97, 65),
  },
  'long groups': {'options': {'bf': '4', 'g': '250'}},
  'old windows': {'name': 'x.wmv', 'codec': 'wmv2'},
  'h.264 in avi': {'name': 'x.avi'},
  'mpeg-4 avi with b-frames': {
    'name': 'x.avi', 'codec': 'mpeg4', 'options': {'bf': '2'},
  },
}  # fmt: skip
# What OpenCV cannot tell from damage, and where it has no times for the end.
LONGER = (
  'matroska begins at 30 s', 'matroska, longer sound',
  'transport stream, longer sound',
)  # fmt: skip
UNTOLD = ('h.264 in avi', 'mpeg-4 avi with b-frames')
INTERLACED = {
  'h.264': {'options': {'x264-params': 'interlaced=1:tff=1'}},
  'mpeg-2': {
    'name': 'x.mpg', 'codec': 'mpeg2video', 'size': (320, 240),
    'options': {'flags': '+ildct+ilme'},
  },
  'dv': {'name': 'x.dv', 'codec': 'dvvideo', 'size': (720, 576)},
}  # fmt: skip
AV1 = {'codec': 'libsvtav1', 'size': (128, 96), 'options': {'preset': '12'}}


def made(
  folder: pathlib.Path, name: str = 'x.mp4', **how: object
) -> pathlib.Path:
  return small.write(folder / name, **how)


@pytest.mark.parametrize('kind', KINDS)
def test_a_healthy_film_is_read_in_full(
  kind: str, tmp_path: pathlib.Path
) -> None:
  assert_whole(made(tmp_path, **KINDS[kind]))


@pytest.mark.usefixtures('no_pyav')
@pytest.mark.parametrize('kind', KINDS)
def test_without_pyav_it_is_read_or_the_error_names_the_extra(
  kind: str, tmp_path: pathlib.Path
) -> None:
  path = made(tmp_path, **KINDS[kind])
  if kind in LONGER:
    with pytest.raises(recordings.RecordingError, match=MENDS):
      read(path)
  elif kind in UNTOLD:  # OpenCV has no times for the last ones.
    _, times_s, _ = read(path)
    np.testing.assert_allclose(times_s, np.arange(len(times_s)) / 25)
    assert len(times_s) >= 73
  else:
    assert_whole(path)


@pytest.mark.parametrize('kind', INTERLACED)
def test_interlaced_pictures_are_right(
  kind: str, tmp_path: pathlib.Path
) -> None:
  path = made(tmp_path, **INTERLACED[kind])
  images, times_s, _ = read(path)
  assert len(times_s) == 75
  assert np.abs(images[9].astype(int) - images[60]).max() > 50
  assert all(80 < image.mean() < 100 for image in images)


@pytest.mark.slow
@pytest.mark.usefixtures('no_pyav')
@pytest.mark.parametrize('kind', [*INTERLACED.values(), AV1])
def test_what_opencv_cannot_decode_names_the_line_that_mends_it(
  kind: dict[str, object], tmp_path: pathlib.Path
) -> None:
  path = made(tmp_path, **kind)
  for part in (Part(), Part(start_s=1.0), Part(end_s=2.0)):
    with pytest.raises(recordings.RecordingError, match=MENDS):
      read(path, part)


def test_av1_is_read(tmp_path: pathlib.Path) -> None:
  assert_whole(made(tmp_path, **AV1))


@pytest.mark.slow
def test_longer_sound_is_a_note(waggle: Waggle, tmp_path: pathlib.Path) -> None:
  path = made(tmp_path, 'x.mkv', sound_s=10.0)
  child = waggle('decode', str(path))
  assert child.returncode == 1, child.stderr  # No message in it.
  assert '75 pictures to 2.96 s' in child.stdout
  assert 'and its pictures end at 2.96 s.' in child.stdout


def test_a_longer_subtitle_is_no_damage(tmp_path: pathlib.Path) -> None:
  text = tmp_path / 'x.srt'
  text.write_text('1\n00:00:50,000 --> 00:01:05,000\nhello\n\n')
  path = tmp_path / 'y.mkv'
  plain = made(tmp_path)
  with (
    av.open(str(text)) as words,
    av.open(str(plain)) as film,
    av.open(str(path), 'w') as out,
  ):
    pairs = [
      (source, out.add_stream_from_template(source.streams[0]))
      for source in (film, words)
    ]
    for source, copy in pairs:
      for packet in source.demux():
        if packet.dts is not None:
          packet.stream = copy
          out.mux(packet)
  assert_whole(path)
  assert '65.00 s' in read(path)[2].note


def edited(path: pathlib.Path, length_ms: int, from_ticks: int) -> None:
  """Has an MP4 show a part of its last track only."""
  data = bytearray(path.read_bytes())
  place = data.rindex(b'elst') + 12
  struct.pack_into('>2i', data, place, length_ms, from_ticks)
  path.write_bytes(data)


@pytest.mark.parametrize('name', ['x.mp4', 'x.mov'])
def test_an_edit_list_trims(name: str, tmp_path: pathlib.Path) -> None:
  path = made(tmp_path, name)
  edited(path, 1000, 1024)
  _, times_s, recording = read(path)
  np.testing.assert_allclose(times_s, np.arange(25) / 25, atol=1e-3)
  assert recording.note == ''


def turned(path: pathlib.Path, matrix: tuple[int, int, int, int]) -> None:
  """Writes a, b, c and d of the display matrix of an MP4's last track."""
  data = bytearray(path.read_bytes())
  place = data.rindex(b'tkhd') + 44
  a, b, c, d = (value << 16 for value in matrix)
  struct.pack_into('>9i', data, place, a, b, 0, c, d, 0, 0, 0, 1 << 30)
  path.write_bytes(data)


TURNS = {
  'right': ((0, 1, -1, 0), lambda i: np.rot90(i, -1)),
  'left': ((0, -1, 1, 0), lambda i: np.rot90(i, 1)),
  'upside down': ((-1, 0, 0, -1), lambda i: np.rot90(i, 2)),
  'mirrored': ((-1, 0, 0, 1), lambda i: i[:, ::-1]),
  'mirrored and turned': ((0, 1, 1, 0), lambda i: i.transpose(1, 0, 2)),
}


@pytest.mark.parametrize('turn', TURNS)
def test_a_picture_is_turned_as_the_container_says(
  turn: str, tmp_path: pathlib.Path
) -> None:
  matrix, wanted = TURNS[turn]
  path = made(tmp_path, 'x.mov', sound_s=1.0)
  plain, _, _ = read(path)
  turned(path, matrix)
  edited(path, 2000, 1024)
  images, times_s, recording = read(path)
  assert len(times_s) >= 50
  np.testing.assert_array_equal(images[20], wanted(plain[20]))
  assert (recording.height, recording.width) == images[0].shape[:2]


@pytest.mark.usefixtures('no_pyav')
@pytest.mark.parametrize('turn', ['right', 'left', 'upside down'])
def test_opencv_turns_a_picture_too(turn: str, tmp_path: pathlib.Path) -> None:
  matrix, wanted = TURNS[turn]
  path = made(tmp_path, 'x.mov')
  plain, _, _ = read(path)
  turned(path, matrix)
  images, _, recording = read(path)
  np.testing.assert_array_equal(images[20], wanted(plain[20]))
  assert (recording.height, recording.width) == images[0].shape[:2]


@pytest.mark.parametrize('without', [False, True])
@pytest.mark.parametrize('name', ['x.mp4', 'x.mkv'])
def test_pixels_become_square(
  name: str, without: bool, request: pytest.FixtureRequest,
  tmp_path: pathlib.Path,
) -> None:  # fmt: skip
  if without:
    request.getfixturevalue('no_pyav')
  path = made(tmp_path, name, aspect=fractions.Fraction(4, 3))
  images, _, recording = read(path)
  assert (recording.width, recording.height) == (128, 64)
  across = images[40][32, :, 2] < 75  # The disc is orange.
  assert across.sum() == pytest.approx(13 * 4 / 3, abs=2)


@pytest.mark.parametrize(
  ('name', 'container'),
  [('x.h264', 'h264'), ('x.hevc', 'hevc'), ('x.mjpeg', 'mjpeg')],
)
@pytest.mark.parametrize('without', [False, True])
def test_a_stream_without_times_takes_a_rate(
  name: str, container: str, without: bool,
  request: pytest.FixtureRequest, tmp_path: pathlib.Path,
) -> None:  # fmt: skip
  codec = {'h264': 'libx264', 'hevc': 'libx265', 'mjpeg': 'mjpeg'}[container]
  pixels = 'yuvj420p' if codec == 'mjpeg' else 'yuv420p'
  quiet = {'x265-params': 'log-level=none'} if codec == 'libx265' else {}
  path = made(
    tmp_path, name, codec=codec, container=container, pixels=pixels,
    options=quiet,
  )  # fmt: skip
  if without:
    request.getfixturevalue('no_pyav')
  assert_whole(path, fps=25.0)
  if not (without and codec == 'mjpeg'):  # OpenCV makes its times up.
    with pytest.raises(recordings.RecordingError, match='a second with --fps'):
      read(path)


def test_a_rate_beside_times_is_refused(tmp_path: pathlib.Path) -> None:
  with pytest.raises(recordings.RecordingError, match='`fps` is for pictures'):
    read(made(tmp_path), fps=25.0)


def test_pictures_that_nearly_coincide_are_one(tmp_path: pathlib.Path) -> None:
  times_s = [n / 25 for n in range(75)]
  times_s[40] = times_s[39] + 11e-6
  path = made(tmp_path, 'x.mp4', times_s=times_s)
  _, read_s, _ = read(path)
  assert len(read_s) == 74
  assert min(np.diff(read_s)) > 0.03


def test_fast_cameras_are_thinned_out(tmp_path: pathlib.Path) -> None:
  path = made(tmp_path, times_s=[n / 240 for n in range(75)])
  _, read_s, _ = read(path)
  assert np.diff(read_s) == pytest.approx(1 / 80, abs=1e-3)
  assert len(read(path, Part(speed=4.0))[1]) == 75


def numbered(folder: pathlib.Path, names: Callable[[int], str]) -> pathlib.Path:
  """The film as pictures in a folder."""
  folder.mkdir()
  for number, image in enumerate(small.pictures()):
    assert cv2.imwrite(str(folder / names(number)), image[..., ::-1])
  return folder


@pytest.mark.parametrize(
  'names',
  [
    lambda n: f'frame_{n:04d}.png',
    lambda n: f'2026-05-01 {n + 7}.jpg',
    lambda n: f'{n:03d}-left.JPEG',
  ],
)
def test_a_folder_of_numbered_pictures_is_a_recording(
  names: Callable[[int], str], tmp_path: pathlib.Path
) -> None:
  folder = numbered(tmp_path / 'pictures', names)
  (folder / 'Thumbs.db').write_text('')
  assert_whole(folder, fps=25.0)


def test_a_picture_that_was_not_taken_leaves_a_gap(
  tmp_path: pathlib.Path,
) -> None:
  folder = numbered(tmp_path / 'pictures', lambda n: f'{n}.png')
  (folder / '30.png').unlink()
  _, times_s, _ = read(folder, fps=25.0)
  assert max(np.diff(times_s)) == pytest.approx(0.08)


@pytest.mark.parametrize(
  ('change', 'fps', 'match'),
  [
    (lambda f: None, None, 'how many a second with --fps'),
    (lambda f: None, 0.0, '`fps` must be between'),
    (
      lambda f: (f / '3.png').rename(f / 'three.png'), 25.0,
      'must have a number in their names: .*three.png has none',
    ),
    (
      lambda f: (f / '3.png').rename(f / '04.png'), 25.0,
      'numbers of their own: got 04.png and 4.png',
    ),
    (
      lambda f: (f / '3.png').write_bytes(b'x'), 25.0,
      '3.png holds no picture that can be read',
    ),
    (
      lambda f: cv2.imwrite(str(f / '3.png'), np.zeros((32, 32), np.uint8)),
      25.0, 'changes the size of its picture at 0.12 s',
    ),
  ],
)  # fmt: skip
def test_a_folder_that_is_no_recording_says_why(
  change: Callable[[pathlib.Path], object],
  fps: float | None,
  match: str,
  tmp_path: pathlib.Path,
) -> None:
  folder = numbered(tmp_path / 'pictures', lambda n: f'{n}.png')
  change(folder)
  with pytest.raises(recordings.RecordingError, match=match):
    read(folder, fps=fps)


def test_the_command_reads_a_folder_of_pictures(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  folder = numbered(tmp_path / 'pictures', lambda n: f'{n}.png')
  child = waggle('decode', str(folder), '--fps=25')
  assert child.returncode == 1, child.stderr
  assert '96 x 64' in child.stdout
  assert '75 pictures to 2.96 s' in child.stdout


@pytest.mark.parametrize('size', [(64, 8), (8, 64)])
def test_pictures_of_a_few_rows_are_refused(
  size: tuple[int, int], tmp_path: pathlib.Path
) -> None:
  path = small.write(tmp_path / 'x.mkv', 'ffv1', 'bgr0', size=size)
  with pytest.raises(recordings.RecordingError, match='at least 16 pixels'):
    read(path)


@pytest.mark.parametrize('without', [False, True])
def test_a_colon_in_a_name_is_no_protocol(
  without: bool,
  request: pytest.FixtureRequest,
  monkeypatch: pytest.MonkeyPatch,
  tmp_path: pathlib.Path,
) -> None:
  made(tmp_path).rename(tmp_path / '18:30.mp4')
  monkeypatch.chdir(tmp_path)
  if without:
    request.getfixturevalue('no_pyav')
  assert_whole(pathlib.Path('18:30.mp4'))


@pytest.mark.slow
@pytest.mark.parametrize('ending', ['webm', 'mp4'])
def test_an_annotated_copy_may_have_a_colon_in_its_name(
  ending: str, waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  made(tmp_path)
  child = waggle('decode', 'x.mp4', f'--annotate=18:31.{ending}', cwd=tmp_path)
  assert child.returncode == 1, child.stderr
  assert len(read(tmp_path / f'18:31.{ending}')[1]) > 30


@pytest.mark.slow
@pytest.mark.parametrize('ending', ['webm', 'mp4'])
def test_a_full_disk_loses_the_copy_and_not_what_was_read(
  ending: str, tmp_path: pathlib.Path
) -> None:
  made(tmp_path)
  copy = tmp_path / f'seen.{ending}'

  def limit() -> None:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))

  child = subprocess.run(
    [
      sys.executable, '-m', 'waggle_tasks.experiments.main', 'decode',
      str(tmp_path / 'x.mp4'), f'--annotate={copy}',
    ],
    capture_output=True, text=True, check=False, preexec_fn=limit,
  )  # fmt: skip
  assert child.returncode == 2
  assert 'klt: no message' in child.stdout
  (said,) = child.stderr.splitlines()
  assert f'seen.{ending}' in said
  assert 'could not be written' in said
  assert not copy.exists()


def test_a_name_that_is_no_utf8_is_refused_in_a_line(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  made(tmp_path)
  for arguments in (['lat\udce9.mp4'], ['x.mp4', '--annotate=lat\udce9.webm']):
    (tmp_path / arguments[0]).touch()
    child = waggle('decode', *arguments, cwd=tmp_path)
    assert child.returncode == 2
    (said,) = child.stderr.splitlines()
    assert 'UTF-8' in said
    assert 'lat' in said


@pytest.mark.parametrize('name', ['x.ts', 'x.mp4'])
def test_what_is_before_a_damage_can_be_read(
  name: str, tmp_path: pathlib.Path
) -> None:
  path = made(tmp_path, name, options={'g': '5', 'bf': '0'})
  data = bytearray(path.read_bytes())
  middle = len(data) // 2
  data[middle : middle + len(data) // 8] = bytes(len(data) // 8)
  path.write_bytes(data)
  with pytest.raises(recordings.RecordingError) as caught:
    read(path)
  assert 'cut short or damaged' in str(caught.value)
  end_s = float(str(caught.value).rpartition('--end=')[2])
  _, times_s, _ = read(path, Part(end_s=end_s))
  assert times_s[-1] == pytest.approx(end_s, abs=0.05)


def test_a_transport_stream_may_begin_anywhere(tmp_path: pathlib.Path) -> None:
  path = made(tmp_path, 'x.ts', options={'g': '10'})
  data = path.read_bytes()
  path.write_bytes(data[len(data) // 188 // 3 * 188 :])
  assert 30 < len(read(path)[1]) < 75


def test_a_film_without_an_announced_length_is_bounded_all_the_same(
  tmp_path: pathlib.Path,
) -> None:
  path = made(tmp_path, 'x.h264', container='h264')
  assert len(read(path, Part(end_s=9.0), fps=25.0)[1]) == 75
  with pytest.raises(recordings.RecordingError, match='at most 3600 s long'):
    read(path, fps=0.01)


@pytest.mark.parametrize('name', ['x.webm', 'x.mp4'])
def test_a_video_goes_to_a_folder_with_a_colon_in_its_name(
  name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path
) -> None:
  monkeypatch.chdir(tmp_path)
  path = pathlib.Path('18:30', name)
  path.parent.mkdir()
  encoder = encoders.make(path, (96, 64), 25)
  for image in small.pictures():
    encoder.write(image)
  encoder.close()
  assert_whole(path)


def test_a_picture_of_another_size_is_refused(tmp_path: pathlib.Path) -> None:
  first = made(tmp_path, 'a.ts')
  second = made(tmp_path, 'b.ts', size=(128, 96), begin_s=3)
  first.write_bytes(first.read_bytes() + second.read_bytes())
  with pytest.raises(recordings.RecordingError, match='changes the size'):
    read(first)
