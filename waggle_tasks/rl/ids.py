"""The names under which `gymnasium.make` knows environments."""

import gymnasium

from waggle_tasks import scenarios

_VERSION = 0


def register() -> None:
  """Names every scenario, 'waggle/Broadcast-v0' and so on, and `Read`."""
  for name in scenarios.SCENARIOS:
    words = ''.join(part.capitalize() for part in name.split('_'))
    gymnasium.register(
      f'waggle/{words}-v{_VERSION}',
      'waggle_tasks.rl.single:Broadcast',
      kwargs={'name': name},
    )
  gymnasium.register(f'waggle/Read-v{_VERSION}', 'waggle_tasks.rl.read:Read')
