"""HTML and SVG as text; whatever is not markup yet is escaped."""

from collections.abc import Iterable
import html
from typing import TypeAlias

Content: TypeAlias = 'Markup | str | float | None'

# Elements that never have content (HTML standard, section 'Void elements').
_VOID = {'meta', 'img', 'br', 'hr', 'input', 'link', 'source'}


class Markup(str):
  """Text that is markup, and so is not escaped again."""

  __slots__ = ()


def tag(name: str, /, *content: Content, **attributes: Content) -> Markup:
  """An element.

  Args:
    name: Of the element.
    *content: What is in it, one after the other; None is nothing.
    **attributes: Its attributes; an underscore stands for a hyphen and one at
      the end for nothing (`class_`). None and False leave an attribute out,
      True writes its name alone.
  """
  head = name
  for key, value in attributes.items():
    if value is None or value is False:
      continue
    key = key.rstrip('_').replace('_', '-')
    head += f' {key}' if value is True else f' {key}="{escape(value)}"'
  if name in _VOID:
    return Markup(f'<{head}>')
  return Markup(f'<{head}>{join(content)}</{name}>')


def join(content: Iterable[Content], between: str = '') -> Markup:
  """Contents one after the other."""
  return Markup(between.join(escape(each) for each in content))


def escape(value: Content) -> Markup:
  """Text as markup; numbers lose needless digits."""
  if value is None:
    return Markup('')
  if isinstance(value, Markup):
    return value
  if isinstance(value, float):
    value = f'{value:.2f}'.rstrip('0').rstrip('.')
    value = '0' if value == '-0' else value
  return Markup(html.escape(str(value)))


def table(
  header: Iterable[Content],
  rows: Iterable[Iterable[Content]],
  caption: str | None = None,
) -> Markup:
  """A table; its first column is text, the others are numbers."""
  head = tag('tr', *(tag('th', each, scope='col') for each in header))
  body = []
  for row in rows:
    first, *others = row
    cells = [tag('th', first, scope='row'), *(tag('td', o) for o in others)]
    body.append(tag('tr', *cells))
  return tag(
    'div',
    tag(
      'table',
      tag('caption', caption) if caption else None,
      tag('thead', head),
      tag('tbody', *body),
    ),
    class_='scroll',
  )
