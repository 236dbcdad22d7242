"""What is performed instead of a message, or in part, to see what is read.

Paper, section 'Controls and supplemental suite', and the decoys.
"""

from collections.abc import Callable, Sequence
import math

import numpy as np

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import (
  alphabets,
  decoys,
  frame,
  payload,
  performance,
  schedule,
)
from waggle_tasks.protocol.symbols import Symbol

CONTROLS = ('none', 'no_send', 'black_input', 'interrupted', *decoys.DECOYS)


def perform(
  control: str,
  message: payload.Payload,
  seed: int,
  agreement: agreement_lib.Agreement,
  stop_s: float,
  data: str = '',
  repeat: int = 1,
) -> performance.Performance:
  """What the performer flies.

  Args:
    control: One of `CONTROLS`.
    message: What is sent where a message is.
    seed: Of a decoy.
    agreement: What both sides know.
    stop_s: When transmission stops, where it is interrupted.
    data: Bits that are sent in place of the message; empty for none.
    repeat: How often everything is said.
  """
  if control == 'no_send':
    return performance.Performance()
  if control in decoys.DECOYS:
    return performance.Performance(_decoy(control, message, seed, agreement))
  stops_s = stop_s if control == 'interrupted' else math.inf
  language = agreement.language
  if language is None:
    dance = schedule.broadcast(
      frame.motions(message), agreement.codebook, agreement.pauses
    )
    return performance.Performance(dance, stops_s, message)
  cut = agreement.packets
  said = (message.bits,) if cut is None else cut.split(data)
  frames: list[tuple[alphabets.Token, ...]] = [
    (Symbol.START, *agreement.word(bits), Symbol.END) for bits in said
  ]
  once_s = language.fly(frames)[-1].end_s
  slots = language.fly(frames * repeat)
  says = payload.Data(data) if data else message
  return performance.Performance(
    schedule.Schedule(slots), stops_s, says, once_s
  )


def _decoy(
  control: str,
  message: payload.Payload,
  seed: int,
  agreement: agreement_lib.Agreement,
) -> schedule.Schedule:
  """A decoy, in the motions of the language that is spoken."""
  language, count = agreement.language, len(message.bits)
  if language is None:
    return decoys.perform(
      control, seed, agreement.codebook, agreement.pauses, count
    )
  rng = np.random.RandomState(seed)
  if paths := decoys.figures(control, rng):
    return schedule.lay_out(paths, agreement.pauses)
  words = decoys.Words(_draw(agreement), language.alphabet.size)
  motions = decoys.tokens(control, rng, words)
  return schedule.Schedule(language.fly([motions]))


def _draw(
  agreement: agreement_lib.Agreement,
) -> Callable[[np.random.RandomState], Sequence[int]]:
  """Draws the symbols of frames."""

  def draw(rng: np.random.RandomState) -> Sequence[int]:
    bits = ''.join(str(rng.randint(2)) for _ in range(agreement.frame_bits))
    return [*agreement.word(bits)]

  return draw
