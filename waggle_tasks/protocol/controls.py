"""What is performed instead of a message, or in part, to see what is read.

Paper, section 'Controls and supplemental suite', and the decoys.
"""

import math

from waggle_tasks.protocol import (
  decoys,
  frame,
  gestures,
  payload,
  performance,
  schedule,
  timing,
)

CONTROLS = ('none', 'no_send', 'black_input', 'interrupted', *decoys.DECOYS)


def perform(
  control: str,
  message: payload.Payload,
  seed: int,
  codebook: gestures.Codebook,
  pauses: timing.Timing,
  stop_s: float,
) -> performance.Performance:
  """What the performer flies.

  Args:
    control: One of `CONTROLS`.
    message: What is sent where a message is.
    seed: Of a decoy.
    codebook: The agreed gestures.
    pauses: The agreed pauses.
    stop_s: When transmission stops, where it is interrupted.
  """
  if control == 'no_send':
    return performance.Performance()
  if control in decoys.DECOYS:
    count = len(message.bits)
    return performance.Performance(
      decoys.perform(control, seed, codebook, pauses, count)
    )
  dance = schedule.broadcast(frame.motions(message), codebook, pauses)
  stops_s = stop_s if control == 'interrupted' else math.inf
  return performance.Performance(dance, stops_s, message)
