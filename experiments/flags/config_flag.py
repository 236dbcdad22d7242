"""The flag that names what a run flew, for launchers that go on from it."""

import pathlib

from absl import flags

from waggle_tasks import errors, scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.flags import receiver_flag, scenario_flags
from waggle_tasks.experiments.record import archive

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


def chosen(
  config: flags.FlagHolder[str | None], receiver: flags.FlagHolder[str]
) -> tuple[scenario.Scenario, str]:
  """The scenario and the receiver of the flags, or of a run and the flags.

  Args:
    config: What `define` made.
    receiver: What `receiver_flag.define` made.

  Raises:
    WaggleError: if a file is not there or no config.json of a run, a value
      breaks a rule of the scenario, or the receiver does not read its language.
  """
  if config.value is None:
    scene = scenario_flags.read()
    return scene, receiver_flag.chosen(receiver, [scene])
  found = path(config.value)
  known = archive.read_config(found).receiver
  scene = scenario_flags.read(archive.read_scenario(found))
  name = receiver.value if receiver.present else known
  receivers.make(name, scene.agreement)
  return scene, name
