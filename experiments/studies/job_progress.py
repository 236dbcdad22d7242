"""How far jobs are: what a job tells, and the bar that shows it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import tqdm

from waggle_tasks.agents import observer_agent
from waggle_tasks.experiments.record import episode
from waggle_tasks.experiments.studies import pool
from waggle_tasks.protocol import timing

if TYPE_CHECKING:
  from dm_control import composer
  import dm_env

_FORM = '{desc}|{bar}| {n:.0f}/{total:.0f} s simulated [{elapsed} <'
_REPORT_FRAMES = 50  # How often an episode says that it is alive.


def reporter(report: Callable[[float], None]) -> episode.Watcher:
  """What watches an episode and reports how many frames are done."""

  def watch(
    environment: 'composer.Environment',
    timestep: 'dm_env.TimeStep',
    team: observer_agent.Team,
  ) -> None:
    del team
    frame = timing.frames(environment.physics.time())
    if timestep.last() or frame % _REPORT_FRAMES == 0:
      report(frame)

  return watch


def seconds_bar(frames: int, **look: object) -> tqdm.tqdm:
  """A bar that counts frames and shows them as simulated seconds.

  Seconds that are added up one frame after the other end beside their total,
  and often beyond it; whole numbers do not.

  Args:
    frames: How many there are.
    **look: What else `tqdm` takes.
  """
  return tqdm.tqdm(
    total=frames, unit_scale=timing.FRAME_S, mininterval=0.5, **look
  )


def shown(
  news: Iterable[pool.Progress | pool.Done],
  frames: Mapping[str, int],
  describe: Callable[[int, Sequence[str]], str],
) -> Iterator[pool.Done]:
  """Shows a bar of simulated seconds, and hands on the jobs that are done.

  Args:
    news: What happens; the amount of a job's progress is its frames.
    frames: By the name of each job how many frames it simulates at most.
    describe: The words before the bar, from how many jobs are done and the
      names of those that are under way.
  """
  flown: dict[str, int] = {}
  active: dict[str, bool] = {}
  done = 0
  total = sum(frames.values())
  form = _FORM + ' {remaining}]'
  with seconds_bar(total, smoothing=0, bar_format=form) as bar:
    for each in news:
      name, before = each.job.name, flown.get(each.job.name, 0)
      if isinstance(each, pool.Progress):
        flown[name] = min(int(each.amount), frames[name])
        active[name] = True
      else:
        yield each
        flown[name] = frames[name]  # Episodes may end before their time.
        active.pop(name, None)
        done += 1
      bar.set_description_str(f'{describe(done, [*active])} ', refresh=False)
      bar.update(flown[name] - before)
