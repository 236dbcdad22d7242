"""Plays a conversation by its rules alone: no picture, no flight.

The parts are those that fly; only what they are told is drawn. A frame is lost
to a reader with one probability, each by itself, and half of those that are
lost are noticed to have failed. Who dances is deaf, and for a moment after it.
"""

import dataclasses

import numpy as np

from waggle_tasks import conversation, errors
from waggle_tasks.agents import part, strips
from waggle_tasks.experiments.episodes import casting
from waggle_tasks.experiments.record import talk
from waggle_tasks.protocol import checks

# A new reader learns how a scene looks at rest, see `joint_config`, and START
# has a rest before it.
_LEARNS_S = 1.0
_NOTICED = 0.5


@dataclasses.dataclass
class _Dancer:
  """What is flown by one member, and since when it listens."""

  begin_s: float = -np.inf
  end_s: float = -np.inf
  said: part.Say | None = None
  told: bool = True

  def dances(self, now_s: float) -> bool:
    return now_s < self.end_s


def play(scene: conversation.Conversation, loss: float, seed: int) -> talk.Talk:
  """Plays a conversation to its end.

  Args:
    scene: Its scenario; only its rules count.
    loss: The probability that a frame is lost to a reader, 0 to 1.
    seed: Of what is lost.
  """
  checks.number('loss', loss, 0.0, 1.0, errors.ScenarioError)
  accord, parts = scene.accord, casting.cast(scene)
  rng = np.random.RandomState(seed)
  sees = [{v.member for v in accord.views(k)} for k in range(len(parts))]
  dancers = [_Dancer() for _ in parts]
  frame_s = accord.agreement.frame_s
  length_s = {part.LETTERS: accord.letter_s, part.REPLIES: accord.reply_s}
  frames, danced = 0, np.zeros(len(parts))
  for frames in range(accord.agreement.frames(scene.episode_s)):
    now_s = frames * frame_s
    heard = _heard(dancers, parts, sees, now_s, accord.confirm_s, loss, rng)
    dancing = [each.dances(now_s) for each in dancers]
    danced += dancing
    if not any(dancing) and all(each.done for each in parts):
      break
    for k, player in enumerate(parts):
      if dancing[k] or player.order is not None:
        continue
      busy = frozenset(j for j in sees[k] if dancing[j])
      said = player.step(now_s, heard[k], busy)
      if said is not None:
        end_s = now_s + length_s[said.kind]
        dancers[k] = _Dancer(now_s, end_s, said, told=False)
  return talk.Talk(
    scene,
    casting.told(scene),
    tuple(tuple(each.diary) for each in parts),
    tuple(None for _ in parts),
    tuple(0.0 for _ in parts),
    (),
    round(frames * frame_s, 6),
    tuple((danced * frame_s).round(6).tolist()),
  )


def _heard(
  dancers: list[_Dancer],
  parts: list[part.Part],
  sees: list[set[int]],
  now_s: float,
  confirm_s: float,
  loss: float,
  rng: np.random.RandomState,
) -> list[list[strips.Heard]]:
  """What each reads in this frame."""
  out: list[list[strips.Heard]] = [[] for _ in parts]
  for j, each in enumerate(dancers):
    if each.told or each.said is None or now_s < each.end_s + confirm_s:
      continue
    each.told = True
    for k, player in enumerate(parts):
      own = dancers[k]
      deaf = own.dances(now_s) or own.end_s + _LEARNS_S > each.begin_s
      if j not in sees[k] or deaf or player.hears != each.said.kind:
        continue
      if rng.uniform() >= loss:
        out[k].append(strips.Heard(now_s, j, each.said.bits))
      elif rng.uniform() < _NOTICED:
        out[k].append(strips.Heard(now_s, j, None, 'lost'))
  return out
