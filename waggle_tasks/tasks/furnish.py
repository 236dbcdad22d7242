"""Puts what else moves into a room: other vehicles, and a board."""

from collections.abc import Mapping
import math

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import board, bystander
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.tasks import surroundings as surroundings_lib

# The board passes half of the way to the nearest observer, where that is
# outside of the dance.
_SHARE = 0.5
# It follows its circle this far beyond the outermost observer, and the tangent
# then leads behind the performer, clear of the other side's observers.
_BEYOND_RAD = math.radians(45)


def furnish(
  room: flight_room.FlightRoom,
  surroundings: surroundings_lib.Surroundings,
  poses: Mapping[str, layouts.Pose],
  agreement: agreement_lib.Agreement,
  spinning: bool = False,
) -> None:
  """Adds what there is to a room; with the defaults nothing.

  Args:
    room: The room.
    surroundings: What moves in it.
    poses: Where the vehicles start, the performer first.
    agreement: What both sides know.
    spinning: Whether propellers are drawn as turning.
  """
  audience = surroundings_lib.Audience.of(poses)
  for number in range(surroundings.bystanders):
    right_m, away_m, up_m = surroundings_lib.PLACES_M[number]
    middle_m = audience.place_m(
      right_m, away_m, agreement.hover_height_m + up_m
    )
    room.add_guided(
      bystander.Bystander(
        f'bystander_{number + 1}',
        middle_m,
        surroundings_lib.CIRCLE_M,
        surroundings_lib.SPREAD_M,
        agreement,
        spinning,
      )
    )
  if surroundings.occluder_every_s:
    room.add_guided(
      board.Board(
        max(surroundings_lib.BOARD_M, _SHARE * audience.nearest_m),
        audience.bearing_rad,
        audience.half_span_rad + _BEYOND_RAD,
        surroundings.occluder_width_m,
        surroundings.occluder_mps,
        surroundings.occluder_every_s,
        agreement,
      )
    )
