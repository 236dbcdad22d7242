"""Renders observers' images: anti-aliased, and only where something moved.

A picture is put together in a way that depends on the scene alone: the room
without its vehicles, and over it a window around each vehicle, or around
several whose windows overlap, drawn with everything that is seen in it. So it
is the same picture whether a part of it was drawn now or is still there from
before. A window is drawn with an off-centre frustum on the whole picture's
pixel grid.

A picture shows bodies where they were when they last moved noticeably, and so
does its camera: what is at rest drifts by less than can be seen, but enough to
put a sample on the other side of an edge.

Anti-aliasing is supersampling: every pixel is the mean of 2 x 2 samples, which
is deterministic and needs no multisample buffer.
"""

from collections.abc import Iterator
import contextlib
import functools

import cv2
from dm_control import mjcf
import mujoco
import numpy as np

from waggle_tasks.entities import canvas as canvas_lib
from waggle_tasks.entities import forks, framebuffer, rigid, shutter, windows

_SAMPLES = 2  # Samples per pixel along each axis.
_HIDDEN_GROUP = 5  # Not drawn by default (MuJoCo, mjvOption.geomgroup).
# Bodies and cameras that are nearer than this to where they are shown are at
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


class Renderer:
  """Draws any number of cameras of one Physics in one GL context.

  Each has pictures of its own size, the `resolution` of its MJCF element.
  """

  def __init__(self, physics: mjcf.Physics) -> None:
    """Prepares scenes and buffers; draws nothing yet.

    Args:
      physics: A compiled model whose offscreen buffer is at least twice the
        size of the largest image.

    Raises:
      ValueError: if the offscreen buffer is too small.
    """
    self._physics = physics
    self._model = model = physics.model.ptr
    buffer = model.vis.global_.offwidth, model.vis.global_.offheight
    width, height = _SAMPLES * model.cam_resolution.max(axis=0)
    if buffer[0] < width or buffer[1] < height:
      raise ValueError(
        f'`offwidth` and `offheight` must be at least {width} and {height}:'
        f' got {buffer}'
      )
    self._samples_px = int(width), int(height)
    self._scene = mujoco.MjvScene(model, max(model.ngeom, 1) + 100)
    # Observers see no shadows: that of a moving body falls outside its window.
    self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
    self._option = mujoco.MjvOption()
    self._perturb = mujoco.MjvPerturb()
    self._camera = mujoco.MjvCamera()
    self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
    self._canvases: dict[int, canvas_lib.Canvas] = {}
    headlight = model.vis.headlight
    self._look_fields = [
      *(getattr(model, name) for name in _LOOKS),
      *(getattr(headlight, name) for name in _HEADLIGHT),
    ]  # Views of the model's own memory.
    self._looks: list[bytes] = []
    self._looks_version = 0
    self._find_parts()

  def _find_parts(self) -> None:
    """Finds what can be drawn, and hidden, on its own."""
    model, data = self._model, self._physics.data.ptr
    self._groups = model.geom_group.copy()
    drawn = self._option.geomgroup[self._groups].astype(bool)
    parts = rigid.find(model, data, drawn)
    counts = [len(part.geoms) for part in parts]
    self._geoms = np.concatenate([part.geoms for part in parts])  # (K,)
    self._part_of = np.repeat(np.arange(len(parts)), counts)  # (K,)
    self._bodies = np.array([part.body for part in parts], int)  # (M,)
    self._mobile = np.flatnonzero(self._bodies > 0)
    can_move = self._bodies[self._part_of] > 0
    self._moving_geoms = self._geoms[can_move]  # (G,)
    self._moving_part_of = self._part_of[can_move]  # (G,)
    corners = [part.corners_m for part in parts]
    self._corners_m = np.reshape(corners, (-1, 8, 3))  # (M, 8, 3)
    self._spills = bool(model.mat_reflectance.any())

  @functools.cached_property
  def _frame(self) -> framebuffer.Framebuffer:
    """Made when the GL context is current for the first time."""
    return framebuffer.Framebuffer(*self._samples_px)

  def image(self, camera_id: int, incremental: bool = True) -> np.ndarray:
    """The camera's picture now.

    Args:
      camera_id: Index of the camera in the model.
      incremental: Whether to draw only what changed; otherwise everything is
        drawn. Both give the same picture.

    Returns:
      (H, W, 3) uint8 RGB. It is the renderer's own buffer: copy it
      before the next call, and do not write to it.

    Raises:
      ForkError: if this process was forked from one that drew.
    """
    forks.check()
    if camera_id not in self._canvases:
      width, height = self._model.cam_resolution[camera_id]
      blank = np.empty((2, height, width, 3), np.uint8)
      self._canvases[camera_id] = canvas_lib.Canvas(*blank)
    canvas = self._canvases[camera_id]
    self._watch_looks()
    began = canvas.looks == self._looks_version
    moved, eye_moved = self._take_poses(camera_id, canvas, began)
    # The rule of the full render: nothing that is kept may be out of date. A
    # picture is begun anew the first time, when the model's looks changed,
    # when its camera moved, and always where windows cannot hold what moves.
    anew = not (incremental and began) or eye_moved or self._spills
    if anew or moved.size:
      which = np.arange(len(canvas.poses)) if anew else moved
      canvas.boxes[which] = self._project(canvas, which)
      with self._physics.contexts.gl.make_current() as context:
        context.call(self._redraw, camera_id, canvas, moved, anew)
    return canvas.pixels

  def drawn(self, camera_id: int, incremental: bool = True) -> shutter.Drawn:
    """The camera's picture now, see `image`, and what of it is its room."""
    pixels = self.image(camera_id, incremental)
    canvas = self._canvases[camera_id]
    window = windows.around_all(canvas.shown)
    return shutter.Drawn(pixels, canvas.room, window, canvas.rooms)

  def _watch_looks(self) -> None:
    looks = [field.tobytes() for field in self._look_fields]
    if looks != self._looks:
      self._looks, self._looks_version = looks, self._looks_version + 1
      self._find_parts()  # Their boxes follow from places and sizes.

  def _take_poses(
    self, camera_id: int, canvas: canvas_lib.Canvas, began: bool
  ) -> tuple[np.ndarray, bool]:
    """Shows what has moved where it is now.

    This depends on the poses alone, and not on how a picture is drawn.

    Returns:
      The parts that moved, (K,), and whether the camera did.
    """
    data = self._physics.data.ptr
    bodies, geoms = self._bodies, self._moving_geoms
    poses = np.concatenate([data.xpos[bodies], data.xmat[bodies]], axis=1)
    eye = np.concatenate([data.cam_xpos[camera_id], data.cam_xmat[camera_id]])
    if not began:
      canvas.poses, canvas.eye = np.full_like(poses, np.inf), eye
      canvas.places = np.empty((len(geoms), 3)), np.empty((len(geoms), 9))
      canvas.boxes = np.empty((len(bodies), 4), int)
      canvas.looks, canvas.shown = self._looks_version, {}
      canvas.lens = canvas_lib.lens(self._model, camera_id)
    far = np.abs(canvas.poses - poses).max(axis=1, initial=0.0) > _STILL
    moved = np.flatnonzero(far)
    if moved.size:
      canvas.poses[moved] = poses[moved]
      which = far[self._moving_part_of]
      canvas.places[0][which] = data.geom_xpos[geoms[which]]
      canvas.places[1][which] = data.geom_xmat[geoms[which]]
    eye_moved = bool(np.abs(canvas.eye - eye).max() > _STILL)
    if eye_moved:
      canvas.eye = eye
    return moved, eye_moved

  def _redraw(
    self,
    camera_id: int,
    canvas: canvas_lib.Canvas,
    moved: np.ndarray,
    anew: bool,
  ) -> None:
    """Brings a picture up to date; needs the current GL context."""
    self._camera.fixedcamid = camera_id
    wanted: dict[windows.Window, frozenset[int]] = {}
    if not self._spills:
      wanted = windows.merge(
        {int(i): tuple(canvas.boxes[i]) for i in self._mobile}
      )
    with self._as_shown(camera_id, canvas):
      if anew:
        hidden = self._mobile[:0] if self._spills else self._mobile
        self._draw(canvas, (0, 0, *canvas.size), canvas.room, hidden)
        canvas.pixels[:] = canvas.room
        canvas.shown = {}
        canvas.rooms += 1
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
        self._draw(canvas, window, canvas.pixels, self._mobile[:0])
    canvas.shown = wanted

  @contextlib.contextmanager
  def _as_shown(
    self, camera_id: int, canvas: canvas_lib.Canvas
  ) -> Iterator[None]:
    """Everything is where the picture shows it."""
    data, geoms = self._physics.data.ptr, self._moving_geoms
    now = data.geom_xpos[geoms], data.geom_xmat[geoms]
    eye = data.cam_xpos[camera_id].copy(), data.cam_xmat[camera_id].copy()
    data.geom_xpos[geoms], data.geom_xmat[geoms] = canvas.places
    data.cam_xpos[camera_id] = canvas.eye[:3]
    data.cam_xmat[camera_id] = canvas.eye[3:]
    try:
      yield
    finally:
      self._model.geom_group[:] = self._groups
      data.geom_xpos[geoms], data.geom_xmat[geoms] = now
      data.cam_xpos[camera_id], data.cam_xmat[camera_id] = eye

  def _draw(
    self,
    canvas: canvas_lib.Canvas,
    window: windows.Window,
    pixels: np.ndarray,
    hidden: np.ndarray,
  ) -> None:
    """Draws a window of a picture into `pixels`, without hidden parts, (K,)."""
    self._update_scene(canvas, window, hidden)
    width, height = windows.size(window)
    context = self._physics.contexts.mujoco.ptr
    samples = self._frame.draw(
      context, self._scene, _SAMPLES * width, _SAMPLES * height
    )
    means = cv2.resize(samples, (width, height), interpolation=cv2.INTER_AREA)
    means = cv2.cvtColor(means, cv2.COLOR_RGBA2RGB)
    pixels[windows.slices(window)] = means[::-1]  # OpenGL counts from below.

  def _update_scene(
    self, canvas: canvas_lib.Canvas, window: windows.Window, hidden: np.ndarray
  ) -> None:
    """Fills the scene with what the window can show, seen through it."""
    seen = windows.touching(window, canvas.boxes)
    seen[hidden] = False
    self._model.geom_group[self._geoms] = np.where(
      seen[self._part_of], self._groups[self._geoms], _HIDDEN_GROUP
    )
    mujoco.mjv_updateScene(
      self._model, self._physics.data.ptr, self._option, self._perturb,
      self._camera, mujoco.mjtCatBit.mjCAT_ALL, self._scene,
    )  # fmt: skip
    left, top, right, bottom = window
    full_width, full_height = canvas.size
    for camera in self._scene.camera:
      half_height = camera.frustum_top
      half_width = half_height * full_width / full_height
      camera.frustum_center = half_width * ((left + right) / full_width - 1)
      # Half of it.
      camera.frustum_width = half_width * (right - left) / full_width
      camera.frustum_top = half_height * (1 - 2 * top / full_height)
      camera.frustum_bottom = half_height * (1 - 2 * bottom / full_height)

  def _project(
    self, canvas: canvas_lib.Canvas, parts: np.ndarray
  ) -> np.ndarray:
    """Windows (K, 4) int that hold parts (K,); empty when out of view."""
    poses = canvas.poses[parts]
    rotation = poses[:, 3:].reshape(-1, 3, 3)
    corners = self._corners_m[parts] @ rotation.swapaxes(1, 2)  # (K, 8, 3)
    from_eye = corners + (poses[:, :3] - canvas.eye[:3])[:, None]
    in_eye = from_eye @ canvas.eye[3:].reshape(3, 3)
    near_m, focal_px, flat = canvas.lens
    if flat:  # As if everything were 1 m away.
      in_eye[..., 2] = -1.0
    return windows.around(in_eye, near_m, focal_px, canvas.size)
