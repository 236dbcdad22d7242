"""The flags that say what flies cases, for launchers that take them."""

import functools

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments.machine import cores
from waggle_tasks.experiments.studies import cluster, pool
from waggle_tasks.protocol import checks

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

_MOST = 1024


def define() -> None:
  """Defines both flags for the launcher that calls this."""
  define_workers()
  flags.DEFINE_string(
    'scheduler', None, 'Fly on a Dask cluster: tcp://HOST:PORT of its'
    ' scheduler, or the JSON file that it wrote.',
  )  # fmt: skip


def define_workers() -> None:
  """Defines only the number of processes."""
  flags.DEFINE_integer(
    'workers', None, 'How many processes; unset, one for each core.'
  )


def workers() -> int:
  """How many processes the flag asks for, one a core if it is not given.

  Raises:
    WaggleError: if it asks for none, or for too many.
  """
  value = flags.FLAGS['workers'].value
  if value is None:
    return len(cores.usable())
  return checks.integer('workers', value, 1, _MOST, errors.WaggleError)


def engine() -> tuple[pool.Engine, str]:
  """What the flags ask for, and what it is called.

  Raises:
    WaggleError: if there is no such cluster, or no such number of workers.
  """
  count, scheduler = workers(), flags.FLAGS['scheduler'].value
  if scheduler is None:
    return functools.partial(pool.run, workers=count), f'{count} workers'
  place = cluster.find(scheduler)
  return functools.partial(cluster.run, place=place), f'the cluster of {place}'
