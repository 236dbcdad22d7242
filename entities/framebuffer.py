"""Where observers' images are drawn before they are read back."""

import ctypes

import mujoco
import numpy as np
from OpenGL import GL
from OpenGL.raw.GL.VERSION import GL_1_0


class Framebuffer:
  """A framebuffer of one GL context, beside the one that MuJoCo made.

  MuJoCo's has a stencil, for reflections. Without one, software draws in half
  of the time. Pixels are read with an alpha channel, as they are stored.
  """

  def __init__(self, width: int, height: int) -> None:
    """Makes the framebuffer; its GL context must be current, here and later.

    Args:
      width: Of the largest area to be drawn.
      height: The same.
    """
    self._pixels = np.empty(height * width * 4, np.uint8)
    self._address = self._pixels.ctypes.data_as(ctypes.c_void_p)
    self._name = int(GL.glGenFramebuffers(1))
    GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._name)
    for place, form in (
      (GL.GL_COLOR_ATTACHMENT0, GL.GL_RGBA8),
      (GL.GL_DEPTH_ATTACHMENT, GL.GL_DEPTH_COMPONENT32F),
    ):
      buffer = GL.glGenRenderbuffers(1)
      GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
      GL.glRenderbufferStorage(GL.GL_RENDERBUFFER, form, width, height)
      GL.glFramebufferRenderbuffer(
        GL.GL_FRAMEBUFFER, place, GL.GL_RENDERBUFFER, buffer
      )

  def draw(
    self,
    context: mujoco.MjrContext,
    scene: mujoco.MjvScene,
    width: int,
    height: int,
  ) -> np.ndarray:
    """Draws a scene.

    Args:
      context: The MuJoCo context that draws; it is not kept, as dm_control
        frees only what nobody else holds.
      scene: What to draw.
      width: Of the area to draw.
      height: The same.

    Returns:
      (height, width, 4) uint8, the lowest row first; the array is used again
      by the next call.
    """
    own, context.offFBO = context.offFBO, self._name
    try:
      mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
      mujoco.mjr_render(mujoco.MjrRect(0, 0, width, height), scene, context)
      GL_1_0.glReadPixels(
        0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, self._address
      )
    finally:
      context.offFBO = own
    return self._pixels[: height * width * 4].reshape(height, width, 4)
