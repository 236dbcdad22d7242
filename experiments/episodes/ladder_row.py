"""What became of one broadcast on two levels of fidelity, as a value."""

import dataclasses

from waggle_tasks.experiments.episodes import ladder_table


@dataclasses.dataclass(frozen=True, kw_only=True)
class Row:
  """One broadcast to one observer.

  Attributes:
    identity: Which case it was, and by which sources.
    condition: What disturbed it.
    distance_m: Where the observer stood...
    angle_deg: ...and how far to the side.
    sent: The message.
    pixels: What was read of pictures; None for nothing.
    tracks: What was read of tracks; None for nothing, or where they were not
      made.
    late_s: How long after its last motion it was read of pictures.
    track: The errors of the tracker; None where it hardly saw anything.
    pixels_s: Processor time for pictures, up to the message.
    tracks_s: Processor time for tracks, up to the message.
    renderer: What drew the pictures.
  """

  identity: str
  condition: str
  distance_m: float
  angle_deg: float
  sent: str
  pixels: str | None = None
  tracks: str | None = None
  late_s: float | None = None
  track: ladder_table.Track | None = None
  pixels_s: float = 0.0
  tracks_s: float = 0.0
  renderer: str = ''
