"""A scenario as a flat table of plain values: what flags and grids speak of.

Fields of a scenario that are values of their own are spread out: the fields of
its groups under their own names, its codebook and units as the numbers that
they are made from. A value of one's own, as the hover of a log or a language,
is one text.
"""

from collections.abc import Callable, Iterator, Mapping
import dataclasses
import functools
import inspect
import json
import math
import pathlib
from typing import Any

from waggle_tasks import eyes, kinds, plain, scenario
from waggle_tasks.experiments.record import (
  docs,
  eye_fields,
  hover_file,
  language_file,
)
from waggle_tasks.protocol import checks, gestures, languages
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import hover

Values = Mapping[str, Any]

# Groups that stand last.
_LAST = 'codebook', 'units'
_WORDS = {'true': True, 'false': False}


@dataclasses.dataclass(frozen=True)
class Field:
  """A value of the flat table.

  Attributes:
    owner: What takes it when a scenario is made.
    part: The field of the scenario that it belongs to; empty for its own.
    name: What its owner calls it.
    default: What it is by default.
    text: What the owner's docstring says of it.
    form: What is made of its text, where it may be a value of its own.
  """

  owner: str
  part: str
  name: str
  default: Any
  text: str
  form: Any = None

  def told(self, value: Any) -> Any:  # noqa: ANN401
    """A value of the owner as the table has it."""
    if self.form is not None and not isinstance(value, str):
      return _short(plain.to_plain(value))
    return math.degrees(value) if self.name.endswith('_rad') else value

  def taken(self, value: Any) -> Any:  # noqa: ANN401
    """A value of the table as the owner takes it."""
    if self.form is not None and not self.is_name(value):
      data = _long(self.name, value) if value else None
      return plain.from_plain(self.form | None, data, self.name)
    return math.radians(value) if self.name.endswith('_rad') else value

  def is_name(self, text: str) -> bool:
    """Whether a text is the name of a value, where values have names."""
    return bool(self.default) and not is_own(text)


def is_own(value: object) -> bool:
  """Whether a value of the table is the text of a value of one's own."""
  return isinstance(value, str) and value.startswith('{')


def _short(data: Values | None) -> str:
  """Plain data of a value as one text; nothing for none."""
  return '' if data is None else json.dumps(data, separators=(',', ':'))


def _long(name: str, text: str) -> Values:
  """What `_short` was made of."""
  try:
    return json.loads(text)
  except (TypeError, ValueError) as error:
    raise plain.PlainError(
      f'`{name}` must be a value as JSON: {error}: got {text!r}'
    ) from None


@functools.cache
def table(kind: type = scenario.Scenario) -> Mapping[str, Field]:
  """Every value of a scenario by its flat name.

  Raises:
    ScenarioError: if two values have one name.
  """
  out: dict[str, Field] = {}
  for field in sorted(dataclasses.fields(kind), key=lambda f: f.name in _LAST):
    for name, value in _values(kind, field):
      if name in out:
        raise scenario.ScenarioError(
          f'`{name}` must be the name of one value: {out[name].owner} and'
          f' {value.owner} have it'
        )
      out[name] = value
  return out


def _values(
  kind: type, field: dataclasses.Field
) -> Iterator[tuple[str, Field]]:
  """What a field of a scenario adds to the table."""
  owner: Callable[..., Any] = type(field.default)
  part, names = field.name, None
  if not dataclasses.is_dataclass(field.default):
    owner, part, names = kind, '', [field.name]
  elif owner is gestures.Codebook:
    owner = gestures.v_codebook
  texts, parameters = docs.sentences(owner), inspect.signature(owner).parameters
  for name in names or parameters:
    members = kinds.members(kinds.hints(owner).get(name, Any))
    form = next(filter(dataclasses.is_dataclass, members), None)
    usual, text = parameters[name].default, texts.get(name, '')
    value = Field(owner.__name__, part, name, usual, text, form)
    flat = name.replace('_rad', '_deg')
    if owner is gestures.v_codebook and name == 'duration_s':
      flat = 'gesture_s'  # The scenario has a duration of its own.
    yield flat, dataclasses.replace(value, default=value.told(value.default))


def defaults() -> dict[str, Any]:
  """Every flat name and its default, those of the dataclasses."""
  return {name: field.default for name, field in table().items()}


