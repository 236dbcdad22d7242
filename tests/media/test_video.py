"""The composite video: its layout, its pictures, its files, its refusals."""

from collections.abc import Callable
import itertools
import pathlib
import subprocess
import sys

import cv2
from dm_control.mujoco import engine
import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.entities import renderer
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import episode, moves, story, writer
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import (
  encoders,
  film,
  layout,
  lens,
  moment,
  page,
)
from waggle_tasks.experiments.video import strip as strip_lib
from waggle_tasks.protocol import agreement, frame, payload
from waggle_tasks.protocol.symbols import Symbol


def frames(path: pathlib.Path) -> list[tuple[float, np.ndarray]]:
  """Every time in s and picture, (H, W, 3) BGR, of a video."""
  capture, out = cv2.VideoCapture(str(path)), []
  while True:
    found, image = capture.read()
    if not found:
      return out
    out.append((capture.get(cv2.CAP_PROP_POS_MSEC) / 1e3, image))


def inside(rect: layout.Rect, width: int, height: int) -> bool:
  return (
    min(rect.left, rect.top) >= 0
    and rect.right <= width
    and rect.bottom <= height
  )


def overlap(a: layout.Rect, b: layout.Rect) -> bool:
  return (
    max(a.left, b.left) < min(a.right, b.right)
    and max(a.top, b.top) < min(a.bottom, b.bottom)
  )  # fmt: skip


def parts(plan: layout.PageLayout) -> list[layout.Rect]:
  """Everything on a page, pictures with their titles and feet."""
  out = [plan.header, plan.card, plan.strip]
  for picture in (*plan.observers, *plan.shared.values()):
    out += [picture, plan.title(picture)]
  return out + [plan.foot(picture) for picture in plan.observers]


@pytest.mark.parametrize('scale', [0.25, 0.5, 0.8, 1.0, 2.0])
@pytest.mark.parametrize('observers', [1, 2, 3, 4, 5])
def test_nothing_on_a_page_overlaps_or_leaves_it(
  observers: int, scale: float
) -> None:
  plan = layout.plan(observers, scale)
  assert len(plan.observers) == observers
  assert plan.width % 2 == plan.height % 2 == 0
  for a, b in itertools.combinations(parts(plan), 2):
    assert not overlap(a, b)
  for rect in parts(plan):
    assert inside(rect, plan.width, plan.height)


