"""The bar of simulated seconds: it ends where it should, whatever is flown."""

from collections.abc import Callable
import pathlib
import subprocess
import warnings

import pytest

from waggle_tasks.experiments.studies import job_progress, pool


@pytest.mark.parametrize('frames', [1, 3, 249, 2690, 15_000])
def test_a_bar_of_any_length_ends_full_and_without_a_warning(
  frames: int, capsys: pytest.CaptureFixture[str]
) -> None:
  form = '{percentage:.0f} {bar} {n:.2f} of {total:.2f} s'
  with warnings.catch_warnings():
    warnings.simplefilter('error')
    with job_progress.seconds_bar(frames / 25, bar_format=form) as bar:
      for _ in range(frames):
        job_progress.advance(bar, job_progress.ticks(1 / 25))
  last = capsys.readouterr().err.splitlines()[-1]
  assert last.startswith('100 ')
  assert f'{frames / 25:.2f} of {frames / 25:.2f} s' in last


@pytest.mark.parametrize('duration_s', [2.365, 2.38, 2.4])
def test_the_last_image_may_come_after_the_end(
  duration_s: float, capsys: pytest.CaptureFixture[str]
) -> None:
  form = '{percentage:.0f} {n:.2f} of {total:.2f} s'
  with warnings.catch_warnings():
    warnings.simplefilter('error')
    with job_progress.seconds_bar(duration_s, bar_format=form) as bar:
      for _ in range(60):
        job_progress.advance(bar, job_progress.ticks(1 / 25))
  assert capsys.readouterr().err.splitlines()[-1].startswith('100 ')


def test_a_job_that_tells_more_than_its_time_does_not_overrun(
  capsys: pytest.CaptureFixture[str],
) -> None:
  job = pool.Job('one', print, ())
  news = [pool.Advance(job, 1.6), pool.Advance(job, 2.4), pool.Done(job, 1)]
  with warnings.catch_warnings():
    warnings.simplefilter('error')
    done = [*job_progress.shown(news, {'one': 2.0}, lambda *_: 'one')]
  assert done == [pool.Done(job, 1)]
  assert '2/2 s simulated' in capsys.readouterr().err.splitlines()[-1]


def test_jobs_whose_times_round_up_end_together(
  capsys: pytest.CaptureFixture[str],
) -> None:
  names = [str(number) for number in range(5)]
  news = [pool.Done(pool.Job(name, print, ()), 1) for name in names]
  lengths_s = dict.fromkeys(names, 1.0032)  # 250.8 steps of 4 ms.
  assert [*job_progress.shown(news, lengths_s, lambda *_: 'all')] == news
  assert '5/5 s simulated' in capsys.readouterr().err.splitlines()[-1]


@pytest.mark.slow
def test_a_whole_flight_is_kept_where_warnings_are_errors(
  waggle: Callable[..., subprocess.CompletedProcess[str]],
  tmp_path: pathlib.Path,
) -> None:
  child = waggle(
    'broadcast', '--control=no_send', '--observers=1', '--duration_s=4',
    cwd=tmp_path, PYTHONWARNINGS='error',
  )  # fmt: skip
  assert (child.returncode, 'Warning' in child.stderr) == (0, False)
  assert (tmp_path / 'runs' / 'broadcast-1' / 'result.json').exists()
