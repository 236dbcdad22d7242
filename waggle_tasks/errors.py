"""Errors that a user can mend."""


class WaggleError(ValueError):
  """A value a user chose breaks a rule.

  The message names the field, the rule, the value and the valid choices, so a
  launcher prints it as it is.
  """