@pytest.mark.parametrize('observers', [1, 5, 6, 7, 11, 20, 64])
def test_pages_share_observers_evenly_and_show_each_once(
  observers: int,
) -> None:
  names = [f'observer_{k + 1}' for k in range(observers)]
  pages = layout.pages(names)
  assert [name for page_ in pages for name in page_] == names
  sizes = [len(page_) for page_ in pages]
  assert max(sizes) <= 5
  assert max(sizes) - min(sizes) <= 1
  assert len(pages) == -(-observers // 5)


def test_the_video_lasts_as_long_as_the_run_at_its_rate(
  recorded: object,
) -> None:
  pictures = frames(recorded.folder / 'composite.webm')
  end_s = recorded.rollout.times_s[-1]
  np.testing.assert_allclose(
    [time_s for time_s, _ in pictures],
    np.arange(len(pictures)) / 2.5,
    atol=1e-3,
  )
  assert pictures[-1][0] == pytest.approx(end_s, abs=0.4)
  plan = layout.plan(2, 0.5, 1)
  assert pictures[0][1].shape == (plan.height, plan.width, 3)


def test_an_observers_picture_is_what_it_sees(recorded: object) -> None:
  pictures = frames(recorded.folder / 'composite.webm')
  seeing, blind = layout.plan(2, 0.5, 1).observers
  for _, picture in pictures[::25]:
    assert picture[blind.slices].mean() < 20  # Black, but for its marks.
    assert picture[seeing.slices].mean() > 80


def colour_share(picture: np.ndarray, colour: str) -> float:
  """The share of a picture, BGR, that nearly has a colour."""
  wanted = np.array(palette.rgb(colour)[::-1], int)
  near = cv2.inRange(picture, wanted - 39, wanted + 39)
  return np.count_nonzero(near) / near.size


def test_symbols_and_track_appear_as_they_are_read(recorded: object) -> None:
  pictures = frames(recorded.folder / 'composite.webm')
  plan = layout.plan(2, 0.5, 1)
  eye = plan.observers[0]
  start = next(
    e for e in recorded.rollout.events['observer_1']
    if getattr(e, 'symbol', None) is Symbol.START
  )  # fmt: skip
  before = [p for t, p in pictures if t < start.time_s - 0.3]
  after = [p for t, p in pictures if start.time_s < t < start.time_s + 1]
  foot = plan.foot(eye).slices
  assert all(colour_share(p[foot], palette.BLUE) < 0.001 for p in before)
  assert all(colour_share(p[foot], palette.BLUE) > 0.03 for p in after)
  sent = moves.sent(
    recorded.scene.performance,
    recorded.scene.agreement,
    recorded.scene.episode_s,
  )[0]
  dancing = [p for t, p in pictures if sent.begin_s + 1 < t < sent.end_s]
  trails = [colour_share(p[eye.slices], palette.YELLOW) for p in dancing]
  assert max(trails) > 0.0004
  resting = [p for t, p in pictures if 1 < t < sent.begin_s]
  trails = [colour_share(p[eye.slices], palette.YELLOW) for p in resting]
  assert max(trails) < 0.0002


@pytest.mark.slow
def test_filming_changes_no_event(
  short: dict[str, object], tmp_path: pathlib.Path
) -> None:
  scene = scenario.Scenario(observers=1, duration_s=9.0, **short)
  with film.Film(tmp_path, scene, fps=25.0, scale=0.25) as camera:
    filmed = rollout_lib.run(scene, 'klt', [camera])
  plain = rollout_lib.run(scene, 'klt')
  lines = [*writer.event_lines(plain)]
  assert len(lines) > 1
  assert [*writer.event_lines(filmed)] == lines


@pytest.mark.slow
def test_many_observers_get_a_video_a_page(tmp_path: pathlib.Path) -> None:
  scene = scenario.Scenario(
    control='no_send', observers=6, half_span_deg=60.0, duration_s=0.2
  )
  with film.Film(tmp_path, scene, scale=0.25) as camera:
    rollout_lib.run(scene, 'klt', [camera])
  names = sorted(path.name for path in tmp_path.iterdir())
  assert names == ['composite-2.webm', 'composite.webm']


@pytest.mark.slow
@pytest.mark.parametrize('view', ['observer_1', 'performer', 'top', 'overview'])
def test_a_single_view_without_marks_is_the_image_itself(
  view: str, tmp_path: pathlib.Path
) -> None:
  scene = scenario.Scenario(control='no_send', observers=1, duration_s=0.2)
  with film.Film(tmp_path, scene, view=view, fps=25, marks=False) as camera:
    rollout_lib.run(scene, 'klt', [camera])
  environment = registry.environment(scene)
  environment.reset()
  camera_name = layout.SHARED.get(view, f'{view}/eye')
  wanted = environment.physics.render(480, 640, camera_name)
  environment.close()
  pictures = frames(tmp_path / f'{view}.webm')
  assert len(pictures) == 6
  difference = pictures[0][1][..., ::-1].astype(int) - wanted
  assert np.abs(difference).mean() < 3


def test_the_view_from_the_top_shows_every_vehicle() -> None:
  environment = registry.environment(scenario.Scenario(observers=4))
  environment.reset()
  physics, task = environment.physics, environment.task
  top = physics.model.name2id('top', 'camera')
  image = renderer.Renderer(physics).image(top)
  px_per_m = 480 / physics.model.cam_fovy[top]
  for x_m, y_m, _ in task.positions_m(physics).values():
    column = round(320 + px_per_m * (x_m - physics.data.cam_xpos[top][0]))
    row = round(240 - px_per_m * (y_m - physics.data.cam_xpos[top][1]))
    around = image[row - 4 : row + 5, column - 4 : column + 5]
    assert around.min() < 60  # Its dark board, on a bright floor.
  environment.close()


@pytest.mark.slow
def test_a_page_draws_the_same_moment_the_same_way(recorded: object) -> None:
  scene = recorded.scene
  drawn = []

  def watch(*seen: object) -> None:
    lenses.note(*seen)
    if lenses.frame == 3:
      now = lenses.moment(names, lenses.shared())
      drawn.extend(composite.draw(now).copy() for _ in range(2))

  names = ('observer_1', 'observer_2')
  lenses, composite = lens.Lens(scene), film.composite(scene, names, 0.5)
  brief = scenario.Scenario(observers=2, duration_s=0.2)
  rollout_lib.run(brief, 'klt', [watch])
  np.testing.assert_array_equal(*drawn)


@pytest.mark.parametrize(
  ('choices', 'match'),
  [
    ({'view': 'observer_3'}, r"`view` must be one of .*: got 'observer_3'"),
    ({'view': 'tops'}, r"got 'tops'\. Did you mean top\?"),
    ({'fps': 0.0}, '`video_fps` must be between 0.1 and 25: got 0.0'),
    ({'fps': 26.0}, '`video_fps` must be between 0.1 and 25: got 26.0'),
    ({'fps': float('nan')}, '`video_fps` must be a finite number: got nan'),
    ({'scale': 3.0}, '`video_scale` must be between 0.25 and 2: got 3.0'),
    ({'name': 'x.avi'}, r"`video_file` must .* \['.webm', '.mp4'\]: got 'x.av"),
    ({'name': 'a/x.webm'}, "`video_file` must .*: got 'a/x.webm'"),
  ],
)
def test_choices_that_cannot_be_filmed_are_refused(
  choices: dict[str, object], match: str, tmp_path: pathlib.Path
) -> None:
  with pytest.raises(layout.VideoError, match=match):
    film.Film(tmp_path, scenario.Scenario(observers=2), **choices)
  assert not list(tmp_path.iterdir())


def test_a_codec_that_opencv_refuses_is_an_error(
  tmp_path: pathlib.Path,
) -> None:
  with pytest.raises(layout.VideoError, match=r'OpenCV refuses VP8 \(VP80\)'):
    encoders.make(tmp_path / 'missing' / 'x.webm', (64, 64), 25.0)


def test_a_full_disk_is_an_error(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'x.webm'
  path.symlink_to('/dev/full')
  encoder = encoders.make(path, (64, 64), 25.0)
  encoder.write(np.zeros((64, 64, 3), np.uint8))
  with pytest.raises(layout.VideoError, match='could not be written'):
    encoder.close()


def test_without_pyav_an_mp4_says_what_to_install(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setitem(sys.modules, 'av', None)
  with pytest.raises(layout.VideoError, match=r"'waggle-tasks\[video\]'"):
    encoders.make(tmp_path / 'x.mp4', (64, 64), 25.0)


def test_with_pyav_an_mp4_is_h264(tmp_path: pathlib.Path) -> None:
  av = pytest.importorskip('av')
  encoder = encoders.make(tmp_path / 'x.mp4', (64, 48), 12.5)
  for level in range(10):
    encoder.write(np.full((48, 64, 3), 20 * level, np.uint8))
  encoder.close()
  with av.open(str(tmp_path / 'x.mp4')) as container:
    assert container.streams.video[0].codec_context.name == 'h264'
  pictures = frames(tmp_path / 'x.mp4')
  np.testing.assert_allclose([t for t, _ in pictures], np.arange(10) / 12.5)
  levels = [picture.mean() for _, picture in pictures]
  np.testing.assert_allclose(levels, 20 * np.arange(10), atol=3)


def test_an_error_while_drawing_reaches_the_run(tmp_path: pathlib.Path) -> None:
  worker = encoders.Worker(encoders.make(tmp_path / 'x.webm', (64, 64), 25.0))

  def fail() -> np.ndarray:
    raise RuntimeError('no ink')

  worker.put(fail)
  with pytest.raises(RuntimeError, match='no ink'):
    worker.close()


def test_a_single_page_has_room_for_its_title_and_foot() -> None:
  assert page.Single('top', marks=False).size == (640, 480)
  width, height = page.Single('top').size
  assert width == 640
  assert height > 520


@pytest.mark.slow
@pytest.mark.parametrize(
  ('flag', 'line'),
  [
    ('--view=top', '`view` is about a video: add --video'),
    ('--video_fps=10', '`video_fps` is about a video: add --video'),
    ('--video --view=sky', '`view` must be one of'),
  ],
)
def test_a_refused_flag_leaves_nothing(
  waggle: Callable[..., subprocess.CompletedProcess[str]],
  flag: str,
  line: str,
  tmp_path: pathlib.Path,
) -> None:
  child = waggle('broadcast', *flag.split(), '--output=run', cwd=tmp_path)
  assert child.returncode == 2
  assert line in child.stderr.splitlines()[-1]
  assert not list(tmp_path.iterdir())


def test_the_terminal_stays_clean(
  tiny: Callable[..., pathlib.Path],
  tmp_path: pathlib.Path,
  capfd: pytest.CaptureFixture[str],
) -> None:
  encoder = encoders.make(tmp_path / 'x.webm', (64, 64), 25.0)
  encoder.write(np.zeros((64, 64, 3), np.uint8))
  encoder.close()
  assert capfd.readouterr() == ('', '')


def strip_of(*events: object) -> np.ndarray:
  """The strip of events at the end of a broadcast, (H, W, 3)."""
  plan = layout.plan(1)
  strip = strip_lib.Strip(
    plan, ['observer_1'], (), agreement.Agreement(), 104.6
  )
  sight = moment.View(
    'observer_1', np.zeros((2, 2, 3), np.uint8), None, np.empty((0, 2)),
    story.Reading(), events,
  )  # fmt: skip
  canvas = np.zeros((plan.height, plan.width, 3), np.uint8)
  strip.draw(canvas, moment.Instant(0.0, None, (sight,), {}, {}))
  return canvas[plan.strip.slices]


def null(time_s: float) -> receiver.Event:
  return receiver.Event(time_s, Symbol.NULL, frame.State.START)


def deed(name: str, time_s: float) -> observer_agent.Navigation:
  bits = payload.Payload.from_bits('000010')
  return observer_agent.Navigation(
    time_s, observer_agent.Deed(name), (0.0, 0.0, 1.3), bits, 9, ''
  )


# The final null, the start and the arrival of a broadcast; and a flight that
# takes so little time that its end has no room for a name.
@pytest.mark.parametrize('arrival_s', [98.76, 96.5, 95.7])
def test_no_mark_of_the_strip_covers_the_one_before_it(
  arrival_s: float,
) -> None:
  events = [
    null(95.6),
    deed('navigation start', 95.6),
    deed('arrival', arrival_s),
  ]
  pictures = [strip_of(*events[:count]) for count in range(4)]
  changed = [
    np.flatnonzero((a != b).any(axis=(0, 2)))
    for a, b in itertools.pairwise(pictures)
  ]
  for before, after in itertools.pairwise(changed):
    assert len(before)
    assert len(after)
    assert before.max() < after.min()


@pytest.mark.parametrize('view', ['overview', 'performer'])
def test_rings_are_where_a_camera_sees_the_vehicles(view: str) -> None:
  scene = scenario.Scenario(control='no_send', duration_s=0.08)
  seen = lens.Lens(scene)

  def look(step: episode.Step) -> None:
    seen.note(step)
    now = seen.moment(('observer_1',), seen.shared())
    physics, (width, height) = step.environment.physics, layout.VIEW_PX
    camera = engine.Camera(physics, height, width, layout.SHARED[view])
    spots = step.environment.task.positions_m(physics)
    wanted = {}
    for name, place_m in spots.items():
      x, y, z = camera.matrix @ [*place_m, 1.0]
      wanted[name] = pytest.approx((x / z, y / z), abs=1.0)
    assert now.places[view] == wanted

  rollout_lib.run(scene, 'klt', [look])


def test_rings_seen_from_above_stand_as_the_vehicles_do() -> None:
  scene = scenario.Scenario(control='no_send', duration_s=0.08)
  seen = lens.Lens(scene)

  def look(step: episode.Step) -> None:
    seen.note(step)
    places = seen.moment((), seen.shared()).places['top']
    environment = step.environment
    spots = environment.task.positions_m(environment.physics)
    ground = np.array([spots[name][:2] for name in places])
    pixels = np.array([*places.values()]) * (1.0, -1.0)
    (across, up) = (np.ptp(pixels, axis=0) / np.ptp(ground, axis=0)).tolist()
    assert across == pytest.approx(up)
    assert len(places) == 4
    zoomed = (ground - ground[0]) * across
    np.testing.assert_allclose(zoomed, pixels - pixels[0], atol=1e-6)

  rollout_lib.run(scene, 'klt', [look])
