"""Parts of the reference that are asked of the program itself.

It also warns of commands in the documents that have no such flag.
"""

from concurrent import futures
import functools
import os
import re
import subprocess
import sys

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import docutils, logging

from waggle_tasks.experiments import main
from waggle_tasks.experiments.record import scenario_fields

_LOGGER = logging.getLogger(__name__)
_UNITS = {
  'm': 'm', 's': 's', 'deg': 'degrees', 'px': 'pixels', 'hz': 'Hz',
  'mps': 'm/s', 'share': 'share of 1',
}  # fmt: skip
_CALL = re.compile(r'\bwaggle (\w+)((?:[^\n#|&]|\\\n)*)')
_USED = re.compile(r'(?<!\S)--(\w+)')
_KNOWN = re.compile(r'^  --(\[no\])?(\w+)', re.MULTILINE)


class Commands(docutils.SphinxDirective):
  """Each command of `waggle` with what its --help prints."""

  def run(self) -> list[nodes.Node]:
    """Makes a section of each command."""
    out: list[nodes.Node] = []
    for name, text in _helps().items():
      section = nodes.section(ids=[nodes.make_id(f'waggle-{name}')])
      section += nodes.title(text=f'waggle {name}')
      section += nodes.literal_block(text, text, language='text')
      out.append(section)
    return out


@functools.cache
def _helps() -> dict[str, str]:
  """What each command prints of itself."""
  with futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    texts = [*pool.map(_help, main.COMMANDS)]
  return dict(zip(main.COMMANDS, texts, strict=True))


def _help(command: str) -> str:
  child = subprocess.run(
    [sys.executable, '-m', 'waggle_tasks', command, '--help'],
    capture_output=True, text=True, check=True,
  )  # fmt: skip
  return child.stdout.rstrip()


class ScenarioFields(docutils.SphinxDirective):
  """Every value of a scenario: its flag, default and unit, and what it is."""

  def run(self) -> list[nodes.Node]:
    """Makes the table."""
    rows = [
      (name, field.part, str(field.default), _unit(name), field.text)
      for name, field in scenario_fields.table().items()
    ]
    head = {
      'name': 20,
      'group': 12,
      'default': 12,
      'unit': 10,
      'what it is': 46,
    }
    return [_table(head, rows)]


def _unit(name: str) -> str:
  """The unit that a name ends in; nothing for a name or a count."""
  return _UNITS.get(name.rpartition('_')[2], '') if '_' in name else ''


def _table(head: dict[str, int], rows: list[tuple[str, ...]]) -> nodes.table:
  """A table; `head` has the share of the width of each column, in percent."""
  group = nodes.tgroup(cols=len(head))
  group += [nodes.colspec(colwidth=width) for width in head.values()]
  group += nodes.thead('', _row(tuple(head)))
  group += nodes.tbody('', *[_row((f'`{row[0]}`', *row[1:])) for row in rows])
  return nodes.table('', group, classes=['colwidths-given'])


def _row(cells: tuple[str, ...]) -> nodes.row:
  """A row of cells in which what stands in backquotes is code."""
  row = nodes.row()
  for cell in cells:
    words = enumerate(cell.split('`'))
    parts = [
      (nodes.literal if number % 2 else nodes.inline)(text=word)
      for number, word in words
    ]
    row += nodes.entry('', nodes.paragraph('', '', *parts))
  return row


def _check_commands(app: Sphinx, page: nodes.document) -> None:
  """Warns of every command of a page that the program does not have."""
  del app
  for block in page.findall(nodes.literal_block):
    if block.get('language') == 'sh':
      for name, rest in _CALL.findall(block.astext()):
        for wrong in _unknown(name, rest):
          _LOGGER.warning('there is no %s', wrong, location=block)


def _unknown(name: str, rest: str) -> list[str]:
  """What a command line says that is not known."""
  if name not in main.COMMANDS:
    return [f'command `waggle {name}`']
  known = {
    f'{negation}{flag}'
    for negated, flag in _KNOWN.findall(_helps()[name])
    for negation in ('', *['no'] * bool(negated))
  }
  used = [flag for flag in _USED.findall(rest) if flag != 'help']
  return [f'--{f} of `waggle {name}`' for f in used if f not in known]


def setup(app: Sphinx) -> dict[str, bool]:
  """Tells Sphinx of the directives and of the check."""
  app.add_directive('waggle-commands', Commands)
  app.add_directive('waggle-scenario-fields', ScenarioFields)
  app.connect('doctree-read', _check_commands)
  return {'parallel_read_safe': True}
