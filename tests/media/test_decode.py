"""Reading a dance again: replays, recordings, and files that are neither."""

from collections.abc import Callable
import fractions
import functools
import json
import os
import pathlib
import subprocess
import sys
import time
import wave

import cv2
import numpy as np
import pytest

from waggle_tasks import suites
from waggle_tasks.agents import config, group, receivers
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import capture, reader, writer
from waggle_tasks.experiments.video import recordings
from waggle_tasks.protocol import agreement, camera, gestures

Waggle = Callable[..., subprocess.CompletedProcess[str]]
Part = recordings.RecordingPart
WANTED = ['NULL', 'START', 'NULL', '0', 'NULL']


def decoded(
  path: pathlib.Path, part: Part = Part(), zoom: float = 1.0
) -> tuple[list[str], reader.Reader]:
  """The symbols of a recording, and the reader that read them."""
  seen = camera.Camera(focal_px=zoom * camera.Camera.focal_px)
  short = gestures.v_codebook(0.12, 0.25, 2.0)
  work = reader.Reader('klt', agreement.Agreement(short, camera=seen))
  with recordings.Recording(path) as recording:
    for image, time_s in recording.frames(part):
      work.take(image, time_s)
  return [str(event.symbol) for event in work.events], work


@pytest.fixture(scope='module')
def dance(
  clip: object, video: Callable[..., pathlib.Path]
) -> Callable[..., pathlib.Path]:
  """The clip as a video, its pictures changed by a function."""

  @functools.cache
  def write(
    change: Callable[[np.ndarray], np.ndarray] = np.ascontiguousarray,
    name: str = 'x.mp4',
    codec: str = 'mp4v',
    fps: float = 25.0,
  ) -> pathlib.Path:
    return video([change(i) for i in clip.images], name, codec, fps)

  return write


@pytest.mark.parametrize('observer', ['observer_1', 'observer_2'])
def test_a_replay_gives_the_online_events_byte_for_byte(
  recorded: object, observer: str
) -> None:
  path = recorded.folder / 'raw' / f'{observer}.capture'
  (work,) = reader.replay(path, ['klt'], recorded.scene.agreement)
  assert reader.differences(work, recorded.folder, observer) == ''
  expected = recorded.verdict.outcomes[int(observer[-1]) - 1].decoded
  assert work.message == expected


@pytest.mark.slow
def test_a_replay_by_another_receiver_is_told_apart(recorded: object) -> None:
  path = recorded.folder / 'raw' / 'observer_1.capture'
  names = ['klt', 'klt:max_rmse=0.0001']
  same, strict = reader.replay(path, names, recorded.scene.agreement)
  assert reader.differences(same, recorded.folder, 'observer_1') == ''
  assert reader.differences(strict, recorded.folder, 'observer_1').startswith(
    '1 of 17 events are the same'
  )
  lines = reader.report([same, strict]).splitlines()
  assert lines[0].split()[:2] == ['time', 's']
  assert 'klt:max_rmse=0.0001' in lines[0]
  start = next(line for line in lines if 'START' in line)
  assert 'UNKNOWN' in start


@pytest.mark.slow
def test_images_that_others_are_than_those_of_the_message_are_noticed(
  copied: pathlib.Path, recorded: object
) -> None:
  source = copied / 'raw' / 'observer_1.capture'
  images = [(i.copy(), t) for i, t in capture.read(source)]
  images[3][0][0, 0] += 1  # Far from the target: events stay the same.
  with capture.Writer(source) as writer:
    for image, time_s in images:
      writer.write(image, time_s)
  (work,) = reader.replay(source, ['klt'], recorded.scene.agreement)
  assert reader.differences(work, copied, 'observer_1') == (
    'the images are not those that the message was made from'
  )


