"""How large the flight room is; plain numbers that need no simulator."""

from waggle_tasks.arenas import layouts

# Flat floor for twenty observers in a line 0.6 m apart, or on an arc of 3 m,
# that then fly the longest message, 0.8 m; and the wall's curve around it.
HALF_WIDTH_M = 8.7
HALF_DEPTH_M = 6.8
HEIGHT_M = 7.0


def check_inside(name: str, pose: layouts.Pose) -> None:
  """Refuses a place outside of the room.

  Args:
    name: The vehicle's.
    pose: Its place.

  Raises:
    layouts.LayoutError: naming the vehicle, the rule and the place.
  """
  x_m, y_m, z_m = pose.position_m
  if not (
    abs(x_m) < HALF_WIDTH_M and abs(y_m) < HALF_DEPTH_M and 0.0 < z_m < HEIGHT_M
  ):
    raise layouts.LayoutError(
      f'`pose` of {name} must lie in the room, |x| < {HALF_WIDTH_M},'
      f' |y| < {HALF_DEPTH_M} and 0 < z < {HEIGHT_M} m: got {pose.position_m}'
    )