def make(values: Values) -> scenario.Scenario:
  """The scenario of some values; the others are the defaults.

  Raises:
    WaggleError: see `changed`.
  """
  return changed(scenario.Scenario(), values)


def changed(scene: scenario.Scenario, values: Values) -> scenario.Scenario:
  """A scenario with some of its values changed.

  Args:
    scene: The scenario.
    values: By their flat names.

  Raises:
    WaggleError: if a name is not known, a value breaks a rule of the scenario,
      or is a number of gestures where these are no Vs.
  """
  scene = eye_fields.put(scene, values)
  parts: dict[str, dict[str, Any]] = {}
  for name, value in values.items():
    checks.choice('field', name, [*table()], scenario.ScenarioError)
    field = table()[name]
    parts.setdefault(field.part, {})[field.name] = field.taken(value)
  whole: dict[str, Any] = parts.pop('', {})
  for part, numbers in parts.items():
    now = getattr(scene, part)
    if part == 'codebook':
      sizes = _v_sizes(now)
      if sizes is None:
        first = next(name for name in values if table()[name].part == part)
        raise scenario.ScenarioError(
          f'`{first}` must not be given for gestures that are no Vs'
        )
      whole[part] = gestures.v_codebook(**{**sizes, **numbers})
    else:
      whole[part] = dataclasses.replace(now, **numbers)
  return dataclasses.replace(scene, **whole)


def flat(fields: Values) -> dict[str, Any]:
  """The values of a scenario, of its fields as plain data have them.

  A layout of one's own stands by the name of its class, and a codebook that is
  none of Vs by 'own'.
  """
  names = {(f.part, f.name): (name, f) for name, f in table().items()}
  out: dict[str, Any] = {}
  for part, value in fields.items():
    if part == 'codebook':
      value = _v_sizes(plain.from_plain(gestures.Codebook, value))
    if value is None and part == 'codebook':
      out[part] = 'own'
    elif part == 'layout':
      out[part] = layout_name(value)
    elif ('', part) in names:
      out[part] = names['', part][1].told(value)
    elif isinstance(value, Mapping):
      for inner, number in value.items():
        name, field = names.get((part, inner), (inner, None))
        out[name] = field.told(number) if field else number
    else:
      out[part] = value
  return out


def layout_name(layout: str | Values) -> str:
  """What a layout is called, which plain data may have by its class."""
  if isinstance(layout, str):
    return layout
  return next(iter(layout), 'none').rpartition(':')[2]


@functools.lru_cache
def _v_sizes(codebook: gestures.Codebook) -> dict[str, float] | None:
  """The numbers that make a codebook of Vs; None of another one."""
  start, end = codebook[Symbol.START], codebook[Symbol.END]
  sizes = {
    'half_width_m': max(x for x, _ in end.corners_m),
    'start_height_m': max(z for _, z in start.corners_m),
    'duration_s': start.duration_s,
  }
  try:
    return sizes if gestures.v_codebook(**sizes) == codebook else None
  except gestures.CodebookError:
    return None


def parse(name: str, text: str) -> object:
  """The value that a text gives to a field, of the type of its default.

  A log of hover and a language of one's own may be given by their files.

  Raises:
    ScenarioError: if the name is not known or the text is no such value.
    LogError: if a file is no log of hover.
    LanguageError: if a file is no language.
  """
  known, error = defaults(), scenario.ScenarioError
  checks.choice('field', name, [*known], error)
  field = table()[name]
  if field.form is hover.Spectrum and text and not is_own(text):
    return field.told(hover_file.read(pathlib.Path(text)))
  if field.form is languages.Language and language_file.is_file(text):
    return field.told(language_file.read(pathlib.Path(text)))
  if field.form is not None:
    return field.told(field.taken(text))
  kind = float if known[name] is None else type(known[name])
  try:
    return _WORDS[text.lower()] if kind is bool else kind(text)
  except (KeyError, ValueError):
    raise error(
      f'`{name}` must be of type {kind.__name__}: got {text!r}'
    ) from None


def flags(values: Values) -> list[str]:
  """The flags that make a scenario: those that differ from their default."""
  known = defaults() | {**eye_fields.of(values), 'eye': eyes.IDEAL}
  return [
    f'--{name}={_text(value)}'
    for name, value in values.items()
    if value != known[name]
  ]


def _text(value: object) -> str:
  return str(value).lower() if isinstance(value, bool) else str(value)