def test_the_command_replays_a_folder_with_receivers_side_by_side(
  waggle: Waggle, recorded: object
) -> None:
  child = waggle(
    'decode', str(recorded.folder), '--receiver=klt',
    '--receiver=klt:min_margin=0.6',
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  assert child.stdout.count('klt: message 000010; the same events') == 1
  assert child.stdout.count('klt: no message; the same events as') == 1
  assert 'klt:min_margin=0.6: no message' in child.stdout


@pytest.mark.slow
def test_the_command_notices_an_event_log_that_was_changed(
  waggle: Waggle, copied: pathlib.Path
) -> None:
  path = copied / 'events.jsonl'
  lines = [json.loads(line) for line in path.read_text().splitlines()]
  lines[0]['time_s'] += 0.04
  path.write_text(''.join(json.dumps(line) + '\n' for line in lines))
  child = waggle('decode', str(copied))
  assert child.returncode == 1
  assert '16 of 17 events are the same, 17 now' in child.stdout


@pytest.mark.long
def test_a_recording_is_read_in_the_language_of_a_run(
  recorded: object, video: Callable[..., pathlib.Path], waggle: Waggle
) -> None:
  """The dance is a short one, which is none in the paper's language."""
  path = recorded.folder / 'raw' / 'observer_1.capture'
  images = [image.copy() for image, _ in capture.read(path)]
  film = str(video(images, 'x.mp4', 'mp4v', 25.0))
  asked = f'--config={recorded.folder / "config.json"}'
  child = waggle('decode', film, asked)
  assert child.returncode == 0, child.stderr
  assert 'klt: message 000010' in child.stdout
  assert 'klt: no message' in waggle('decode', film).stdout


@pytest.mark.parametrize(
  ('name', 'codec'),
  [
    ('x.webm', 'VP80'),
    pytest.param('x.mp4', 'mp4v', marks=pytest.mark.long),
    pytest.param('x.mkv', 'FFV1', marks=pytest.mark.long),
  ],
)
def test_a_recording_in_any_container_reads_as_the_images_did(
  dance: Callable[..., pathlib.Path], name: str, codec: str
) -> None:
  symbols, work = decoded(dance(name=name, codec=codec))
  assert symbols == WANTED
  assert [e.time_s for e in work.events[:2]] == pytest.approx(
    [3.04, 6.0], abs=0.25
  )


def test_thresholds_follow_the_focal_length(
  dance: Callable[..., pathlib.Path],
) -> None:
  path = dance(lambda i: cv2.resize(i, (320, 240), None, 0, 0, cv2.INTER_AREA))
  symbols, work = decoded(path, zoom=0.5)
  assert symbols == WANTED
  spans_px = [e.recognition.span_px for e in work.events if e.recognition]
  assert min(spans_px) > 0.5 * config.RecognitionLimits().min_span_px
  assert decoded(path, zoom=2.0)[0] != WANTED


def shifted(image: np.ndarray) -> np.ndarray:
  """The image on a larger canvas, 150 px to the right and 60 px down."""
  return cv2.copyMakeBorder(image, 60, 30, 150, 10, cv2.BORDER_REPLICATE)


@pytest.mark.slow
@pytest.mark.parametrize(
  'part',
  [Part(anchor_px=(470.0, 300.0)), Part(roi=(150, 60, 640, 480))],
  ids=['anchor', 'roi'],
)
def test_a_target_away_from_the_middle_is_found(
  dance: Callable[..., pathlib.Path], part: Part
) -> None:
  path = dance(shifted)
  assert decoded(path, part)[0] == WANTED
  assert decoded(path)[0] != WANTED


@pytest.mark.slow
def test_a_recording_in_slow_motion_is_read_at_its_true_speed(
  dance: Callable[..., pathlib.Path],
) -> None:
  path = dance(fps=10.0)
  symbols, work = decoded(path, Part(speed=0.4))
  assert symbols == WANTED
  assert work.last_s == pytest.approx(15.8, abs=0.1)


@pytest.mark.slow
def test_only_the_part_that_was_asked_for_is_read(
  dance: Callable[..., pathlib.Path],
) -> None:
  symbols, work = decoded(dance(), Part(start_s=3.0, end_s=9.0))
  assert symbols[:1] == ['START']
  assert work.last_s <= 9.0
  assert work.chain.images == pytest.approx(6.0 * 25, abs=2)


@pytest.mark.slow
def test_times_come_from_the_container_not_from_a_rate(
  clip: object, tmp_path: pathlib.Path
) -> None:
  av = pytest.importorskip('av')
  path = tmp_path / 'x.mkv'
  times_s, last = [], None
  with av.open(str(path), 'w') as container:
    stream = container.add_stream('libx264', rate=25)
    stream.width, stream.height, stream.pix_fmt = 640, 480, 'yuv420p'
    for image, time_s in zip(clip.images, clip.times_s, strict=True):
      # As screen recorders do: nothing new, no picture, but one in 0.16 s.
      if image is last and time_s - times_s[-1] < 0.15:
        continue
      last = image
      picture = av.VideoFrame.from_ndarray(image, format='rgb24')
      picture.pts = round(time_s * 25)
      container.mux(stream.encode(picture))
      times_s.append(time_s)
    container.mux(stream.encode())
  with recordings.Recording(path) as recording:
    read_s = [time_s for _, time_s in recording.frames(Part())]
  assert len(times_s) < 0.8 * len(clip.times_s)
  np.testing.assert_allclose(read_s, times_s, atol=1e-3)
  assert decoded(path)[0] == WANTED


@pytest.mark.slow
def test_an_annotated_copy_shows_what_was_read_without_gl(
  waggle: Waggle,
  dance: Callable[..., pathlib.Path],
  tmp_path: pathlib.Path,
  no_gl: dict[str, str],
) -> None:
  path, source = tmp_path / 'seen.webm', dance()
  part = ('--start=3', '--end=7')
  child = waggle('decode', str(source), *part, f'--annotate={path}', **no_gl)
  assert child.returncode == 1, child.stderr  # No whole message in it.
  assert 'klt: no message' in child.stdout
  with recordings.Recording(path) as recording:
    pictures = [image.copy() for image, _ in recording.frames(Part())]
    assert recording.length_s == pytest.approx(4.0, abs=0.2)
  assert pictures[0].shape[:2] > (480, 640)
  again = waggle('decode', str(source), f'--annotate={path}')
  assert again.returncode == 2
  assert '`annotate` must be a new file' in again.stderr


@pytest.mark.long
@pytest.mark.parametrize('receiver', receivers.RECEIVERS)
@pytest.mark.parametrize(
  'name',
  [
    'default', 'heading-90', 'one-observer', 'span-45', 'line-jitter',
    'no-send', 'black-input', 'interrupted',
  ],
)  # fmt: skip
def test_replays_of_the_papers_cases_are_the_online_runs(
  name: str, receiver: str, tmp_path: pathlib.Path
) -> None:
  (case,) = (case for case in suites.find('paper') if case.name == name)
  with capture.Recorder(tmp_path) as recorder:
    rollout = rollout_lib.run(case.scene, receiver, [recorder])
  lines = writer.event_lines(rollout)
  (tmp_path / 'events.jsonl').write_text(''.join(f'{x}\n' for x in lines))
  for path in capture.paths(tmp_path):
    assert path.stat().st_size < 30e6
    (work,) = reader.replay(path, [receiver], case.scene.agreement)
    assert reader.differences(work, tmp_path, path.stem) == ''


@pytest.mark.long
@pytest.mark.parametrize(
  ('name', 'codec', 'options'),
  [
    ('x.mp4', 'libx264', {'crf': '28'}),
    ('x.webm', 'libvpx', {'crf': '10', 'b': '1M', 'cpu-used': '4'}),
  ],
)
def test_a_filmed_broadcast_still_says_the_same_when_encoded_again(
  waggle: Waggle,
  name: str,
  codec: str,
  options: dict[str, str],
  tmp_path: pathlib.Path,
) -> None:
  av = pytest.importorskip('av')
  child = waggle(
    'broadcast', '--observers=1', '--video', '--view=observer_1',
    '--novideo_marks', '--video_fps=25', f'--output={tmp_path / "run"}',
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  again = tmp_path / name
  with (
    av.open(str(tmp_path / 'run' / 'observer_1.webm')) as source,
    av.open(str(again), 'w') as target,
  ):
    stream = target.add_stream(codec, rate=25, options=options)
    stream.width, stream.height, stream.pix_fmt = 640, 480, 'yuv420p'
    for number, picture in enumerate(source.decode(video=0)):
      picture.pts, picture.time_base = number, fractions.Fraction(1, 25)
      target.mux(stream.encode(picture))
    target.mux(stream.encode())
  child = waggle('decode', str(again))
  assert child.returncode == 0, child.stdout
  assert child.stdout.splitlines()[-1] == 'klt: message 000010'


def damaged(data: bytes) -> bytes:
  """The bytes with two hundred of the middle ones changed."""
  out = bytearray(data)
  middle = np.arange(len(out) // 4, 3 * len(out) // 4)
  for place in np.random.RandomState(0).choice(middle, 200):
    out[place] ^= 0xFF
  return bytes(out)


def sound(path: pathlib.Path) -> None:
  with wave.open(str(path), 'wb') as file:
    file.setnchannels(1)
    file.setsampwidth(2)
    file.setframerate(8000)
    file.writeframes(bytes(160_000))


def sparse(path: pathlib.Path) -> None:
  with path.open('wb') as file:
    file.truncate(8 << 30)


BROKEN = {
  'missing': (lambda path: None, 'must be a video file: it is not there'),
  'empty': (lambda path: path.write_bytes(b''), 'is empty'),
  'a pipe': (os.mkfifo, 'must be a video file: it is no file'),
  'sound': (sound, 'holds no video that can be read: .* hold only sound'),
  'text': (lambda path: path.write_text('dance\n' * 999), 'holds no video'),
  'noise': (
    lambda path: path.write_bytes(np.random.RandomState(0).bytes(1 << 20)),
    'holds no video',
  ),
  'eight gigabytes of nothing': (sparse, 'holds no video'),
  'a list of links': (
    lambda path: path.write_text('#EXTM3U\n#EXTINF:9,\nhttp://10.0.0.1/x.ts\n'),
    'holds no video',
  ),
  'one picture': (
    lambda path: path.write_bytes(
      cv2.imencode('.png', np.zeros((64, 64, 3), np.uint8))[1].tobytes()
    ),
    'gave 1 pictures',
  ),
}


def refused(path: pathlib.Path, part: Part, match: str) -> None:
  """Whether a file is refused, soon, by one clear error."""
  began_s = time.monotonic()
  with pytest.raises(recordings.RecordingError, match=match):
    decoded(path, part)
  assert time.monotonic() - began_s < 20


@pytest.mark.parametrize('kind', BROKEN)
def test_what_is_no_video_is_refused(
  kind: str, tmp_path: pathlib.Path, capfd: pytest.CaptureFixture[str]
) -> None:
  make, match = BROKEN[kind]
  path = tmp_path / 'x.mp4'
  make(path)
  refused(path, Part(), match)
  assert capfd.readouterr().err == ''


@pytest.mark.parametrize(
  ('name', 'codec'), [('x.webm', 'VP80'), ('x.mp4', 'mp4v'), ('x.avi', 'MJPG')]
)
@pytest.mark.parametrize('how', ['half', 'head', 'damaged'])
def test_a_video_that_is_cut_short_or_damaged_is_refused(
  tiny: Callable[..., pathlib.Path],
  name: str,
  codec: str,
  how: str,
  capfd: pytest.CaptureFixture[str],
) -> None:
  path = tiny(name, codec)
  data = path.read_bytes()
  changes = {'half': data[: len(data) // 2], 'head': data[:100]}
  path.write_bytes(changes.get(how) or damaged(data))
  capfd.readouterr()
  refused(path, Part(), 'cut short or damaged')
  assert capfd.readouterr().err == ''


def test_what_is_left_of_a_cut_video_can_be_read(
  tiny: Callable[..., pathlib.Path],
) -> None:
  path = tiny()
  data = path.read_bytes()
  path.write_bytes(data[: len(data) // 2])
  with pytest.raises(recordings.RecordingError) as caught:
    decoded(path)
  end_s = float(str(caught.value).rpartition('--end=')[2])
  _, work = decoded(path, Part(end_s=end_s))
  assert work.chain.images == pytest.approx(25 * end_s, abs=2)


@pytest.mark.slow
def test_huge_pictures_are_refused_without_the_memory_for_them(
  video: Callable[..., pathlib.Path],
) -> None:
  side = 6_000
  path = video([np.zeros((side, side, 3), np.uint8)] * 2, 'x.avi', 'MJPG')
  code = (
    'import pathlib, resource, sys\n'
    'from waggle_tasks.experiments.video import recordings\n'
    'peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n'
    'before = peak()\n'
    'try: recordings.Recording(pathlib.Path(sys.argv[1]))\n'
    'except recordings.RecordingError as error: print(error)\n'
    'print(peak() - before)\n'
  )
  child = subprocess.run(
    [sys.executable, '-c', code, str(path)],
    capture_output=True, text=True, check=True,
  )  # fmt: skip
  said, kilobytes = child.stdout.splitlines()
  assert 'at most 4096 pixels wide and high: got 6000 x 6000' in said
  assert int(kilobytes) < 60_000


@pytest.mark.parametrize(
  ('part', 'match'),
  [
    (Part(start_s=99), '`start` must lie in the recording, 3.00 s long'),
    (Part(roi=(50, 0, 60, 60)), '`roi` must lie in the picture, 96 x 64'),
    (Part(anchor_px=(96.0, 5.0)), '`anchor` must lie in the part that is'),
    (
      Part(roi=(0, 0, 40, 40), anchor_px=(50.0, 5.0)),
      '`anchor` must lie in the part that is read: got 50,5',
    ),
  ],
)
def test_a_part_that_is_not_there_is_refused(
  tiny: Callable[..., pathlib.Path], part: Part, match: str
) -> None:
  refused(tiny(), part, match)


@pytest.mark.parametrize(
  ('fields', 'match'),
  [
    ({'start_s': -1.0}, '`start` must be between 0'),
    ({'start_s': 5.0, 'end_s': 5.0}, '`end` must be later than `start`'),
    ({'speed': 0.0}, '`speed` must be between 0.01 and 100: got 0.0'),
    ({'speed': float('nan')}, '`speed` must be a finite number'),
    ({'roi': (0, 0, 8, 8)}, '`roi` must be left, top, width, height'),
    ({'roi': (-1, 0, 80, 80)}, '`roi` must be left, top, width, height'),
  ],
)
def test_impossible_parts_are_refused(
  fields: dict[str, object], match: str
) -> None:
  with pytest.raises(recordings.RecordingError, match=match):
    Part(**fields)


def test_too_long_a_recording_asks_for_a_part(
  tiny: Callable[..., pathlib.Path], monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setattr(recordings, 'MAX_LENGTH_S', 2.0)
  refused(tiny(), Part(), 'at most 2 s long: got 3 s; choose a part')
  assert decoded(tiny(), Part(end_s=1.5))[1].chain.images > 30


@pytest.mark.slow
@pytest.mark.parametrize(
  ('arguments', 'line'),
  [
    ([], 'takes one FOLDER|RECORDING: got []'),
    (['{video}', '--roi=1,2,3'], '`roi` must be 4 numbers'),
    (['{video}', '--anchor=a,b'], '`anchor` must be 2 numbers'),
    (['{video}', '--fovy_deg=60', '--focal_px=9'], 'say the same: give one'),
    (['{video}', '--fovy_deg=180'], '`fovy_deg` must be between 1 and 170'),
    (['{video}', '--receiver=x'], "`receiver` must be one of ['klt"),
    (['{video}', '--annotate=x.gif'], '`video_file` must be a file name'),
    (['{folder}'], 'is not a run folder: it has no config.json'),
    (['{folder}', '--speed=2'], '`speed` is about a recording'),
  ],
)
def test_bad_arguments_are_one_line_and_exit_status_2(
  waggle: Waggle,
  tiny: Callable[..., pathlib.Path],
  arguments: list[str],
  line: str,
  tmp_path: pathlib.Path,
) -> None:
  places = {'video': tiny(), 'folder': tmp_path}
  child = waggle('decode', *(each.format(**places) for each in arguments))
  assert child.returncode == 2
  assert child.stdout == ''
  (said,) = child.stderr.splitlines()
  assert line in said


@pytest.mark.parametrize('factor', [0.25, 0.5, 1.0, 4.0])
def test_only_pixels_grow_with_the_focal_length(factor: float) -> None:
  paper, other = config.Config(), group.zoomed(config.Config(), factor)
  assert other.recognition.min_span_px == factor * 28
  assert other.motion.on_px_s == factor * 3.5
  assert other.stillness.max_px_s == factor * 2.5
  assert other.stillness.anchor_px == factor * 15
  assert other.tracking.box_px == factor * 72
  assert other.tracking.window_px >= 5
  assert other.tracking.max_corners == paper.tracking.max_corners
  assert other.motion.off_s == paper.motion.off_s
  assert other.recognition.max_rmse == paper.recognition.max_rmse


@pytest.mark.slow
@pytest.mark.parametrize(
  'name', sorted({*receivers.RECEIVERS} - {'joint', 'learned', 'seeker'})
)
def test_every_receiver_goes_by_its_own_camera(name: str) -> None:
  focal_px = camera.Camera.focal_px / 2
  half = agreement.Agreement(camera=camera.Camera(320, 240, focal_px))
  large, small = receivers.describe(name), receivers.describe(name, half)
  assert small.place.limits == (-7.5, 7.5)
  for a, b in zip(large.speed.limits, small.speed.limits, strict=True):
    assert b == a / 2
  assert small.null == large.null
  if (spans_px := large.templates().spans_px) is not None:
    np.testing.assert_allclose(small.templates().spans_px, spans_px / 2)
