"""A steady wind pushes every vehicle: a force that a hook applies."""

from dm_control import mjcf
import loop
import numpy as np

import waggle_tasks

FORCE_N = (0.003, 0.0, 0.0)  # About what 0.2 m/s does to a Crazyflie.


def main() -> None:
  """Flies a message in the wind, and prints how far it moved the observer."""
  environment = waggle_tasks.load('broadcast', observers=1, **loop.FAST)
  vehicles = [environment.task.performer, *environment.task.observers]
  off_m = []

  def blow(physics: mjcf.Physics, *_: object) -> None:
    for vehicle in vehicles:
      physics.bind(vehicle.root_body).xfrc_applied[:3] = FORCE_N

  def look(physics: mjcf.Physics, *_: object) -> None:
    off_m.append(environment.task.positions_m(physics)['observer_1'][0])

  environment.add_extra_hook('before_substep', blow)
  environment.add_extra_hook('after_step', look)
  loop.fly(environment, 'view_bank')
  print(f'blown {1e3 * np.median(off_m):.1f} mm to the side')


if __name__ == '__main__':
  main()
