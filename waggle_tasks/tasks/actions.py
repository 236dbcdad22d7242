"""Actions: one bounded reference for each observer."""

from collections.abc import Sequence
import math

from dm_env import specs
import numpy as np

from waggle_tasks import errors
from waggle_tasks.arenas import bounds
from waggle_tasks.protocol import limits, reference


class ActionError(errors.WaggleError):
  """An action that is not one finite reference for each observer."""


def read(
  action: Sequence[np.ndarray], names: Sequence[str]
) -> list[reference.Reference]:
  """Checks an action and brings it within its bounds.

  Args:
    action: A (13,) array for each observer, see `reference.Reference`.
    names: The observers.

  Raises:
    ActionError: naming the observer and what is wrong.
  """
  if len(action) != len(names):
    raise ActionError(
      f'`action` must hold one reference for each of {len(names)} observers:'
      f' got {len(action)}'
    )
  out = []
  for name, each in zip(names, action, strict=True):
    array = np.asarray(each, dtype=float)
    if array.shape != (reference.SIZE,) or not np.isfinite(array).all():
      raise ActionError(
        f'`action` of {name} must be {reference.SIZE} finite numbers:'
        f' got {array}'
      )
    out.append(reference.Reference.from_array(np.clip(array, *_BOUNDS)))
  return out


def specification(names: Sequence[str]) -> list[specs.BoundedArray]:
  """One (13,) float64 array for each observer, with its bounds."""
  return [
    specs.BoundedArray((reference.SIZE,), float, *_BOUNDS, name=name)
    for name in names
  ]


def _bounds() -> tuple[np.ndarray, np.ndarray]:
  """Lowest and highest reference, (13,) each: inside the room."""
  width_m, depth_m = bounds.HALF_WIDTH_M, bounds.HALF_DEPTH_M
  low_m = np.array([-width_m, -depth_m, 0.0])
  high_m = np.array([width_m, depth_m, bounds.HEIGHT_M])
  speed = np.full(3, limits.MAX_SPEED_MPS)
  acceleration = np.full(3, limits.MAX_SIDEWAYS_MPS2)
  return (
    np.concatenate([low_m, -speed, -acceleration, [-math.pi], low_m]),
    np.concatenate([high_m, speed, acceleration, [math.pi], high_m]),
  )


_BOUNDS = _bounds()
