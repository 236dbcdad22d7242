"""Many conversations, with loss, by their rules or on rendered images."""

from collections.abc import Iterator
import dataclasses

import numpy as np

from waggle_tasks import conversation
from waggle_tasks.experiments.episodes import talk_rules, talking
from waggle_tasks.experiments.record import talk


def held(
  scene: conversation.Conversation, times: int, loss: float | None
) -> Iterator[talk.Talk]:
  """Holds a conversation again and again.

  Each has a seed and a message of its own, as long as that of the scenario.

  Args:
    scene: Its scenario, with the seed of the first one.
    times: How often.
    loss: The probability that a frame is lost, to play rules alone; None for
      rendered images.
  """
  for number in range(times):
    each = _drawn(scene, (scene.seed + number) % 2**32)
    if loss is None:
      yield talking.hold(each)
    else:
      yield talk_rules.play(each, loss, each.seed)


def _drawn(
  scene: conversation.Conversation, seed: int
) -> conversation.Conversation:
  """The same with another seed, and what that draws."""
  rng = np.random.RandomState(seed)

  def draw(bits: str) -> str:
    return ''.join(str(rng.randint(2)) for _ in bits)

  return dataclasses.replace(
    scene, seed=seed, payload=draw(scene.payload), bits=draw(scene.bits)
  )
