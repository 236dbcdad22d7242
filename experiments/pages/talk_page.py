"""The page of a conversation: who dances to whom, and who has what when."""

import pathlib

from waggle_tasks.experiments.pages import document, markup, plot, timelines
from waggle_tasks.experiments.record import talk as talk_lib
from waggle_tasks.experiments.results import palette, talk_tables

tag = markup.tag
_ROW = 24
# What marks stand for, by the kind of an entry: a sign and a colour.
_MARKS = {
  'has': ('\u25cf', palette.GREEN),
  'confirmed': ('\u2713', palette.GREEN),
  'fails': ('\u2717', palette.VERMILLION),
  'refused': ('\u2717', palette.VERMILLION),
  'gives up': ('\u2717', palette.BLACK),
  'done': ('\u25a0', palette.BLACK),
}
_DANCES = {'letter': palette.ORANGE, 'reply': palette.SKY}


def save(folder: pathlib.Path, talk: talk_lib.Talk) -> pathlib.Path:
  """Writes the page into a folder and returns its path."""
  return document.save(folder, draw(talk))


def draw(talk: talk_lib.Talk) -> markup.Markup:
  """The page of a conversation."""
  mission = talk.scene.mission
  body = [
    tag('h1', f'Conversation: {mission}'),
    document.chip(talk.passed, 'passed' if talk.passed else 'failed'),
    tag('h2', 'Who dances, and who has what'),
    tag(
      'p',
      'Orange: a letter; blue: a reply; yellow: a flight. A dot: all of a'
      ' message was read; a tick: a confirmation was seen; a cross: a frame'
      ' failed or was refused.',
    ),
    timeline(talk),
    tag('h2', 'What was told'),
    tag('pre', talk_tables.report(talk)),
    tag('h2', 'Diaries'),
    markup.table(
      ('member', 's', 'what', 'about', 'note', 'bits'),
      (
        (
          talk_tables.name(member),
          entry.time_s,
          entry.what,
          '' if entry.member is None else talk_tables.name(entry.member),
          entry.note,
          entry.bits,
        )
        for member, diary in enumerate(talk.diaries)
        for entry in diary
      ),
    ),
  ]
  return document.page(f'Conversation: {mission}', body)


def timeline(talk: talk_lib.Talk) -> markup.Markup:
  """A row for each member, as SVG."""
  across = plot.time_scale(max(talk.duration_s, 1.0))
  out, top = [], 4.0
  for member, diary in enumerate(talk.diaries):
    label = plot.text(plot.LEFT - 8, top + 11, f'member_{member}')
    out.append(tag('g', label, class_='tick end'))
    bars, marks = [], []
    for entry in diary:
      x = float(across(entry.time_s))
      hint = f'{entry.time_s:.2f} s: {entry.what} {entry.note}'
      if entry.what == 'says':
        kind, length_s = _dance(talk, member, entry.bits)
        end = float(across(entry.time_s + length_s))
        bars.append(timelines.block(x, end, entry.note, _DANCES[kind], hint))
      elif entry.what in _MARKS:
        sign, colour = _MARKS[entry.what]
        title = tag('title', hint)
        marks.append(plot.text(x, 22, title, sign, fill=colour, class_='in'))
    flew_s = talk.flew_s[member]
    if flew_s is not None:
      begin, end = float(across(flew_s)), float(across(talk.duration_s))
      bars.append(
        timelines.block(begin, end, 'fly', palette.YELLOW, f'{flew_s:.2f} s')
      )
    out.append(tag('g', *bars, *marks, transform=f'translate(0 {top:g})'))
    top += _ROW + 6
  grid = plot.time_axis(across, 0, top)
  return plot.timed(
    top + 32, talk.duration_s, grid, *out, label='Who dances, and who has what'
  )


def _dance(talk: talk_lib.Talk, member: int, bits: str) -> tuple[str, float]:
  """Whether something that was said is a letter, and how long it takes."""
  accord = talk.scene.accord
  answers = talk.scene.mission != 'relay' and member in {
    each.recipient for each in talk.told
  }
  if answers and len(bits) == accord.replies.num_bits:
    return 'reply', accord.reply_s
  return 'letter', accord.letter_s
