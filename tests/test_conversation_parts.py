"""What members of a conversation do, by what they are told was read."""

from collections.abc import Callable
import itertools

import pytest

from waggle_tasks import conversation
from waggle_tasks.agents import caller, contender, listener, part, relay, strips
from waggle_tasks.protocol import accord, letters, parts

STEP_S = 0.04
NOBODY = frozenset[int]()


def rules(**changes: object) -> accord.Accord:
  return conversation.Conversation(**changes).accord


def until_it_says(
  player: part.Part,
  now_s: float,
  heard: tuple[strips.Heard, ...] = (),
  busy: frozenset[int] = NOBODY,
  most_s: float = 60.0,
) -> tuple[float, part.Say | None]:
  """Plays on until a member says something, or has nothing to say."""
  for step in itertools.count():
    at_s = now_s + STEP_S * step
    said = player.step(at_s, heard if not step else (), busy)
    if said is not None or player.done or step * STEP_S > most_s:
      return at_s, said


def reply(
  rule: accord.Accord, at_s: float, member: int, number: int, has: str = ''
) -> strips.Heard:
  bits = rule.replies.write(letters.Reply(number, has=has))
  return strips.Heard(at_s, member, bits)


def test_a_caller_ends_when_all_have_confirmed() -> None:
  rule = rules()
  player = caller.Caller(rule, 0, '101101')
  at_s, said = until_it_says(player, 0.0)
  assert rule.form.read(said.bits).payload == '101101'
  at_s += rule.letter_s + 3
  heard = tuple(reply(rule, at_s, k, k) for k in (1, 2, 3))
  _, said = until_it_says(player, at_s, heard)
  assert said is None
  assert player.done
  assert player.diary[-1].note == '3 of 3 confirmed after 1 try'


def test_it_says_again_what_was_not_confirmed_and_gives_up_in_the_end() -> None:
  rule = rules(tries=3)
  player = caller.Caller(rule, 0, '101101')
  now_s, said_s = 0.0, []
  while not player.done:
    now_s, said = until_it_says(player, now_s)
    if said is None:
      break
    said_s.append(now_s)
    now_s += rule.letter_s
    heard = tuple(reply(rule, now_s, k, k) for k in (1, 3))
    player.step(now_s, heard, NOBODY)
  assert len(said_s) == 3
  least_s = rule.letter_s + rule.window_s + rule.quiet_s
  assert all(b - a > least_s for a, b in itertools.pairwise(said_s))
  assert player.diary[-1].what == 'gives up'
  assert player.diary[-1].note == 'given up after 3 tries: 2 of 3 confirmed'
  assert sorted(player.confirmed) == [1, 3]


def test_a_number_in_the_place_of_another_one_confirms_nothing() -> None:
  rule = rules()
  player = caller.Caller(rule, 0, '101101')
  at_s, _ = until_it_says(player, 0.0)
  at_s += rule.letter_s
  player.step(at_s, (reply(rule, at_s, 1, 2),), NOBODY)
  assert player.confirmed == ()
  assert player.diary[-1].what == 'refused'
  player.step(at_s, (reply(rule, at_s, 2, letters.NOBODY),), NOBODY)
  assert player.confirmed == ()
  assert player.diary[-1].what == 'fails'


def test_only_parts_that_somebody_lacks_are_said_again() -> None:
  bits = '0110100001101001'
  rule = rules(bits=bits)
  player = caller.Caller(rule, 0, bits)
  now_s, first = 0.0, []
  for _ in range(rule.parts.count):
    now_s, said = until_it_says(player, now_s)
    first.append(rule.form.read(said.bits).number)
    now_s += rule.letter_s
  assert first == [0, 1, 2]
  heard = (
    reply(rule, now_s, 1, 1, '111'),
    reply(rule, now_s, 2, 2, '110'),
    reply(rule, now_s, 3, 3, '011'),
  )
  again = []
  now_s, said = until_it_says(player, now_s, heard)
  while said is not None and len(again) < 2:
    again.append(rule.form.read(said.bits).number)
    now_s, said = until_it_says(player, now_s + rule.letter_s)
  assert again == [0, 2]
  assert player.confirmed == (1,)


