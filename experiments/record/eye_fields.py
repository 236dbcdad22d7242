"""A camera that is named among the flat values of a scenario."""

from collections.abc import Container, Mapping
import dataclasses
from typing import Any

from waggle_tasks import eye_presets, eyes, scenario

Values = Mapping[str, Any]


def of(values: Values) -> dict[str, Any]:
  """The values that the camera named in some sets; none for the paper's."""
  name = values.get('eye', eyes.IDEAL)
  if name not in eye_presets.PRESETS:
    return {}
  preset = eye_presets.PRESETS[name]
  return dataclasses.asdict(preset.eye) | preset.frame


def put(scene: scenario.Scenario, values: Values) -> scenario.Scenario:
  """A scenario with the camera that is named, which other values then change.

  Raises:
    EyeError: if it is not known, or another size, field of view or rate is
      given beside it.
  """
  name = values.get('eye', eyes.IDEAL)
  if name == eyes.IDEAL:
    return scene
  found = eye_presets.fields(name)
  for field, value in found.items():
    if field != 'eye' and values.get(field, value) != value:
      eye_presets.refuse(field, name, value, values[field])
  return dataclasses.replace(scene, **found)


def filled(
  values: Values, usual: Values, given: Container[str] = ()
) -> dict[str, Any]:
  """All values, with those of the camera that is named where none is given.

  Args:
    values: All values of a scenario, by their flat names.
    usual: Those of the default scenario.
    given: Names of those that stay; others stay where they are not usual.
  """
  own = of(values)
  return {
    name: own.get(name, value)
    if name not in given and value == usual[name]
    else value
    for name, value in values.items()
  }
