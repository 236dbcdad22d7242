"""Languages by name, or as JSON files: what `plain.to_plain` makes of one."""

import json
import pathlib

from waggle_tasks import errors, plain, scenario
from waggle_tasks.experiments.machine import files
from waggle_tasks.protocol import agreement, checks, languages

SUFFIX = '.json'
NAMES = (scenario.PAPER, *languages.LANGUAGES)


def is_file(text: str) -> bool:
  """Whether a text names a file, and not one of `NAMES`."""
  return text.lower().endswith(SUFFIX)


def find(text: str) -> languages.Language:
  """The language of a name or of a file.

  Raises:
    LanguageError: if there is no such name, or the file is no language.
  """
  if is_file(text):
    return read(pathlib.Path(text))
  checks.choice('language', text, NAMES, languages.LanguageError)
  if text == scenario.PAPER:
    return agreement.Agreement().spoken
  return languages.LANGUAGES[text]


def read(path: pathlib.Path) -> languages.Language:
  """The language of a file.

  Raises:
    LanguageError: naming the file and what is wrong with it.
  """
  files.check_text(str(path), languages.LanguageError)
  try:
    # Editors on Windows begin such a file with a mark, which is no JSON.
    data = json.loads(path.read_text(encoding='utf-8-sig'))
  except (OSError, ValueError, RecursionError) as error:
    raise languages.LanguageError(
      f'`language` must be one of {[*NAMES]}, or a readable JSON file: {path}:'
      f' {error}'
    ) from None
  try:
    return plain.from_plain(languages.Language, data)
  except errors.WaggleError as error:
    raise languages.LanguageError(f'`language` {path}: {error}') from None