def test_a_listener_confirms_when_the_sender_has_rested() -> None:
  rule = rules()
  player = listener.Listener(rule, 2)
  letter = rule.form.write(letters.Letter('101101'))
  player.step(5.0, (strips.Heard(5.0, 0, letter),), frozenset({0}))
  at_s, said = until_it_says(player, 5.04)
  assert at_s == pytest.approx(5.04 + rule.ready_s, abs=2 * STEP_S)
  assert rule.replies.read(said.bits) == letters.Reply(2)
  assert player.message == '101101'
  at_s, said = until_it_says(player, at_s + rule.reply_s)
  assert said is None
  assert player.order == '101101'


def test_it_flies_nothing_while_the_sender_goes_on() -> None:
  rule = rules()
  player = listener.Listener(rule, 2)
  letter = rule.form.write(letters.Letter('101101'))
  player.step(5.0, (strips.Heard(5.0, 0, letter),), NOBODY)
  _, said = until_it_says(player, 5.04, busy=frozenset({0}))
  assert said is None
  assert player.order is None


def test_a_frame_that_failed_is_told_and_confirms_nothing() -> None:
  rule = rules()
  player = listener.Listener(rule, 1)
  failed = strips.Heard(5.0, 0, None, 'END was seen for 10% of its time')
  _, said = until_it_says(player, 5.0, (failed,))
  assert rule.replies.read(said.bits).member == letters.NOBODY
  assert said.note == 'NACK'
  assert player.message is None
  assert player.order is None


def test_who_has_it_confirms_again_though_the_next_frame_failed() -> None:
  rule = rules()
  player = listener.Listener(rule, 1)
  letter = rule.form.write(letters.Letter('101101'))
  at_s, _ = until_it_says(player, 5.0, (strips.Heard(5.0, 0, letter),))
  failed = strips.Heard(at_s + 4, 0, None, 'black')
  _, said = until_it_says(player, at_s + 4, (failed,))
  assert rule.replies.read(said.bits).member == 1


def test_parts_of_two_messages_are_not_mixed() -> None:
  one, other = '0110100001101001', '1110100001101001'
  cut = parts.Parts(len(one))
  rule = rules(bits=one)
  player = listener.Listener(rule, 1)
  mixed = [cut.cut(one)[0], cut.cut(other)[1], cut.cut(one)[2]]
  assert cut.cut(one)[1] == cut.cut(other)[1]
  mixed[0] = cut.cut(other)[0]
  for number, chunk in enumerate(mixed):
    bits = rule.form.write(letters.Letter(chunk, number=number))
    player.step(number, (strips.Heard(number, 0, bits),), frozenset({0}))
  assert player.message is None


class Chain:
  """A chain that is played by rules alone: each sees its neighbours."""

  def __init__(self, hops: int, loses: Callable[[int, int], bool]) -> None:
    scene = conversation.Conversation(mission='relay', hops=hops)
    self.rule, self.loses = scene.accord, loses
    first = letters.Letter('101101', recipient=hops)
    self.players = [
      relay.Relay(self.rule, k, None if k else first) for k in range(hops + 1)
    ]
    self.said: list[tuple[int, letters.Letter]] = []

  def play(self) -> None:
    ends_s, words = [-1.0] * len(self.players), [''] * len(self.players)
    for step in range(20_000):
      now_s = step * STEP_S
      dancing = [end_s > now_s for end_s in ends_s]
      for k, player in enumerate(self.players):
        if dancing[k] or player.done:
          continue
        near = [j for j in (k - 1, k + 1) if 0 <= j < len(self.players)]
        heard = tuple(
          strips.Heard(now_s, j, words[j])
          for j in near
          if words[j] and now_s - STEP_S < ends_s[j] + 0.2 <= now_s
          if not self.loses(j, k)
        )
        busy = frozenset(j for j in near if dancing[j])
        said = player.step(now_s, heard, busy)
        if said is not None:
          ends_s[k], words[k] = now_s + self.rule.letter_s, said.bits
          self.said.append((k, self.rule.form.read(said.bits)))
      if all(player.done for player in self.players):
        return


