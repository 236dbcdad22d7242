"""Renders observers' images: anti-aliased, and only where something moved.

A picture is put together in a way that depends on the scene alone: the room
without its vehicles, and over it a window around each vehicle, or around
several whose windows overlap, drawn with everything that is seen in it. So it
is the same picture whether a part of it was drawn now or is still there from
before. A window is drawn with an off-centre frustum on the whole picture's
pixel grid.

Anti-aliasing is supersampling: every pixel is the mean of 2 x 2 samples, which
is deterministic and needs no multisample buffer.
"""

import dataclasses

import cv2
from dm_control import mjcf
import mujoco
import numpy as np

from waggle_tasks.entities import rigid, windows

WIDTH, HEIGHT = 640, 480  # Paper, section 'Scene, sensors, ...'.
_SAMPLES = 2  # Samples per pixel along each axis.
_HIDDEN_GROUP = 5  # Not drawn by default (MuJoCo, mjvOption.geomgroup).
# Bodies and cameras that moved less than this since they were drawn are at
# rest: 1e-6 m or rad is under a thousandth of a pixel at half a metre.
_STILL = 1e-6
# Whatever of the model shows in a picture and can be changed at run time.
_LOOKS = (
  'geom_rgba', 'geom_size', 'geom_matid', 'geom_pos', 'geom_quat', 'body_pos',
  'body_quat', 'mat_rgba', 'mat_texrepeat',
  'cam_fovy', 'light_active', 'light_diffuse', 'light_ambient', 'light_pos',
  'light_dir', 'light_castshadow', 'mat_reflectance',
)  # fmt: skip
_HEADLIGHT = ('ambient', 'diffuse', 'specular')
_WHOLE = (0, 0, WIDTH, HEIGHT)


@dataclasses.dataclass(eq=False)
class _Canvas:
  """One camera's picture and what it shows.

  Attributes:
    pixels: (HEIGHT, WIDTH, 3) uint8, the picture.
    room: (HEIGHT, WIDTH, 3) uint8, the picture without what can move.
    poses: (M, 7) of the parts when they were last drawn.
    boxes: (M, 4) windows that held them then.
    shown: The windows of the picture, each with the parts that it holds.
    camera: (12,) the camera's pose when the room was drawn.
    looks: Version of the model's looks when the room was drawn.
  """

  pixels: np.ndarray
  room: np.ndarray
  poses: np.ndarray | None = None
  boxes: np.ndarray | None = None
  shown: dict[windows.Window, frozenset[int]] = dataclasses.field(
    default_factory=dict
  )
  camera: np.ndarray | None = None
  looks: int = 0


