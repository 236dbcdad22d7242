"""Gymnasium and PettingZoo: the tasks as learning libraries know them.

  from waggle_tasks import rl
  many = rl.parallel_env('broadcast', language='swift')   # PettingZoo
  one = rl.gym_env('broadcast', language='swift')         # Gymnasium

or, once this is imported, `gymnasium.make('waggle/Broadcast-v0')`; in a line,
`gymnasium.make('waggle_tasks.rl:waggle/Broadcast-v0')`. It takes the extra
`rl`: pip install 'waggle-tasks[rl]'. dm_env stays the tasks' own face, which
`waggle_tasks.load` returns.
"""

import importlib
from typing import TYPE_CHECKING

from waggle_tasks.rl import needs

needs.check()  # Before anything that imports them.

from waggle_tasks.rl import ids  # noqa: E402

if TYPE_CHECKING:
  from waggle_tasks.rl.dance import Dance
  from waggle_tasks.rl.parallel import ParallelBroadcast, parallel_env
  from waggle_tasks.rl.read import Read
  from waggle_tasks.rl.single import Broadcast, gym_env

__all__ = [
  'Broadcast',
  'Dance',
  'ParallelBroadcast',
  'Read',
  'gym_env',
  'parallel_env',
]

_HOMES = {
  'Broadcast': 'single',
  'Dance': 'dance',
  'ParallelBroadcast': 'parallel',
  'Read': 'read',
  'gym_env': 'single',
  'parallel_env': 'parallel',
}


ids.register()


def __getattr__(name: str) -> object:
  if name not in _HOMES:
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
  home = importlib.import_module(f'{__name__}.{_HOMES[name]}')
  return getattr(home, name)


def __dir__() -> list[str]:
  return sorted({*globals(), *__all__})
