"""What a conversation came to, as text."""

from collections.abc import Iterable, Iterator, Sequence

from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import talk as talk_lib
from waggle_tasks.experiments.results import intervals

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


def counts(held: Sequence[talk_lib.Talk]) -> str:
  """What several conversations came to, all together."""
  told = sum(len(each.told) for each in held)
  delivered = sum(len(each.delivered) for each in held)
  confirmed = sum(len({c[:2] for c in each.confirmed}) for each in held)
  wrong = sum(len(each.wrong) for each in held)
  false = sum(len(each.false_confirmations) for each in held)
  strays = sum(len(each.strays) for each in held)
  passed = sum(each.passed for each in held)
  low, high = intervals.clopper_pearson(passed, len(held))
  lines = [
    f'conversations passed: {passed}/{len(held)}; 95 % interval'
    f' {100 * low:.2f}% to {100 * high:.2f}% (Clopper-Pearson)',
    f'delivered: {delivered}/{told} ({100 * delivered / told:.2f}%), seen to be'
    f' confirmed {confirmed} times',
    f'wrong messages: {wrong}, false confirmations: {false}, left their places'
    f' without a message: {strays}',
    f'seconds of one: {_mean(e.duration_s for e in held):.1f}; first member'
    f' dances {_mean(e.dances_s[0] for e in held):.1f}, all together'
    f' {_mean(sum(e.dances_s) for e in held):.1f}',
  ]
  hops_s = [hop_s for each in held for hop_s in each.hops_s]
  if held[0].scene.mission == 'relay' and hops_s:
    lines.append(
      f'a hop, from dance to dance: {_mean(hops_s):.2f} s in the mean,'
      f' {max(hops_s):.2f} at most'
    )
  for each in held:
    if not each.passed:
      told_by = '; '.join(_verdict(each))
      lines.append(f'seed {each.scene.seed}: {told_by}')
  return '\n'.join(lines)


def _mean(values: Iterable[float]) -> float:
  every = [*values]
  return sum(every) / len(every)


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
    f' s, {sum(talk.dances_s):.1f} s of dances.'
  )
