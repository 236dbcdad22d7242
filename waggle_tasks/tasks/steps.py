"""Tasks whose control steps are the frames that both sides agree on."""

from dm_control import composer
from dm_control.composer.observation import observable

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.tasks import episode_clock


class Framed(composer.Task):
  """A task of which every control step gives one value of each observable."""

  _steps = 1  # Composer's own interval between two values.

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What both sides know."""
    raise NotImplementedError

  @property
  def observables(self) -> list[dict[str, observable.Observable]]:
    """For each observer what it may see."""
    raise NotImplementedError

  def set_timesteps(
    self, control_timestep: float, physics_timestep: float
  ) -> None:
    """See `composer.Task`; a control step is a frame.

    Raises:
      StepError: if it is not, or if the physics step is too long.
    """
    episode_clock.check_timesteps(
      control_timestep, physics_timestep, self.agreement
    )
    super().set_timesteps(control_timestep, physics_timestep)
    # Composer counts physics steps: one value for each frame, unless its user
    # has asked for others.
    usual, self._steps = self._steps, self.physics_steps_per_control_step
    for visible in self.observables:
      for each in visible.values():
        if each.update_interval == usual:
          each.update_interval = self._steps

  @composer.Task.control_timestep.setter
  def control_timestep(self, new_value: float) -> None:
    """See `set_timesteps`."""
    self.set_timesteps(new_value, self.physics_timestep)

  @composer.Task.physics_timestep.setter
  def physics_timestep(self, new_value: float) -> None:
    """See `set_timesteps`."""
    self.set_timesteps(self.control_timestep, new_value)
