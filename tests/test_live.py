"""A dance looked at while it is flown: in the terminal, and in a window."""

from collections.abc import Callable
import pathlib
import re
import subprocess
import types

from mujoco import viewer
import pytest

from waggle_tasks.experiments.studies import live
from waggle_tasks.experiments.video import window

Waggle = Callable[..., subprocess.CompletedProcess[str]]


def test_lines_are_told_when_they_change(
  capsys: pytest.CaptureFixture[str],
) -> None:
  lines = live.Lines(['observer_9', 'observer_10'])
  lines.show('observer_9', 'next: START', 0.0)
  lines.show('observer_9', 'next: START', 0.04)
  lines.show('observer_10', 'next: bit 1', 0.04)
  lines.show('observer_9', 'next: bit 1', 3.0)
  lines.close()
  told = [line.strip() for line in capsys.readouterr().err.split('\n')]
  assert [line for line in told if line] == [
    'observer_9     0.00 s  next: START',
    'observer_10    0.04 s  next: bit 1',
    'observer_9     3.00 s  next: bit 1',
  ]


@pytest.mark.slow
def test_a_broadcast_tells_what_is_read_as_it_flies(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle(
    'broadcast', '--live', '--language=swift', '--observers=1',
    '--payload=100010', f'--output={tmp_path / "run"}',
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  told = re.findall(r'observer_1 +([\d.]+) s +(.*\S)', child.stderr)
  assert [words.split('  ')[-1].strip() for _, words in told] == [
    'next: START',
    'next: END',
    'flies 100010',
    'arrived 100010',
  ]
  assert told[2][1].startswith('START 4 2 3 2 END')
  times_s = [float(time_s) for time_s, _ in told]
  assert times_s == sorted(times_s)
  assert times_s[-1] > 9


def test_no_window_is_promised_where_there_is_no_display(
  waggle: Waggle,
) -> None:
  child = waggle('view', '--language=swift', DISPLAY='', WAYLAND_DISPLAY='')
  assert child.returncode == 2
  assert 'must have a display' in child.stderr
  window.check_display({'WAYLAND_DISPLAY': 'wayland-0'}, 'linux')
  window.check_display({}, 'darwin')


def test_speed_is_checked_before_a_window_opens(waggle: Waggle) -> None:
  child = waggle('view', '--speed=0')
  assert child.returncode == 2
  assert '`speed` must be' in child.stderr


class FakeViewer:
  """A window that is closed by its user after two pictures."""

  def __init__(self) -> None:
    self.cam = types.SimpleNamespace(lookat=[0.0] * 3)
    self.shown, self.closed = 0, False

  def is_running(self) -> bool:
    return self.shown < 2

  def sync(self) -> None:
    self.shown += 1

  def close(self) -> None:
    self.closed = True


def test_a_window_follows_an_episode_until_it_is_closed(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  fake = FakeViewer()
  monkeypatch.setattr(viewer, 'launch_passive', lambda *_, **__: fake)
  physics = types.SimpleNamespace(
    model=types.SimpleNamespace(ptr=None),
    data=types.SimpleNamespace(ptr=None),
    time=lambda: 0.0,
  )
  environment = types.SimpleNamespace(physics=physics)
  step = types.SimpleNamespace(environment=environment)
  shown = window.Window(1.0, 1.7)
  shown(step)
  shown(step)
  assert fake.cam.lookat[2] == 1.7
  with pytest.raises(window.ClosedError):
    shown(step)
  shown.close()
  assert fake.closed
