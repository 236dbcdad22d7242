"""The time of an episode, in frames: that of the physics, checked.

The dance, drifts and what else moves are known at any time. So whoever sets the
physics back to an earlier state, its time included, sees the same again. A
state without its time, as `physics.get_state()` gives it, would be danced on
from where it is not: that is refused.
"""

from dm_control import mjcf
import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import agreement as agreement_lib

# Above what summing physics steps and normalising quaternions leave.
_SAME = 1e-6
# Sparser steps fly gestures off their path.
MAX_PHYSICS_TIMESTEP_S = 0.01
_REPLAY = (
  'take and set whole states, `state = physics.get_state(sig)` and'
  ' `physics.set_state(state, sig)` with'
  ' sig = mujoco.mjtState.mjSTATE_INTEGRATION'
)


class StepError(errors.WaggleError):
  """A time, or a time step, in which the dance cannot be flown."""


def check_timesteps(
  control_s: float, physics_s: float, agreement: agreement_lib.Agreement
) -> None:
  """Refuses time steps at which the agreed language is not what is flown.

  Raises:
    StepError: naming the time step, the rule and the value.
  """
  if not abs(control_s - agreement.frame_s) <= 1e-9:
    raise StepError(
      f'`control_timestep` must be {agreement.frame_s:g} s, as by `rate_hz` of'
      ' the scenario images, references and the dance come at'
      f' {agreement.rate_hz:g} Hz: got {control_s!r}'
    )
  if not 0 < physics_s <= MAX_PHYSICS_TIMESTEP_S:
    raise StepError(
      '`physics_timestep` must be above 0 and at most'
      f' {MAX_PHYSICS_TIMESTEP_S:g} s: got {physics_s!r}'
    )


class EpisodeClock:
  """Counts frames, and notices when somebody else moves the physics.

  Attributes:
    frame: How many frames the episode is old.
  """

  def __init__(
    self, physics: mjcf.Physics, agreement: agreement_lib.Agreement
  ) -> None:
    """Begins an episode."""
    self._agreement = agreement
    self.frame = 0
    self._note(physics)

  @property
  def time_s(self) -> float:
    """The time of the frame."""
    return self.frame * self._agreement.frame_s

  @property
  def middle_s(self) -> float:
    """The middle of the control step that follows the frame."""
    return self.time_s + self._agreement.frame_s / 2

  def tick(self, physics: mjcf.Physics) -> None:
    """Takes the end of a control step."""
    self.frame += 1
    self._note(physics)

  def set(self, physics: mjcf.Physics) -> None:
    """Takes the time that the physics was set to."""
    self.frame = self._agreement.frames(physics.time())
    self._note(physics)

  def was_set(self, physics: mjcf.Physics) -> bool:
    """Looks at the physics before a control step.

    Returns:
      Whether it was set to the time of another frame.

    Raises:
      StepError: if it is no frame's, or if the state was set without it.
    """
    time_s, frame_s = physics.time(), self._agreement.frame_s
    frame = self._agreement.frames(time_s)
    if abs(time_s - frame * frame_s) > _SAME:
      raise StepError(
        f'`time` of the physics must be a whole number of frames of'
        f' {frame_s:g} s when the environment steps: got {time_s:g} s'
      )
    if frame != self.frame:
      return True
    if np.abs(_state(physics) - self._state).max() > _SAME:
      raise StepError(
        'the state of the physics was set and its time was not, so that the'
        f' dance would go on from {time_s:g} s: {_REPLAY}'
      )
    return False

  def _note(self, physics: mjcf.Physics) -> None:
    self._state = _state(physics)


def _state(physics: mjcf.Physics) -> np.ndarray:
  return np.concatenate([physics.data.qpos, physics.data.qvel])
