"""The language of a scenario, and what it does not go with."""

from typing import TYPE_CHECKING

from waggle_tasks import doors, errors
from waggle_tasks.protocol import checks, language_names, languages
from waggle_tasks.protocol import payload as payload_lib

if TYPE_CHECKING:
  from waggle_tasks import scenario

PAPER = 'paper'


def find(language: str | languages.Language) -> languages.Language | None:
  """What is spoken; None for the paper's.

  Args:
    language: `Scenario.language`.

  Raises:
    WaggleError: if there is none of that name, or its code does not fit.
  """
  if isinstance(language, languages.Language):
    return language
  if language == PAPER:
    return None
  stem, _, changes = str(language).partition(':')
  choices = [PAPER, *languages.LANGUAGES]
  if stem not in choices:
    choices += doors.names('languages')
  checks.choice('language', stem, choices, errors.ScenarioError)
  if stem == PAPER:
    raise errors.ScenarioError(
      f'`language` {PAPER!r} must stand alone, as it has no code to change:'
      f' got {changes!r} after it'
    )
  return language_names.find(str(language))


def check(scene: 'scenario.Scenario') -> None:
  """Refuses what the language that is spoken does not take.

  Raises:
    WaggleError: naming the field, the rule and the value.
  """
  if find(scene.language) is None:
    for field, usual in (('bits', ''), ('repeat', 1)):
      if getattr(scene, field) != usual:
        raise errors.ScenarioError(
          f'`{field}` must not be given with `language` {PAPER!r}, which says'
          f' one payload once: choose one of {[*languages.LANGUAGES]}'
        )
    return
  if scene.bits:
    payload_lib.Data(scene.bits)
  for field in ('codebook', 'pauses'):
    if getattr(scene, field) != getattr(type(scene), field):
      raise errors.ScenarioError(
        f'`{field}` must not be given with `language`: {scene.language!r} has'
        f' its own; give it with {PAPER!r}, or a `languages.Language` of your'
        ' own'
      )