class Renderer:
  """Draws any number of cameras of one Physics in one GL context."""

  def __init__(self, physics: mjcf.Physics) -> None:
    """Prepares scenes and buffers; draws nothing yet.

    Args:
      physics: A compiled model whose offscreen buffer is at least twice the
        size of an image.

    Raises:
      ValueError: if the offscreen buffer is too small.
    """
    self._physics = physics
    self._model = model = physics.model.ptr
    buffer = model.vis.global_.offwidth, model.vis.global_.offheight
    if buffer[0] < _SAMPLES * WIDTH or buffer[1] < _SAMPLES * HEIGHT:
      raise ValueError(
        '`offwidth` and `offheight` must be at least'
        f' {_SAMPLES * WIDTH} and {_SAMPLES * HEIGHT}: got {buffer}'
      )
    self._scene = mujoco.MjvScene(model, max(model.ngeom, 1) + 100)
    # Observers see no shadows: that of a moving body falls outside its window.
    self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
    self._option = mujoco.MjvOption()
    self._perturb = mujoco.MjvPerturb()
    self._camera = mujoco.MjvCamera()
    self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
    self._samples = np.empty(_SAMPLES**2 * HEIGHT * WIDTH * 3, np.uint8)
    self._canvases: dict[int, _Canvas] = {}
    self._looks: list[bytes] = []
    self._looks_version = 0
    self._find_parts()

  def _find_parts(self) -> None:
    """Finds what can be drawn, and hidden, on its own."""
    model, data = self._model, self._physics.data.ptr
    self._groups = model.geom_group.copy()
    drawn = self._option.geomgroup[self._groups].astype(bool)
    parts = rigid.find(model, data, drawn)
    self._geoms = [part.geoms for part in parts]
    self._bodies = np.array([part.body for part in parts], int)  # (M,)
    corners = [part.corners_m for part in parts]
    self._corners_m = np.reshape(corners, (-1, 8, 3))  # (M, 8, 3)

  def image(self, camera_id: int, incremental: bool = True) -> np.ndarray:
    """The camera's picture now.

    Args:
      camera_id: Index of the camera in the model.
      incremental: Whether to draw only what changed; otherwise everything is
        drawn. Both give the same picture.

    Returns:
      (HEIGHT, WIDTH, 3) uint8 RGB. It is the renderer's own buffer: copy it
      before the next call, and do not write to it.
    """
    if camera_id not in self._canvases:
      blank = np.empty((2, HEIGHT, WIDTH, 3), np.uint8)
      self._canvases[camera_id] = _Canvas(*blank)
    canvas, data = self._canvases[camera_id], self._physics.data
    poses = np.concatenate(
      [data.xpos[self._bodies], data.xquat[self._bodies]], axis=1
    )
    camera = np.append(data.cam_xpos[camera_id], data.cam_xmat[camera_id])
    self._watch_looks()
    anew = not incremental or self._must_begin_anew(canvas, camera)
    if anew:
      moved = np.arange(len(poses))
      canvas.poses, canvas.boxes = poses, np.empty((len(poses), 4), int)
      canvas.camera, canvas.looks = camera, self._looks_version
      canvas.shown = {}
    else:
      change = np.abs(canvas.poses - poses).max(axis=1, initial=0.0)
      moved = np.flatnonzero(change > _STILL)
    if moved.size or anew:
      canvas.poses[moved] = poses[moved]
      canvas.boxes[moved] = self._project(camera_id, moved)
      with self._physics.contexts.gl.make_current() as context:
        context.call(self._redraw, camera_id, canvas, moved, anew)
    return canvas.pixels

  def _watch_looks(self) -> None:
    headlight = self._model.vis.headlight
    looks = [getattr(self._model, name).tobytes() for name in _LOOKS]
    looks += [getattr(headlight, name).tobytes() for name in _HEADLIGHT]
    if looks != self._looks:
      self._looks, self._looks_version = looks, self._looks_version + 1
      self._find_parts()  # Their boxes follow from places and sizes.

  def _must_begin_anew(self, canvas: _Canvas, camera: np.ndarray) -> bool:
    """The rule of the full render: nothing that is kept may be out of date.

    A picture is begun anew the first time, when its camera has moved, when
    the model's looks changed, and always where windows cannot hold what
    moves, as in reflections.
    """
    return (
      canvas.poses is None
      or self._spills
      or canvas.looks != self._looks_version
      or bool(np.abs(canvas.camera - camera).max() > _STILL)
    )

  @property
  def _spills(self) -> bool:
    """Whether bodies change the picture outside their windows."""
    return bool(self._model.mat_reflectance.any())

  def _redraw(
    self, camera_id: int, canvas: _Canvas, moved: np.ndarray, anew: bool
  ) -> None:
    """Brings a picture up to date; needs the current GL context."""
    context = self._physics.contexts.mujoco.ptr
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
    self._camera.fixedcamid = camera_id
    mobile = np.flatnonzero(self._bodies > 0)
    spills = self._spills
    wanted = {}
    if not spills:
      wanted = windows.merge({i: tuple(canvas.boxes[i]) for i in mobile})
    try:
      if anew:
        hidden = set() if spills else set(mobile)
        self._draw(canvas, _WHOLE, canvas.room, hidden)
        canvas.pixels[:] = canvas.room
      changed = set(moved)
      kept = {
        window: parts
        for window, parts in canvas.shown.items()
        if wanted.get(window) == parts and not parts & changed
      }
      for window in canvas.shown.keys() - kept.keys():
        rows, columns = windows.slices(window)
        canvas.pixels[rows, columns] = canvas.room[rows, columns]
      for window in wanted.keys() - kept.keys():
        self._draw(canvas, window, canvas.pixels, set())
    finally:
      self._model.geom_group[:] = self._groups
    canvas.shown = wanted

  def _draw(
    self,
    canvas: _Canvas,
    window: windows.Window,
    pixels: np.ndarray,
    hidden: set[int],
  ) -> None:
    """Draws a window of a picture into `pixels`, without hidden parts."""
    self._update_scene(canvas, window, hidden)
    left, top, right, bottom = window
    width, height = _SAMPLES * (right - left), _SAMPLES * (bottom - top)
    area = mujoco.MjrRect(0, 0, width, height)
    context = self._physics.contexts.mujoco.ptr
    mujoco.mjr_render(area, self._scene, context)
    samples = self._samples[: height * width * 3].reshape(height, width, 3)
    mujoco.mjr_readPixels(samples, None, area, context)
    means = cv2.resize(
      samples, (right - left, bottom - top), interpolation=cv2.INTER_AREA
    )
    pixels[windows.slices(window)] = means[::-1]  # OpenGL counts from below.

  def _update_scene(
    self, canvas: _Canvas, window: windows.Window, hidden: set[int]
  ) -> None:
    """Fills the scene with what the window can show, seen through it."""
    for part, geoms in enumerate(self._geoms):
      seen = part not in hidden and windows.touch(window, canvas.boxes[part])
      group = self._groups[geoms] if seen else _HIDDEN_GROUP
      self._model.geom_group[geoms] = group
    mujoco.mjv_updateScene(
      self._model, self._physics.data.ptr, self._option, self._perturb,
      self._camera, mujoco.mjtCatBit.mjCAT_ALL, self._scene,
    )  # fmt: skip
    left, top, right, bottom = window
    for camera in self._scene.camera:
      half_height = camera.frustum_top
      half_width = half_height * WIDTH / HEIGHT
      camera.frustum_center = half_width * ((left + right) / WIDTH - 1)
      camera.frustum_width = half_width * (right - left) / WIDTH  # Half of it.
      camera.frustum_top = half_height * (1 - 2 * top / HEIGHT)
      camera.frustum_bottom = half_height * (1 - 2 * bottom / HEIGHT)

  def _project(self, camera_id: int, parts: np.ndarray) -> np.ndarray:
    """Windows (K, 4) int that hold parts (K,); empty when out of view."""
    model, data = self._model, self._physics.data
    bodies = self._bodies[parts]
    rotation = data.xmat[bodies].reshape(-1, 3, 3)
    corners = self._corners_m[parts] @ rotation.swapaxes(1, 2)  # (K, 8, 3)
    from_eye = corners + (data.xpos[bodies] - data.cam_xpos[camera_id])[:, None]
    in_eye = from_eye @ data.cam_xmat[camera_id].reshape(3, 3)
    near = model.vis.map.znear * model.stat.extent
    fovy = model.cam_fovy[camera_id]
    focal_px = HEIGHT / 2 / np.tan(np.radians(fovy) / 2)
    orthographic = mujoco.mjtProjection.mjPROJ_ORTHOGRAPHIC
    if model.cam_projection[camera_id] == orthographic:
      # Its `fovy` is the picture's height in m, whatever the depth: as 1 m.
      in_eye[..., 2], focal_px = -1.0, HEIGHT / fovy
    return windows.around(in_eye, near, focal_px, (WIDTH, HEIGHT))
