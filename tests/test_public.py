"""The names that `waggle_tasks` gives to its users."""

import pathlib
import subprocess
import sys

import pytest

import waggle_tasks
from waggle_tasks import errors, scenario
from waggle_tasks.agents import observer_agent, receivers
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import agreement


def test_public_names_are_those_of_their_modules() -> None:
  assert waggle_tasks.Scenario is scenario.Scenario
  assert waggle_tasks.Agreement is agreement.Agreement
  assert waggle_tasks.Team is observer_agent.Team
  assert waggle_tasks.WaggleError is errors.WaggleError
  assert waggle_tasks.layouts is layouts
  assert waggle_tasks.receivers is receivers


def test_every_public_name_exists_and_is_listed() -> None:
  namespace: dict[str, object] = {}
  exec('from waggle_tasks import *', namespace)
  assert namespace.keys() - {'__builtins__'} == {*waggle_tasks.__all__}
  assert {*waggle_tasks.__all__} <= {*dir(waggle_tasks)}


def test_a_name_that_there_is_not_is_an_attribute_error() -> None:
  with pytest.raises(AttributeError, match="no attribute 'Scenery'"):
    _ = waggle_tasks.Scenery


def test_public_names_reach_no_simulator_and_no_command_line() -> None:
  code = (
    'import sys\ndel sys.argv, sys.orig_argv\nfrom waggle_tasks import *\n'
    "print({'dm_control', 'dm_env', 'mujoco', 'OpenGL'} & {*sys.modules})"
  )
  said = subprocess.check_output([sys.executable, '-c', code], text=True)
  assert said.strip() == 'set()'


def test_the_package_says_that_it_is_typed() -> None:
  assert (pathlib.Path(waggle_tasks.__file__).parent / 'py.typed').exists()
