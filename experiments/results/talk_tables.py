"""What a conversation came to, as text."""

from collections.abc import Iterator

from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import talk as talk_lib

_HEADER = (
  'told by', 'to', 'bits', 'has it', 'at s', 'confirmed s', 'flew s',
)  # fmt: skip


def report(talk: talk_lib.Talk) -> str:
  """A line for all that was to be told, and what it came to."""
  rows = []
  for each in talk.told:
    has_s = [at for at, bits in talk.has(each.recipient) if bits == each.bits]
    seen = [
      time_s
      for sender, member, time_s in talk.confirmed
      if (sender, member) == (each.sender, each.recipient)
    ]
    flew_s = talk.flew_s[each.recipient]
    rows.append(
      (
        name(each.sender),
        name(each.recipient),
        each.bits,
        'yes' if has_s else 'NO',
        table.number(has_s[0] if has_s else None),
        table.number(seen[0] if seen else None),
        table.number(flew_s),
      )
    )
  return '\n'.join([table.render(_HEADER, rows), '', *_verdict(talk)])


def name(member: int) -> str:
  """What a member is called."""
  return f'member_{member}'


def _verdict(talk: talk_lib.Talk) -> Iterator[str]:
  for sender, diary in enumerate(talk.diaries):
    for entry in diary:
      if entry.what in ('done', 'gives up'):
        yield f'{name(sender)}: {entry.note} ({entry.time_s:.2f} s)'
  if talk.scene.mission == 'relay' and talk.hops_s:
    longest = max(talk.hops_s)
    yield (
      f'{len(talk.hops_s)} hops, from dance to dance at most {longest:.2f} s'
    )
  for member, bits in talk.wrong:
    yield f'WRONG: {name(member)} has {bits}, which nobody told it'
  for sender, member, time_s in talk.false_confirmations:
    yield (
      f'WRONG: {name(sender)} took {name(member)} for having it at'
      f' {time_s:.2f} s'
    )
  for member in talk.strays:
    yield f'WRONG: {name(member)} left its place without a message'
  for pair in talk.contacts:
    yield f'{" and ".join(pair)} touched'
  yield (
    f'Conversation {"passed" if talk.passed else "FAILED"}:'
    f' {len(talk.delivered)} of {len(talk.told)} told, in {talk.duration_s:.1f}'
    f' s, {talk.dances_s:.1f} s of dances.'
  )
