"""The `waggle` command: its listing, its help, its errors."""

import ast
from collections.abc import Callable
import pathlib
import subprocess
import sys

import pytest

import waggle_tasks
from waggle_tasks.experiments import main

Waggle = Callable[..., subprocess.CompletedProcess[str]]
FOLDER = pathlib.Path(main.__file__).parent


@pytest.mark.parametrize('arguments', [[], ['--help'], ['-h']])
def test_alone_it_lists_each_command_with_one_line(
  arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
  assert main.main(['waggle', *arguments]) == 0
  lines = capsys.readouterr().out.splitlines()
  for name, text in main.COMMANDS.items():
    (line,) = [line for line in lines if line.startswith(f'  {name} ')]
    assert line.endswith(text)
    assert len(line) <= 80


@pytest.mark.parametrize('name', main.COMMANDS)
def test_every_command_is_a_launcher_with_a_docstring_and_main(
  name: str,
) -> None:
  tree = ast.parse((FOLDER / f'{name}.py').read_text(encoding='utf-8'))
  functions = [n.name for n in tree.body if isinstance(n, ast.FunctionDef)]
  assert ast.get_docstring(tree)
  assert 'main' in functions


def test_version_is_the_package_version(
  capsys: pytest.CaptureFixture[str],
) -> None:
  assert main.main(['waggle', '--version']) == 0
  assert capsys.readouterr().out == f'waggle {waggle_tasks.__version__}\n'


@pytest.mark.parametrize(
  ('name', 'hint'),
  [
    ('doctr', ' Did you mean doctor?'),
    ('brodcast', ' Did you mean broadcast?'),
    ('zzz', ''),
    ('--output=x', ''),
  ],
)
def test_an_unknown_command_lists_close_ones_and_exits_2(
  name: str, hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
  assert main.main(['waggle', name]) == 2
  captured = capsys.readouterr()
  assert captured.out == ''
  assert captured.err == (
    f'waggle: unknown command {name!r}, must be one of '
    f'{sorted(main.COMMANDS)}.{hint}\n'
  )


@pytest.mark.parametrize('option', ['--help', '-h'])
def test_help_of_a_command_shows_its_own_flags_and_no_others(
  waggle: Waggle, option: str
) -> None:
  child = waggle('doctor', option)
  assert child.returncode == 0
  assert child.stderr == ''
  assert child.stdout.startswith('usage: waggle doctor [--flag=value ...]\n')
  flags = [w for w in child.stdout.split() if w.startswith('--')]
  assert flags == ['--output=.', '--timeout_s=60.0']
  assert max(map(len, child.stdout.splitlines())) <= 80


@pytest.mark.slow
@pytest.mark.parametrize(
  ('argument', 'line'),
  [
    ('--outptu=x', 'unknown flag --outptu. Did you mean --output? '),
    ('--zzz', 'unknown flag --zzz. --help lists'),
    ('--timeout_s=soon', 'flag --timeout_s=soon: could not convert string'),
    ('--timeout_s=-1', 'flag --timeout_s=-1.0: must be positive, finite'),
    ('--timeout_s=nan', 'flag --timeout_s=nan: must be positive, finite'),
    ('--timeout_s=inf', 'flag --timeout_s=inf: must be positive, finite'),
    ('--timeout_s', 'Missing value for flag --timeout_s'),
    ('now', "takes only flags, --name=value: got 'now'."),
  ],
)
def test_a_bad_flag_is_one_line_and_exit_status_2(
  waggle: Waggle, argument: str, line: str
) -> None:
  child = waggle('doctor', argument)
  assert child.returncode == 2
  assert child.stdout == ''
  (said,) = child.stderr.splitlines()
  assert said.startswith(f'waggle doctor: {line}')


def test_a_launcher_runs_as_a_module_too(waggle: Waggle) -> None:
  module = 'waggle_tasks.experiments.doctor'
  child = subprocess.run(
    [sys.executable, '-m', module, '--help'],
    capture_output=True,
    text=True,
    check=True,
  )
  assert child.stdout == waggle('doctor', '--help').stdout


def test_the_package_runs_as_a_module_like_the_command(waggle: Waggle) -> None:
  child = subprocess.run(
    [sys.executable, '-m', 'waggle_tasks', '--version'],
    capture_output=True,
    text=True,
    check=True,
  )
  assert child.stdout == waggle('--version').stdout
