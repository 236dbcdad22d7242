"""Files that are whole or not there, and names with one writer at a time."""

import multiprocessing
import os
import pathlib

import pytest

from waggle_tasks.experiments.machine import files

CONTEXT = multiprocessing.get_context('spawn')


def rewrite(path: pathlib.Path, letter: str, count: int) -> None:
  """Writes a file again and again, each time with one letter."""
  for _ in range(count):
    files.replace(path, letter * 100_000)


def test_writers_of_one_file_do_not_disturb_each_other(
  tmp_path: pathlib.Path,
) -> None:
  path = tmp_path / 'page.html'
  writers = [
    CONTEXT.Process(target=rewrite, args=(path, letter, 40)) for letter in 'ab'
  ]
  for each in writers:
    each.start()
  for each in writers:
    each.join()
  assert [each.exitcode for each in writers] == [0, 0]
  assert path.read_text() in ('a' * 100_000, 'b' * 100_000)
  assert os.listdir(tmp_path) == ['page.html']


def test_a_file_that_cannot_be_written_leaves_the_one_before(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  path = files.replace(tmp_path / 'page.html', 'before')

  def full(self: pathlib.Path, data: bytes) -> int:
    self.touch()
    raise OSError(28, 'No space left on device')

  monkeypatch.setattr(pathlib.Path, 'write_bytes', full)
  with pytest.raises(OSError, match='No space left'):
    files.replace(path, 'after')
  assert (path.read_text(), os.listdir(tmp_path)) == ('before', ['page.html'])


def test_a_name_has_one_owner_at_a_time(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'of' / 'mine' / 'film.webm'
  with files.claimed(path):
    with pytest.raises(files.ClaimedError), files.claimed(path):
      raise AssertionError('it must not be had twice')
    with files.claimed(path.with_name('other.webm')):
      pass
  with files.claimed(path):
    pass
  assert os.listdir(path.parent) == []


def test_text_that_is_no_unicode_is_written_as_escapes(
  tmp_path: pathlib.Path,
) -> None:
  path = files.replace(tmp_path / 'page.html', 'caf\xe9 lat\udce9')
  assert path.read_text(encoding='utf-8') == 'caf\xe9 lat\\udce9'
