"""Renders a 640x480 frame twice and prints what happened as one JSON object.

Run as a file in a process of its own (see `gl.py`), because a broken GL stack
may abort or hang. It imports nothing of waggle_tasks, so that it also tells
what happens on versions that waggle_tasks refuses.
"""

import json
import time

_SCENE = """
<mujoco>
  <worldbody>
    <light pos="0 0 3"/>
    <geom type="plane" size="1 1 0.1" rgba="0.3 0.5 0.8 1"/>
    <geom type="box" size="0.2 0.2 0.2" pos="0 0 0.2" rgba="0.9 0.4 0.2 1"/>
    <camera name="view" pos="0 0 3"/>
  </worldbody>
</mujoco>
"""


def render() -> dict[str, str | float]:
  """Returns backend, renderer, and the seconds of a first and second frame.

  Raises:
    Exception: Whatever the GL stack raises, at import or at the first frame.
  """
  # Imported here, because choosing a GL backend already fails at the import.
  from dm_control import mujoco
  from OpenGL import GL

  physics = mujoco.Physics.from_xml_string(_SCENE)
  times_s = []
  for _ in range(2):
    start_s = time.perf_counter()
    frame = physics.render(480, 640, 'view')  # (480, 640, 3)
    times_s.append(time.perf_counter() - start_s)
  if frame.min() == frame.max():
    raise RuntimeError('the frame came back in a single colour')
  context = physics.contexts.gl
  with context.make_current() as executor:
    renderer = executor.call(GL.glGetString, GL.GL_RENDERER)
  return {
    'backend': type(context).__name__.removesuffix('Context').lower(),
    'renderer': renderer.decode() if renderer else 'unnamed renderer',
    'first_s': times_s[0],
    'frame_s': times_s[1],
  }


if __name__ == '__main__':
  try:
    report = render()
  except Exception as error:
    line = ' '.join(str(error).split())
    report = {'error': f'{type(error).__name__}: {line}'}
  print(json.dumps(report))
