"""Renders observers' images: anti-aliased, and only where something moved.

Anti-aliasing is supersampling: every pixel is the mean of 2 x 2 samples, so it
is deterministic and needs no multisample buffer. A window of the picture is
drawn with an off-centre frustum on the whole picture's own pixel grid and
with everything that can be seen in it, so it holds the pixels that a full
render would put there.
"""

import dataclasses

import cv2
from dm_control import mjcf
import mujoco
import numpy as np

WIDTH, HEIGHT = 640, 480  # Paper, section 'Scene, sensors, ...'.
_SAMPLES = 2  # Samples per pixel along each axis.
# Past this share of the picture a full render is cheaper than windows.
_LARGEST_SHARE = 0.25
_HIDDEN_GROUP = 5  # Not drawn by default (MuJoCo, mjvOption.geomgroup).
# Bodies and cameras that moved less than this since they were drawn are at
# rest: 1e-6 m or rad is under a thousandth of a pixel at half a metre.
_STILL = 1e-6
# Whatever of the model shows in a picture and can be changed at run time.
_LOOKS = (
  'geom_rgba', 'geom_size', 'geom_matid', 'mat_rgba', 'mat_texrepeat',
  'cam_fovy', 'light_active', 'light_diffuse', 'light_ambient', 'light_pos',
  'light_dir', 'light_castshadow', 'mat_reflectance',
)  # fmt: skip

Window = tuple[int, int, int, int]  # left, top, right, bottom in pixels.
_WHOLE: Window = (0, 0, WIDTH, HEIGHT)


@dataclasses.dataclass(eq=False)
class _Canvas:
  """One camera's picture and what it shows."""

  pixels: np.ndarray  # (HEIGHT, WIDTH, 3) uint8
  poses: np.ndarray | None = None  # (M, 7) of the movers when last drawn
  boxes: np.ndarray | None = None  # (M, 4) windows that held them then
  camera: np.ndarray | None = None  # (12,) camera pose when drawn whole
  looks: int = 0  # Version of the model's looks when drawn whole


