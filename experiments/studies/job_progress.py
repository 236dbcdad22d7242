"""How far jobs are: what a job tells, and the bar that shows it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import tqdm

from waggle_tasks.experiments.record import episode
from waggle_tasks.experiments.studies import pool
from waggle_tasks.protocol import agreement

_FORM = '{desc}|{bar}| {n:.0f}/{total:.0f} s simulated [{elapsed} <'
_REPORT_S = 2.0  # How often an episode says that it is alive.


def reporter(report: Callable[[float], None]) -> episode.Onlooker:
  """What watches an episode and reports how many seconds are done."""
  due_s = 0.0

  def watch(step: episode.Step) -> None:
    nonlocal due_s
    time_s = step.environment.physics.time()
    if step.timestep.last() or time_s >= due_s:
      due_s = time_s + _REPORT_S
      report(time_s)

  return watch


def ticks(duration_s: float) -> int:
  """The physics steps of a duration: what bars count, at any rate of images.

  Seconds that are added up one frame after the other end beside their total,
  and often beyond it; whole numbers do not.
  """
  return round(duration_s * agreement.STEPS_HZ)


def seconds_bar(duration_s: float, **look: object) -> tqdm.tqdm:
  """A bar that counts `ticks` and shows them as simulated seconds.

  Args:
    duration_s: How much there is to simulate.
    **look: What else `tqdm` takes.
  """
  return tqdm.tqdm(
    total=ticks(duration_s),
    unit_scale=1 / agreement.STEPS_HZ,
    mininterval=0.5,
    **look,
  )


def advance(bar: tqdm.tqdm, count: int) -> None:
  """Moves a bar on, but never beyond its end, where tqdm forgets its total.

  The last image of an episode may come after the time at which it ends.
  """
  bar.update(min(count, bar.total - bar.n))


def shown(
  news: Iterable[pool.Advance | pool.Done],
  lengths_s: Mapping[str, float],
  describe: Callable[[int, Sequence[str]], str],
) -> Iterator[pool.Done]:
  """Shows a bar of simulated seconds, and hands on the jobs that are done.

  Args:
    news: What happens; the amount of a job's progress is its seconds.
    lengths_s: By the name of each job how many seconds it simulates at most.
    describe: The words before the bar, from how many jobs are done and the
      names of those that are under way.
  """
  flown: dict[str, int] = {}
  active: dict[str, bool] = {}
  done = 0
  lengths = {name: ticks(each_s) for name, each_s in lengths_s.items()}
  form = _FORM + ' {remaining}]'
  # The sum of whole ticks: that of seconds may round to less, and tqdm forgets
  # the total of a bar that goes beyond it.
  total_s = sum(lengths.values()) / agreement.STEPS_HZ
  with seconds_bar(total_s, smoothing=0, bar_format=form) as bar:
    for each in news:
      name, before = each.job.name, flown.get(each.job.name, 0)
      if isinstance(each, pool.Advance):
        flown[name] = min(ticks(each.amount), lengths[name])
        active[name] = True
      else:
        yield each
        flown[name] = lengths[name]  # Episodes may end before their time.
        active.pop(name, None)
        done += 1
      bar.set_description_str(f'{describe(done, [*active])} ', refresh=False)
      advance(bar, flown[name] - before)
