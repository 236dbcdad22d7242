"""A journal keeps every whole line, whatever ends its writer."""

from collections.abc import Iterator
import fcntl
import os
import pathlib
import resource

import pytest

from waggle_tasks.experiments.record import journal

ROWS = [{'n': n, 'text': 'x' * 50} for n in range(3)]


@pytest.fixture
def path(tmp_path: pathlib.Path) -> pathlib.Path:
  """A journal of three lines."""
  path = tmp_path / 'journal'
  with journal.opened(path) as log:
    for row in ROWS:
      log.append(row)
  return path


def test_what_was_written_is_read(path: pathlib.Path) -> None:
  assert journal.read(path) == ROWS


def test_a_line_reaches_the_disk_where_fsync_is_not_enough(
  path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  asked = []
  monkeypatch.setattr(fcntl, 'F_FULLFSYNC', 51, raising=False)
  monkeypatch.setattr(fcntl, 'fcntl', lambda _, what: asked.append(what))
  with journal.opened(path) as log:
    log.append(ROWS[0])
  assert asked == [51]
  assert journal.read(path) == [*ROWS, ROWS[0]]


def test_no_file_is_no_line(tmp_path: pathlib.Path) -> None:
  assert journal.read(tmp_path / 'none') == []


@pytest.mark.parametrize('lost', [1, 2, 30, 60])
def test_a_torn_last_line_is_cut_off_and_written_again(
  path: pathlib.Path, lost: int
) -> None:
  whole = path.read_bytes()
  path.write_bytes(whole[:-lost])
  assert journal.read(path) == ROWS[:2]
  with journal.opened(path) as log:
    log.append(ROWS[2])
  assert path.read_bytes() == whole


def test_a_line_that_was_touched_is_passed_over(path: pathlib.Path) -> None:
  path.write_bytes(path.read_bytes().replace(b'"n": 1', b'"n": 7'))
  assert journal.read(path) == [ROWS[0], ROWS[2]]
  with journal.opened(path) as log:
    log.append(ROWS[1])
  assert journal.read(path) == [ROWS[0], ROWS[2], ROWS[1]]


@pytest.mark.parametrize('noise', [b'\n\n', b'what\n', b'\xff\x00 {}\n'])
def test_lines_of_something_else_are_passed_over(
  path: pathlib.Path, noise: bytes
) -> None:
  path.write_bytes(noise + path.read_bytes() + noise)
  assert journal.read(path) == ROWS


@pytest.fixture
def full_disk(path: pathlib.Path) -> Iterator[None]:
  """A file may grow by only twenty bytes more."""
  soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
  resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size + 20, hard))
  yield
  resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.usefixtures('full_disk')
def test_a_full_disk_leaves_no_part_of_a_line(path: pathlib.Path) -> None:
  before = path.read_bytes()
  with (
    journal.opened(path) as log,
    pytest.raises(OSError, match='too large'),
  ):
    log.append(ROWS[0])
  assert path.read_bytes() == before


def test_a_line_is_on_the_disk_before_the_next_step(
  path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  sizes = []
  with journal.opened(path) as log:
    monkeypatch.setattr(os, 'fsync', lambda fd: sizes.append(os.fstat(fd)))
    log.append(ROWS[0])
  assert [stat.st_size for stat in sizes] == [path.stat().st_size]