class Renderer:
  """Draws any number of cameras of one Physics in one GL context.

  A camera's last picture is kept. `image` redraws it whole when the rule in
  `_needs_whole` says so, and otherwise only the windows that hold, or held,
  a rigid body that moved since.
  """

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
    self._option = mujoco.MjvOption()
    self._perturb = mujoco.MjvPerturb()
    self._camera = mujoco.MjvCamera()
    self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
    self._samples = np.empty(
      (_SAMPLES**2 * HEIGHT * WIDTH * 3,), dtype=np.uint8
    )
    self._canvases: dict[int, _Canvas] = {}
    self._find_movers()
    self._looks: list[bytes] = []
    self._looks_version = 0

  def _find_movers(self) -> None:
    """Finds the rigid bodies that can move, with a box around each."""
    model = self._model
    drawn = self._option.geomgroup[model.geom_group].astype(bool)
    weld = model.body_weldid[model.geom_bodyid]  # (ngeom,)
    self._movers = np.unique(weld[drawn & (weld > 0)])  # (M,) body ids
    # The boxes and the visible geoms of mover m.
    self._geoms = [np.flatnonzero(drawn & (weld == m)) for m in self._movers]
    self._groups = model.geom_group.copy()
    self._boxes = np.stack(
      [self._box(body, geoms) for body, geoms in zip(
        self._movers, self._geoms, strict=True)]
    ) if len(self._movers) else np.empty((0, 8, 3))  # fmt: skip

  def _box(self, body: int, geoms: np.ndarray) -> np.ndarray:
    """The 8 corners (8, 3) of a box around geoms, in the body's frame."""
    data = self._physics.data
    signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T  # (8, 3)
    to_body = data.xmat[body].reshape(3, 3)
    corners = []
    for geom in geoms:
      centre, half = np.split(self._model.geom_aabb[geom], 2)
      rotation = data.geom_xmat[geom].reshape(3, 3)
      world = data.geom_xpos[geom] + (centre + signs * half) @ rotation.T
      corners.append((world - data.xpos[body]) @ to_body)
    low, high = np.min(corners, (0, 1)), np.max(corners, (0, 1))
    return np.where(signs < 0, low, high)

  def image(self, camera_id: int, incremental: bool = True) -> np.ndarray:
    """The camera's picture now.

    Args:
      camera_id: Index of the camera in the model.
      incremental: Whether to redraw only what changed; otherwise the whole
        picture is drawn. Both give the same picture.

    Returns:
      (HEIGHT, WIDTH, 3) uint8 RGB. It is the renderer's own buffer: copy it
      before the next call, and do not write to it.
    """
    canvas = self._canvases.get(camera_id)
    if canvas is None:
      canvas = _Canvas(np.empty((HEIGHT, WIDTH, 3), dtype=np.uint8))
      self._canvases[camera_id] = canvas
    data = self._physics.data
    poses = np.concatenate(
      [data.xpos[self._movers], data.xquat[self._movers]], axis=1
    )
    camera = np.append(data.cam_xpos[camera_id], data.cam_xmat[camera_id])
    self._watch_looks()
    boxes = self._project(camera_id, poses)
    if not incremental or self._needs_whole(canvas, camera):
      windows = [_WHOLE]
      canvas.camera, canvas.looks = camera, self._looks_version
      canvas.poses, canvas.boxes = poses, boxes
    else:
      moved = np.abs(canvas.poses - poses).max(axis=1) > _STILL
      windows = _changed(canvas.boxes[moved], boxes[moved])
      canvas.poses[moved], canvas.boxes[moved] = poses[moved], boxes[moved]
    if windows:
      with self._physics.contexts.gl.make_current() as context:
        context.call(self._draw, camera_id, canvas, windows, boxes)
    return canvas.pixels

  def _watch_looks(self) -> None:
    looks = [getattr(self._model, name).tobytes() for name in _LOOKS]
    if looks != self._looks:
      self._looks, self._looks_version = looks, self._looks_version + 1

  def _needs_whole(self, canvas: _Canvas, camera: np.ndarray) -> bool:
    """The rule of the full render: nothing kept may be out of date.

    A picture is drawn whole the first time, when its camera has moved, when
    the model's looks changed, and always in a scene with shadows or
    reflections, as those of a moving body fall outside its own window.
    """
    model = self._model
    return (
      canvas.poses is None
      or bool(model.light_castshadow.any() or model.mat_reflectance.any())
      or canvas.looks != self._looks_version
      or bool(np.abs(canvas.camera - camera).max() > _STILL)
    )

  def _project(self, camera_id: int, poses: np.ndarray) -> np.ndarray:
    """Windows (M, 4) int that hold each mover; empty when out of view."""
    model, data = self._model, self._physics.data
    rotation = data.xmat[self._movers].reshape(-1, 3, 3)
    world = self._boxes @ rotation.swapaxes(1, 2) + poses[:, None, :3]
    to_camera = data.cam_xmat[camera_id].reshape(3, 3)
    x, y, z = np.moveaxis(
      (world - data.cam_xpos[camera_id]) @ to_camera, -1, 0
    )  # (M, 8) each; the camera looks along -z.
    near = model.vis.map.znear * model.stat.extent
    focal_px = HEIGHT / 2 / np.tan(np.radians(model.cam_fovy[camera_id]) / 2)
    depth = np.maximum(-z, near)
    u = WIDTH / 2 + focal_px * x / depth
    v = HEIGHT / 2 - focal_px * y / depth
    windows = np.stack(
      [u.min(1) - 1, v.min(1) - 1, u.max(1) + 2, v.max(1) + 2], axis=1
    )
    in_front = (-z > near).any(1)
    windows[in_front & (-z < near).any(1)] = _WHOLE
    windows = np.clip(np.floor(windows), 0, np.tile([WIDTH, HEIGHT], 2))
    windows[~in_front] = 0
    return windows.astype(int)

  def _draw(
    self, camera_id: int, canvas: _Canvas, windows: list[Window],
    boxes: np.ndarray,
  ) -> None:  # fmt: skip
    """Draws windows of a camera's picture; needs the current GL context."""
    context = self._physics.contexts.mujoco.ptr
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
    self._camera.fixedcamid = camera_id
    try:
      for window in windows:
        self._update_scene(window, boxes)
        left, top, right, bottom = window
        width, height = _SAMPLES * (right - left), _SAMPLES * (bottom - top)
        area = mujoco.MjrRect(0, 0, width, height)
        mujoco.mjr_render(area, self._scene, context)
        samples = self._samples[: height * width * 3].reshape(height, width, 3)
        mujoco.mjr_readPixels(samples, None, area, context)
        means = cv2.resize(
          samples, (right - left, bottom - top), interpolation=cv2.INTER_AREA
        )
        # OpenGL's first row is the lowest.
        canvas.pixels[top:bottom, left:right] = means[::-1]
    finally:
      self._model.geom_group[:] = self._groups

  def _update_scene(self, window: Window, boxes: np.ndarray) -> None:
    """Fills the scene with what the window can show, seen through it."""
    for geoms, box in zip(self._geoms, boxes, strict=True):
      in_window = _touch(window, box)
      self._model.geom_group[geoms] = (
        self._groups[geoms] if in_window else _HIDDEN_GROUP
      )
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


def _changed(before: np.ndarray, after: np.ndarray) -> list[Window]:
  """Disjoint windows around boxes (K, 4) that moved from before to after."""
  windows: list[Window] = []
  for window in map(_union, before, after):
    while overlap := [other for other in windows if _touch(other, window)]:
      windows.remove(overlap[0])
      window = _union(window, overlap[0])
    if _area(window):
      windows.append(window)
  share = sum(map(_area, windows)) / _area(_WHOLE)
  return [_WHOLE] if share > _LARGEST_SHARE else windows


def _union(a: Window, b: Window) -> Window:
  if not _area(a) or not _area(b):
    a = b = a if _area(a) else b
  return (
    int(min(a[0], b[0])), int(min(a[1], b[1])),
    int(max(a[2], b[2])), int(max(a[3], b[3])),
  )  # fmt: skip


def _touch(a: Window, b: Window) -> bool:
  return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _area(window: Window) -> int:
  return (window[2] - window[0]) * (window[3] - window[1])
