"""Languages by name, as they are or with their code changed in place."""

import dataclasses
from typing import Any

from waggle_tasks import doors
from waggle_tasks.protocol import checks, coding, languages

FORM = 'NAME or NAME:check=...,parity=...'


def find(name: str) -> languages.Language:
  """A language of `languages.LANGUAGES`, or one that a package offers.

  Args:
    name: As it is ('swift'), or with its code changed ('swift:parity=0' or
      'swift:check=crc4,parity=1').

  Raises:
    WaggleError: naming what is not known, or does not fit its alphabet.
    DoorError: if a package offers the name and it cannot be used.
  """
  stem, colon, changes = name.partition(':')
  offered = _offered(stem)
  language = offered or languages.LANGUAGES[stem]
  if not colon:
    return language
  code = dataclasses.replace(language.coding, **_changes(name, changes))
  code.count(1, language.alphabet.size)  # Refuses a code that does not fit.
  return dataclasses.replace(language, coding=code)


def _offered(name: str) -> languages.Language | None:
  """A language from outside; None for one of this project."""
  known = languages.LANGUAGES
  found = doors.find('languages', name, known)
  if isinstance(found, languages.Language):
    return found
  if found is not None:
    raise languages.LanguageError(
      f'`language` {name!r} must be a languages.Language: its package offers'
      f' {found!r}'
    )
  choices = [*known, *doors.names('languages')]
  checks.choice('language', name, choices, languages.LanguageError)
  return None


def _changes(name: str, text: str) -> dict[str, Any]:
  """The fields of a code that a text changes, as they are declared."""
  kinds = {each.name: each.type for each in dataclasses.fields(coding.Coding)}
  out: dict[str, Any] = {}
  for part in text.split(','):
    field, equals, value = part.partition('=')
    if not equals or not value or field in out:
      raise languages.LanguageError(
        f'`language` must be {FORM}, with each part once: got {name!r}'
      )
    checks.choice('language', field, [*kinds], languages.LanguageError)
    out[field] = value
    if kinds[field] is int:
      if not value.isdecimal():
        raise languages.LanguageError(
          f'`{field}` of `language` must be a whole number: got {name!r}'
        )
      out[field] = int(value)
  return out
