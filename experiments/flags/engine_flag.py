"""The flags that say what flies cases, for launchers of studies."""

import functools

from absl import flags

from waggle_tasks.experiments.flags import workers_flag
from waggle_tasks.experiments.studies import cluster, pool

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()


def define() -> None:
  """Defines the flags for the launcher that calls this."""
  workers_flag.define()
  flags.DEFINE_string(
    'scheduler', None, 'Fly on a Dask cluster: tcp://HOST:PORT of its'
    ' scheduler, or the JSON file that it wrote.',
  )  # fmt: skip


def engine() -> tuple[pool.Engine, str]:
  """What the flags ask for, and what it is called.

  Raises:
    WaggleError: if there is no such cluster, or no such number of workers.
  """
  workers = workers_flag.count(flags.FLAGS['workers'].value)
  scheduler = flags.FLAGS['scheduler'].value
  if scheduler is None:
    engine = functools.partial(pool.run, workers=workers)
    return engine, f'{workers} workers'
  place = cluster.find(scheduler)
  return functools.partial(cluster.run, place=place), f'the cluster of {place}'