def test_a_chain_passes_a_letter_on_once_and_counts_hops() -> None:
  chain = Chain(4, lambda sender, reader: False)
  chain.play()
  assert [k for k, _ in chain.said] == [0, 1, 2, 3, 4]
  assert [each.hops for _, each in chain.said] == [0, 1, 2, 3, 4]
  assert {each.payload for _, each in chain.said} == {'101101'}
  assert chain.players[-1].order == '101101'
  assert all(player.confirmed for player in chain.players[:-1])


def test_a_hop_that_was_lost_is_said_again() -> None:
  lost = []

  def loses(sender: int, reader: int) -> bool:
    first = (sender, reader) == (1, 2) and not lost
    lost.extend([1] * first)
    return first

  chain = Chain(3, loses)
  chain.play()
  assert [k for k, _ in chain.said].count(1) == 2
  assert chain.players[-1].order == '101101'


def test_a_chain_that_is_cut_ends_with_it_said() -> None:
  chain = Chain(3, lambda sender, reader: reader == 2)
  chain.play()
  (last,) = [e for e in chain.players[1].diary if e.what == 'gives up']
  assert last.note == 'given up after 3: nobody passed it on'
  assert [player.order for player in chain.players[2:]] == [None, None]


def test_who_wants_to_dance_waits_until_all_rest() -> None:
  scene = conversation.Conversation(
    mission='dancers', listeners=4, distance_m=1.1
  )
  rule = scene.accord
  player = contender.Contender(rule, 0, scene.letters_of(0), seed=1)
  for step in range(500):
    assert player.step(step * STEP_S, (), frozenset({1})) is None
  at_s, said = until_it_says(player, 20.0)
  assert said is not None
  assert at_s >= 20.0 + rule.sense_s
  (waited,) = [each for each in player.diary if each.what == 'waits']
  assert '[1]' in waited.note


def test_two_dancers_draw_waits_of_their_own_from_the_seed() -> None:
  scene = conversation.Conversation(
    mission='dancers', listeners=4, distance_m=1.1
  )

  def begins_s(member: int, seed: int) -> float:
    told = scene.letters_of(member)
    player = contender.Contender(scene.accord, member, told, seed)
    return until_it_says(player, 0.0)[0]

  pairs = [(begins_s(0, seed), begins_s(1, seed)) for seed in range(20)]
  assert pairs == [(begins_s(0, s), begins_s(1, s)) for s in range(20)]
  assert sum(one != other for one, other in pairs) > 10


def test_an_answer_to_another_dancer_confirms_nothing() -> None:
  scene = conversation.Conversation(
    mission='dancers', listeners=4, distance_m=1.1
  )
  rule, told = scene.accord, scene.letters_of(0)
  player = contender.Contender(rule, 0, told, seed=1)
  at_s, _ = until_it_says(player, 0.0)
  at_s += rule.letter_s + 3
  to = told[0][0]
  for number, addressed in ((to, 1), (letters.NOBODY, 0), (to - 1, 0)):
    bits = rule.replies.write(letters.Reply(number, addressed))
    player.step(at_s, (strips.Heard(at_s, to, bits),), NOBODY)
  assert player.confirmed == []
  bits = rule.replies.write(letters.Reply(to, 0))
  player.step(at_s, (strips.Heard(at_s, to, bits),), NOBODY)
  assert player.confirmed == [to]
