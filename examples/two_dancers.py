"""Two dance at once; who watches follows the one in its picture's middle."""

import dataclasses

import loop

from waggle_tasks import registry, scenarios
from waggle_tasks.entities import performer
from waggle_tasks.tasks import broadcast, roles


def main() -> None:
  """The second one dances another message, to the side and behind."""
  scene = scenarios.find('broadcast', observers=1, **loop.FAST)
  other = dataclasses.replace(scene, payload='101001')
  made = registry.parts(scene)
  middle = made.poses['performer']
  place = dataclasses.replace(middle, position_m=(0.8, 0.5, 1.3))
  beside = roles.Role(performer.Performer('dancer'), place, other.performance)
  task = broadcast.Broadcast(
    dataclasses.replace(made, roles=(*made.roles, beside))
  )
  loop.fly(registry.of_task(task))


if __name__ == '__main__':
  main()
