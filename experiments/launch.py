"""How every launcher runs: its flags, its help, its errors, its exit status.

A launcher is a module with a docstring, absl flags and `main(argv)`. It calls
`sys.exit(launch.run(__name__))` when run with `python -m`, and the `waggle`
command runs it the same way. What needs GL is imported inside `main`, so that
help works, and a machine that cannot render is told so in one line.

Exit status: what `main` returns (None is 0), 2 on bad input, 130 on Ctrl-C,
141 when whoever reads the output went away.
"""

from collections.abc import Sequence
import contextlib
import importlib
import os
import pathlib
import re
import sys
import textwrap
import types

from absl import flags

from waggle_tasks import errors, runtime
from waggle_tasks.experiments.machine import files, gl, health, terminal

BAD_INPUT = 2
INTERRUPTED = 130

_COLUMN = 28  # Where the text about a flag starts.
_WIDTH = 80
_PLAIN = ('', 'a number', 'an integer')  # A default already shows these.

# Flags defined through this module belong to the launcher that asked for them.
flags.disclaim_key_flags()


def define_positive_float(
  name: str, default: float, text: str
) -> flags.FlagHolder[float]:
  """Defines a flag that takes a positive, finite number."""
  holder = flags.DEFINE_float(name, default, f'{text} Positive.')
  flags.register_validator(
    holder, lambda value: 0 < value < float('inf'), 'must be positive, finite'
  )
  return holder


def run(
  name: str, argv: Sequence[str] | None = None, *, check_versions: bool = True
) -> int:
  """Runs a launcher and returns its exit status.

  Args:
    name: Its module; a launcher that runs itself gives its own `__name__`.
    argv: Its name or path, then its arguments; `sys.argv` when None.
    check_versions: Whether to refuse versions that cannot run together.
  """
  terminal.prepare()
  argv = list(sys.argv if argv is None else argv)
  return terminal.told(lambda: _run(name, argv, check_versions))


def _run(name: str, argv: list[str], check_versions: bool) -> int:
  program = f'waggle {pathlib.PurePath(argv[0]).stem}'
  try:
    for argument in argv[1:]:
      files.check_text(argument, flags.Error)
    if check_versions:
      runtime.require_versions()
      health.require()
    _see_working_folder()
    module = importlib.import_module(name)
    if {'--help', '-h'} & set(argv[1:]):
      print(help_text(program, module))
      return 0
    return module.main(_parse(argv, module)) or 0
  except (errors.WaggleError, flags.Error, runtime.VersionError) as error:
    line, status = str(error), BAD_INPUT
  except KeyboardInterrupt:
    line, status = 'interrupted', INTERRUPTED
  except BrokenPipeError:  # Whoever reads what is printed has seen enough.
    raise
  except Exception as error:
    said = files.problem(error)
    if said is None and gl.may_cause(error):
      said = gl.problem()
    if said is None:
      raise
    line, status = said, BAD_INPUT
    # Contexts that were never made complain again when they are dropped.
    sys.unraisablehook = lambda unraisable: None
  with contextlib.suppress(OSError):  # The terminal may be gone.
    print(f'{program}: {line}', file=sys.stderr)
  return status


def _see_working_folder() -> None:
  """Lets a receiver of one's own be imported from the working folder.

  Last of all places, so that no file there hides a module; `python -m` looks
  there anyhow.
  """
  with contextlib.suppress(OSError):  # It may be gone.
    here = os.getcwd()
    if not sys.flags.safe_path and not {here, ''} & {*sys.path}:
      sys.path.append(here)


def given_flags() -> list[str]:
  """Returns the flags that the user gave, as they would be written again."""
  out = []
  for name in sorted(flags.FLAGS):
    flag = flags.FLAGS[name]
    if not flag.present:
      continue
    line = flag.serialize()
    # One that is given again and again keeps its order.
    again = isinstance(flag, flags.MultiFlag)
    out += line.split('\n') if again else [line]
  return out


def help_text(program: str, module: types.ModuleType) -> str:
  """Returns a launcher's help: what it does, and its own flags only."""
  usage = f'usage: {program} [--flag=value ...] {_takes(module)}'.rstrip()
  lines = [usage, '', (module.__doc__ or '').strip()]
  lines += ['', 'flags:']
  for flag in flags.FLAGS.get_key_flags_for_module(module):
    lines += _flag_lines(flag)
  return '\n'.join(lines)


def _flag_lines(flag: flags.Flag) -> list[str]:
  if flag.boolean:
    head = f'--[no]{flag.name}'
    text = f'{flag.help} (default: {str(flag.default).lower()})'
  else:
    default = (
      '' if flag.default is None else (flag.default_as_str or '').strip("'")
    )
    head = f'--{flag.name}={default}'
    rule = flag.parser.syntactic_help
    text = f'{flag.help} ({rule})' if rule not in _PLAIN else flag.help
  indent = ' ' * _COLUMN
  body = textwrap.wrap(
    text, _WIDTH, initial_indent=indent, subsequent_indent=indent
  )
  if len(head) > _COLUMN - 4:
    return [f'  {head}', *body]
  return [f'  {head}'.ljust(_COLUMN) + body[0].lstrip(), *body[1:]]


def _parse(argv: Sequence[str], module: types.ModuleType) -> list[str]:
  try:
    rest = flags.FLAGS(argv)
  except flags.UnrecognizedFlagError as error:
    own = flags.FLAGS.get_key_flags_for_module(module)
    wrong = f'--{error.flagname}'
    hint = errors.did_you_mean(wrong, [f'--{flag.name}' for flag in own])
    raise flags.Error(
      f'unknown flag {wrong}.{hint} --help lists the flags.'
    ) from None
  except flags.IllegalFlagValueError as error:
    raise flags.Error(_with_rule(str(error))) from None
  if len(rest) > 1 and not _takes(module):
    raise flags.Error(f'takes only flags, --name=value: got {rest[1]!r}.')
  return rest


def _takes(module: types.ModuleType) -> str:
  """What a launcher takes beside flags, its ARGUMENTS; mostly nothing."""
  return getattr(module, 'ARGUMENTS', '')


def _with_rule(line: str) -> str:
  """Adds what the flag takes to an error that tells only what Python said."""
  name = re.sub(r'flag --(\w+).*', r'\1', line, flags=re.DOTALL)
  rule = flags.FLAGS[name].parser.syntactic_help
  return line if rule in line else f'{line}; it takes {rule}'
