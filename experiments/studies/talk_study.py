"""Many conversations, with loss, by their rules or on rendered images."""

from collections.abc import Iterator
import dataclasses

from waggle_tasks import conversation
from waggle_tasks.experiments.episodes import talk_rules, talking
from waggle_tasks.experiments.record import talk


def held(
  scene: conversation.Conversation, times: int, loss: float | None
) -> Iterator[talk.Talk]:
  """Holds a conversation again and again, each with a seed of its own.

  Args:
    scene: Its scenario, with the seed of the first one.
    times: How often.
    loss: The probability that a frame is lost, to play rules alone; None for
      rendered images.
  """
  for number in range(times):
    each = dataclasses.replace(scene, seed=(scene.seed + number) % 2**32)
    if loss is None:
      yield talking.hold(each)
    else:
      yield talk_rules.play(each, loss, each.seed)
