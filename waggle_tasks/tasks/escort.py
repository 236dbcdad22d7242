"""How observers are led to where their messages command, with 'avoid'."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from waggle_tasks.protocol import reference
from waggle_tasks.tasks import avoidance, convoy, safety
from waggle_tasks.tasks import parts as parts_lib


class Escort:
  """Those under way, and what they may fly to, in one episode."""

  def __init__(
    self, parts: parts_lib.Parts, dancers_m: Sequence[np.ndarray]
  ) -> None:
    """Begins with nobody under way.

    Args:
      parts: What the task is made of.
      dancers_m: (3,) where each dancer hovers.
    """
    self._kept_m, self._dancers_m = parts.kept_m, dancers_m
    self._free_s = max(each.end_s for each in parts.performances.values())
    self._convoy = convoy.Convoy(
      avoidance.Law(parts.kept_m), parts.agreement.frame_s
    )

  def free(self, time_s: float) -> bool:
    """Whether flights may begin: dancers avoid nobody, so they dance first."""
    return time_s >= self._free_s

  def settled_m(self, goal_m: np.ndarray, begin_m: np.ndarray) -> np.ndarray:
    """The place (3,) that stands for a goal, see `safety.settled_m`."""
    return safety.settled_m(goal_m, begin_m, self._dancers_m, self._kept_m)

  def begin(self, name: str, begin_m: np.ndarray, goal_m: np.ndarray) -> None:
    """Lets an observer go from its hover to its goal, (3,) each."""
    self._convoy.begin(name, begin_m, self.settled_m(goal_m, begin_m))

  def fly(
    self,
    wanted: Mapping[str, reference.Reference],
    refused: Sequence[str],
    sights: Callable[[], Mapping[str, convoy.Sight]],
  ) -> dict[str, reference.Reference]:
    """The references of those who are under way; of nobody else.

    Args:
      wanted: By name, what each observer asks for.
      refused: Who went astray, and is to come to rest.
      sights: Gives what each is told.
    """
    for name in refused:
      if name in self._convoy.names:
        self._convoy.halt(name)
    return self._convoy.fly(wanted, sights()) if self._convoy.names else {}
