"""Doors: parts that other packages offer by name, as entry points.

A package that is installed says in its metadata what it offers, in groups such
as 'waggle_tasks.receivers'. Nothing of it is imported before its name is looked
up, and a name of this project is never another's.
"""

from collections.abc import Collection
import functools
from importlib import metadata
import sys

from waggle_tasks import errors

GROUPS = ('receivers', 'languages', 'layouts', 'scenarios')
_PREFIX = 'waggle_tasks.'


class DoorError(errors.WaggleError):
  """Something that a package offers and that cannot be used."""


def names(group: str) -> list[str]:
  """What is offered in a group, by name."""
  return sorted({each.name for each in _offered(_PREFIX + group)})


def find(group: str, name: str, own: Collection[str]) -> object | None:
  """What a package offers by a name; None where nobody does.

  Args:
    group: One of `GROUPS`.
    name: The name.
    own: The names that are this project's.

  Raises:
    DoorError: if two offer the same, one takes a name of this project, or what
      it offers cannot be imported; it names the distribution.
  """
  found = [each for each in _offered(_PREFIX + group) if each.name == name]
  if not found:
    return None
  whose = sorted({_distribution(each) for each in found})
  if name in own:
    raise DoorError(
      f'`{_PREFIX}{group}` of {" and ".join(whose)} must not offer {name!r},'
      ' which is a name of this project'
    )
  if len(found) > 1:
    raise DoorError(
      f'`{_PREFIX}{group}` must offer {name!r} once: {" and ".join(whose)} do,'
      f' as {" and ".join(sorted(each.value for each in found))}'
    )
  try:
    return found[0].load()
  except (Exception, SystemExit) as error:  # It is code of anybody.
    raise DoorError(
      f'`{_PREFIX}{group}` of {whose[0]} must be such that {name!r} can be'
      f' imported from {found[0].value}: {type(error).__name__}: {error}'
    ) from error


def closed(group: str, name: str) -> str:
  """What to say of a name where there is no door; empty if nobody offers it."""
  found = [each for each in _offered(_PREFIX + group) if each.name == name]
  if not found:
    return ''
  return (
    f'; {_distribution(found[0])} offers it, but {group} cannot be added from'
    ' outside'
  )


def _offered(group: str) -> tuple[metadata.EntryPoint, ...]:
  return _listed(group, tuple(sys.path))


@functools.lru_cache(maxsize=32)
def _listed(
  group: str, places: tuple[str, ...]
) -> tuple[metadata.EntryPoint, ...]:
  """The entry points of a group that are found in some places."""
  del places  # Python knows them; another list of them is another answer.
  return tuple(metadata.entry_points(group=group))


def _distribution(point: metadata.EntryPoint) -> str:
  return point.dist.name if point.dist else 'an unknown distribution'
