"""Errors that a user can mend."""

from collections.abc import Sequence
import difflib


class WaggleError(ValueError):
  """A value a user chose breaks a rule.

  The message names the field, the rule, the value and the valid choices, so a
  launcher prints it as it is.
  """


class ScenarioError(WaggleError):
  """A field of a scenario that breaks a rule."""


def did_you_mean(word: str, choices: Sequence[str]) -> str:
  """A question that lists the choices close to a word, or nothing."""
  close = difflib.get_close_matches(word, choices)
  return f' Did you mean {" or ".join(close)}?' if close else ''
