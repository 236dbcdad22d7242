"""Readers that go away, letters that terminals lack, and signals."""

from collections.abc import Callable
import os
import pathlib
import signal
import subprocess
import sys

import pytest

TOY = '''"""A toy."""

import os, signal, sys

from waggle_tasks.experiments import launch


def main(argv):
  exec(BODY)


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
'''
MAIN = 'waggle_tasks.experiments.main'
BUFFERING = pytest.mark.parametrize('unbuffered', ['', '1'])

Line = Callable[[str], list[str]]


@pytest.fixture
def toy(tmp_path: pathlib.Path) -> Line:
  """Makes the command line of a launcher whose `main` has the given body."""

  def make(body: str) -> list[str]:
    path = tmp_path / 'toy.py'
    path.write_text(TOY.replace('exec(BODY)', body), encoding='utf-8')
    return [sys.executable, str(path)]

  return make


def shell(words: str, line: list[str], **changes: str) -> tuple[int, str, str]:
  """Runs a command line in bash; words may redirect it, "$@"."""
  done = subprocess.run(
    ['bash', '-o', 'pipefail', '-c', words, 'bash', *line],
    capture_output=True, text=True, check=False, env=os.environ | changes,
  )  # fmt: skip
  return done.returncode, done.stdout, done.stderr


@BUFFERING
@pytest.mark.parametrize(
  'body', ['print("line\\n" * 100_000)', 'print("line", flush=True)']
)
def test_a_reader_that_has_seen_enough_hears_no_complaint(
  toy: Line, body: str, unbuffered: str
) -> None:
  line = toy(f'{body}; import time; time.sleep(0.5); print("end")')
  got = shell('"$@" | head -1', line, PYTHONUNBUFFERED=unbuffered)
  assert got == (141, 'line\n', '')


@BUFFERING
@pytest.mark.parametrize('words', ['--help', 'broadcast --help'])
def test_help_may_be_cut(words: str, unbuffered: str) -> None:
  line = [sys.executable, '-m', MAIN, *words.split()]
  status, out, err = shell('"$@" | true', line, PYTHONUNBUFFERED=unbuffered)
  assert (status, out, err) == (141, '', '')


@BUFFERING
def test_what_cannot_be_printed_is_one_line(toy: Line, unbuffered: str) -> None:
  line = toy('print("line"); sys.stdout.flush()')
  got = shell('"$@" >/dev/full', line, PYTHONUNBUFFERED=unbuffered)
  status, _, err = got
  assert status == 2
  assert err.endswith('No space left on device\n')
  assert len(err.splitlines()) == 1


@pytest.mark.parametrize('words', ['"$@" 2>&-', '"$@" >&-', '"$@" >&- 2>&-'])
def test_output_that_is_closed_is_nobodys_file(toy: Line, words: str) -> None:
  line = toy(
    'print(1); print(2, file=sys.stderr); return os.open("/", 0) < 3 and 5'
  )
  assert shell(words, line)[0] == 0


def test_a_terminal_that_lacks_letters_gets_their_numbers(toy: Line) -> None:
  line = toy('print("m/s\\u00b2 lat\\udce9")')
  got = shell('"$@"', line, PYTHONIOENCODING='ascii')
  assert got == (0, 'm/s\\xb2 lat\\udce9\n', '')


@pytest.mark.parametrize('command', ['broadcast', 'decode', 'report', 'suite'])
def test_a_name_that_is_no_text_is_refused_before_the_work(
  command: str, tmp_path: pathlib.Path
) -> None:
  name = os.fsdecode(b'lat\xe9.webm')
  takes_one = command in ('decode', 'report')
  line = [sys.executable, '-m', MAIN, command]
  line.append(name if takes_one else f'--output={name}')
  child = subprocess.run(
    line, capture_output=True, text=True, check=False, cwd=tmp_path
  )
  assert child.returncode == 2
  (said,) = child.stderr.splitlines()
  assert said.startswith(f'waggle {command}: names must be text in UTF-8: got')
  assert 'lat\\udce9.webm' in said
  assert [*tmp_path.iterdir()] == []


@pytest.mark.slow
@pytest.mark.parametrize(
  'words', ['decode film.webm', 'decode pictures --fps=25', 'broadcast --video']
)
def test_films_in_a_folder_whose_name_is_no_text_are_refused(
  words: str, tmp_path: pathlib.Path
) -> None:
  home = tmp_path / os.fsdecode(b'lat\xe9')
  (home / 'pictures').mkdir(parents=True)
  for name in ('film.webm', 'pictures/1.png', 'pictures/2.png'):
    (home / name).write_bytes(b'not read')
  before = sorted(home.rglob('*'))
  child = subprocess.run(
    [sys.executable, '-m', MAIN, *words.split()],
    capture_output=True, text=True, check=False, cwd=home,
  )  # fmt: skip
  assert child.returncode == 2
  (said,) = child.stderr.splitlines()
  assert 'names must be text in UTF-8: got' in said
  assert sorted(home.rglob('*')) == before


@pytest.mark.parametrize(
  ('error', 'said'),
  [
    ('OSError(28, "No space left", "runs/a")', 'runs/a: No space left'),
    ('PermissionError(13, "Permission denied")', 'Permission denied'),
  ],
)
def test_a_disk_that_refuses_is_one_line(
  toy: Line, error: str, said: str
) -> None:
  status, _, err = shell('"$@"', toy(f'raise {error}'))
  assert (status, err) == (2, f'waggle toy: {said}\n')


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGHUP])
def test_who_is_asked_to_end_cleans_up(
  toy: Line, number: signal.Signals, tmp_path: pathlib.Path
) -> None:
  left = tmp_path / 'left'
  line = toy(
    f'open({str(left)!r}, "w")\n'
    '  try:\n'
    f'    os.kill(os.getpid(), {number:d}); signal.pause()\n'
    '  finally:\n'
    f'    os.remove({str(left)!r})'
  )
  got = shell('"$@"', line)
  assert got == (130, '', 'waggle toy: interrupted\n')
  assert not left.exists()


def test_who_must_not_hear_of_a_hang_up_flies_on(toy: Line) -> None:
  line = toy('os.kill(os.getpid(), signal.SIGHUP); print("flown")')
  status, out, _ = shell('trap "" HUP; "$@"', line)
  assert (status, out) == (0, 'flown\n')
