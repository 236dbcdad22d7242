"""The flag that names what a run flew, for launchers that go on from it."""

import pathlib

from absl import flags

from waggle_tasks import errors

# The flag defined here belongs to the launcher that asks for it.
flags.disclaim_key_flags()


class ConfigError(errors.WaggleError):
  """A file that is not there."""


def define(what: str) -> flags.FlagHolder[str | None]:
  """Defines the flag for the launcher that calls this.

  Args:
    what: What the launcher takes of it, in its help.
  """
  return flags.DEFINE_string('config', None, f'config.json of a run: {what}')


def path(value: str) -> pathlib.Path:
  """The file that the flag names.

  Raises:
    ConfigError: if there is none.
  """
  found = pathlib.Path(value)
  if not found.is_file():
    raise ConfigError(
      f'`config` must be the config.json of a run: {value} is no file'
    )
  return found
