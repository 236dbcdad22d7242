"""What both sides know by name, or as a JSON file."""

import json
import pathlib
from typing import Any

from waggle_tasks import errors, plain, scenario
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import archive, encoding
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import checks, language_names, languages, mocom

SUFFIX = '.json'
PRESETS = {
  scenario.PAPER: agreement_lib.Agreement(),
  'mocom': mocom.AGREEMENT,
}
NAMES = (*PRESETS, *languages.LANGUAGES)
RULE = (
  f'one of {", ".join(NAMES)}, or FILE.json: what `waggle agreement` printed,'
  ' config.json of a run, or a language of your own'
)
_KEY = 'agreement'


class AgreementFileError(errors.WaggleError):
  """A name of no agreement, or a file that holds none."""


def find(text: str) -> agreement_lib.Agreement:
  """The agreement of a name or of a file.

  Args:
    text: One of `PRESETS`; a language as `language_names.find` takes it, with
      all else as in the paper; or the path of a JSON file.

  Raises:
    WaggleError: if there is no such name, or the file is no agreement.
  """
  if text.lower().endswith(SUFFIX):
    return read(pathlib.Path(text))
  if text in PRESETS:
    return PRESETS[text]
  stem = text.partition(':')[0]
  if stem not in languages.LANGUAGES:
    checks.choice('agreement', text, [*NAMES, 'FILE.json'], AgreementFileError)
  return _speaking(language_names.find(text))


def _speaking(language: languages.Language) -> agreement_lib.Agreement:
  return scenario.Scenario(language=language).agreement


def read(path: pathlib.Path) -> agreement_lib.Agreement:
  """The agreement of a file.

  Args:
    path: An agreement as `text` writes it, or without its format and the table
      around it; config.json of a run; or a language.

  Raises:
    AgreementFileError: naming the file and what is wrong with it.
    FormatError: if a newer program wrote it.
  """
  files.check_text(str(path), AgreementFileError)
  try:
    # Editors on Windows begin such a file with a mark, which is no JSON.
    data = json.loads(path.read_text(encoding='utf-8-sig'))
  except (OSError, ValueError, RecursionError) as error:
    why = getattr(error, 'strerror', None) or error
    raise AgreementFileError(
      f'`agreement` must be {RULE}: {path}: {why}'
    ) from None
  if not isinstance(data, dict):
    raise AgreementFileError(f'`agreement` {path}: it must hold a JSON object')
  if 'scenario' in data:
    return archive.read_config(path).agreement
  try:
    return _made(encoding.unstamped(data, path))
  except encoding.FormatError:
    raise
  except errors.WaggleError as error:
    raise AgreementFileError(f'`agreement` {path}: {error}') from None


def _made(data: dict[str, Any]) -> agreement_lib.Agreement:
  if 'alphabet' in data:
    return _speaking(plain.from_plain(languages.Language, data))
  table = data.get(_KEY, data)
  if not isinstance(table, dict) or not table:
    raise AgreementFileError(f'`{_KEY}` must be a table of its fields')
  return plain.from_plain(agreement_lib.Agreement, table)


def text(agreed: agreement_lib.Agreement) -> str:
  """The file of an agreement."""
  return encoding.pretty(encoding.stamped({_KEY: plain.to_plain(agreed)}))
