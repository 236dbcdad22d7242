"""What a user switched on and would have no effect is refused."""

from collections.abc import Sequence

from dm_control import composer, mjcf

from waggle_tasks import errors
from waggle_tasks.tasks import episode_clock


class ObservableError(errors.WaggleError):
  """Something is to be observed by nobody."""


def check(
  task: composer.Task,
  observers: Sequence[composer.Entity],
  physics: mjcf.Physics,
) -> None:
  """Looks at a task when an episode begins.

  Args:
    task: The task.
    observers: Who has observations.
    physics: What was compiled of it.

  Raises:
    StepError: if the time step is not that which was compiled.
    ObservableError: if something is observed of anybody else.
  """
  if physics.timestep() != task.physics_timestep:
    raise episode_clock.StepError(
      '`physics_timestep` must be set before the first reset, which compiles'
      f' it: {physics.timestep():g} s is compiled, {task.physics_timestep:g} s'
      ' was asked for; `load` another environment'
    )
  for entity in task.root_entity.iter_entities():
    if entity in observers:
      continue
    for name, each in entity.observables.as_dict().items():
      if each.enabled:
        names = ', '.join(each.mjcf_model.model for each in observers)
        raise ObservableError(
          f'`enabled` of {name} must be False: only observers have'
          f' observations, {names}'
        )
