"""Observers on steps, each farther away and more to the side than the last."""

import dataclasses
import math

import loop

import waggle_tasks
from waggle_tasks import layouts


@dataclasses.dataclass(frozen=True)
class Steps:
  """A layout of one's own: any class with `poses`."""

  nearest_m: float = 1.0
  step_m: float = 0.4
  turn_rad: float = math.radians(25)

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    """Where each observer starts; all of them face the performer."""
    out = []
    for number in range(count):
      radius_m = self.nearest_m + number * self.step_m
      angle = number * self.turn_rad
      x_m, y_m = radius_m * math.sin(angle), -radius_m * math.cos(angle)
      out.append(layouts.facing_performer(x_m, y_m))
    return tuple(out)


def main() -> None:
  """Flies a message before them."""
  changes = {'observers': 2, 'layout': Steps(), **loop.FAST}
  loop.fly(waggle_tasks.load('broadcast', **changes))


if __name__ == '__main__':
  main()
