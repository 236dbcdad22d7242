"""The observer's camera as a composer observable."""

from collections.abc import Callable
import functools
import weakref

from dm_control import mjcf
from dm_control.composer.observation import observable
from dm_env import specs
import mujoco
import numpy as np

from waggle_tasks.entities import renderer, shutter

# Takes the renderer's own picture, which it must not write to, and returns what
# comes of it.
Spoil = Callable[[np.ndarray], np.ndarray]
# Takes what draws the scene as it is, and returns the picture that is exposed.
Expose = Callable[[mjcf.Physics, shutter.Draw], np.ndarray]

# One renderer, and so one scene and set of buffers, for each live Physics.
_RENDERERS: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()


def _renderer(physics: mjcf.Physics) -> renderer.Renderer:
  # Composer hands over a weak proxy; the model is the same for all of them.
  key = physics.model
  if key not in _RENDERERS:
    _RENDERERS[key] = renderer.Renderer(physics)
  return _RENDERERS[key]


class _Shown:
  """A picture for composer's buffer, which copies it when it is read.

  The buffer would also copy what is put into it; this hands over the picture
  itself, which stays as it is until the next frame.
  """

  def __init__(self, pixels: np.ndarray) -> None:
    self._pixels = pixels

  def __array__(
    self, dtype: np.typing.DTypeLike | None = None, copy: bool | None = None
  ) -> np.ndarray:
    del dtype, copy
    return self._pixels


class EyeCamera(observable.Observable):
  """Images of one camera, (H, W, 3) uint8 RGB."""

  def __init__(
    self,
    camera: mjcf.Element,
    incremental: bool = True,
    spoil: Spoil = lambda picture: picture,
    expose: Expose = lambda _, draw: draw().picture,
    size: tuple[int, int] | None = None,
  ) -> None:
    """Makes the observable.

    Its `corruptor` is free for a user's own: it takes a copy of each image as
    it comes, and the environment's random state, and returns what the observer
    gets instead.

    Args:
      camera: The MJCF camera.
      incremental: Whether to redraw only what changed.
      spoil: What happens to pictures on their way.
      expose: What takes the picture of the camera.
      size: Width and height of what comes of it; None for the camera's own.
    """
    super().__init__(
      update_interval=1,
      buffer_size=1,
      delay=None,
      aggregator=None,
      corruptor=None,
    )
    self._camera = camera
    self._incremental = incremental
    self._spoil, self._expose = spoil, expose
    self._size = size

  @property
  def array_spec(self) -> specs.BoundedArray:
    """The image's shape, type and range."""
    width, height = map(int, self._size or self._camera.resolution)
    shape = (height, width, 3)
    return specs.BoundedArray(shape, np.uint8, 0, 255, self._camera.name)

  def observation_callable(
    self,
    physics: mjcf.Physics,
    random_state: np.random.RandomState | None = None,
  ) -> Callable[[], np.ndarray | _Shown]:
    """What composer calls for each image, see the base class."""
    take = super().observation_callable(physics, random_state)
    if self.delay or (self.buffer_size or 1) > 1:  # It is kept for longer.
      return take
    return lambda: _Shown(take())

  def __call__(
    self,
    physics: mjcf.Physics,
    random_state: np.random.RandomState | None = None,
  ) -> np.ndarray:
    """The image now, a copy of its own."""
    return super().observation_callable(physics, random_state)().copy()

  def _callable(self, physics: mjcf.Physics) -> Callable[[], np.ndarray]:
    eyes = _renderer(physics)
    camera_id = physics.bind(self._camera).element_id
    model, data = physics.model.ptr, physics.data.ptr

    draw = functools.partial(eyes.drawn, camera_id, self._incremental)

    def take() -> np.ndarray:
      # A state that was just set shows, though nothing followed from it yet.
      mujoco.mj_kinematics(model, data)
      mujoco.mj_camlight(model, data)
      image = self._spoil(self._expose(physics, draw))
      # A corruptor may write to what it gets; the picture is kept for later.
      return image.copy() if self.corruptor else image

    return take
