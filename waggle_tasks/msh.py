"""Triangle meshes as files of MuJoCo's own format, MSH.

They are read much faster than numbers printed into a model.
"""

import numpy as np


def pack(
  vertices_m: np.ndarray,
  faces: np.ndarray,
  normals: np.ndarray = np.empty((0, 3)),
) -> bytes:
  """Returns the bytes of a file.

  Args:
    vertices_m: Corners, (V, 3).
    faces: Three indices into the corners a triangle, (F, 3).
    normals: Unit vectors at the corners, (V, 3); or none.
  """
  counts = len(vertices_m), len(normals), 0, len(faces)
  parts = (
    np.array(counts, np.int32),
    vertices_m.astype(np.float32),
    normals.astype(np.float32),
    faces.astype(np.int32),
  )
  return b''.join(part.tobytes() for part in parts)
