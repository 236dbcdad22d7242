"""Shells complete commands and flags by what `waggle completion` prints."""

from collections.abc import Callable
import pathlib
import re
import shutil
import subprocess

import pytest

from waggle_tasks.experiments import completion, main

Waggle = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope='module')
def scripts(
  tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, pathlib.Path]:
  """The script of each shell, with the flags of two commands."""
  folder, out = tmp_path_factory.mktemp('completion'), {}
  flags: dict[str, list[str]] = {name: [] for name in main.COMMANDS}
  flags |= {name: completion.flags_of(name) for name in ('broadcast', 'drift')}
  for shell in ('bash', 'zsh', 'fish'):
    out[shell] = folder / shell
    text = completion.script(shell, flags)
    out[shell].write_text(text, encoding='utf-8')
  return out


@pytest.mark.long
def test_the_command_knows_the_flags_of_all(waggle: Waggle) -> None:
  child = waggle('completion', 'bash')
  assert child.returncode == 0, child.stderr
  for name, flag in (('suite', '--compare'), ('bench', '--only=')):
    assert re.search(rf"{name}\) flags='[^']*{flag}", child.stdout)


@pytest.mark.parametrize(
  ('words', 'wanted'),
  [
    (['bro'], ['broadcast']),
    (['s'], ['sensitivity', 'suite', 'sweep', 'symbols']),
    (
      ['broadcast', '--distance_'],
      ['--distance_bits=', '--distance_m=', '--distance_unit_m='],
    ),
    (['broadcast', '--nogu'], ['--nogusts']),
    (['drift', '--hover_l'], ['--hover_log=']),
    (['drift', '--distance_m'], []),
    (['decode', 'film'], []),
  ],
)
def test_bash_completes(
  words: list[str], wanted: list[str], scripts: dict[str, pathlib.Path]
) -> None:
  program = (
    f'source {scripts["bash"]}; COMP_WORDS=(waggle {" ".join(words)});'
    f' COMP_CWORD={len(words)}; _waggle; printf "%s\\n" "${{COMPREPLY[@]}}"'
  )
  child = subprocess.run(
    ['bash', '-c', program], capture_output=True, text=True, check=True
  )
  assert sorted(child.stdout.split()) == wanted


@pytest.mark.parametrize('shell', ['zsh', 'fish'])
def test_other_shells_know_every_command(
  shell: str, scripts: dict[str, pathlib.Path]
) -> None:
  text = scripts[shell].read_text(encoding='utf-8')
  for name in main.COMMANDS:
    assert re.search(rf'(-a |    .?|from ){name}\b', text), name
  assert 'distance_m' in text
  if program := shutil.which(shell):
    subprocess.run([program, '-n', scripts[shell]], check=True)


@pytest.mark.parametrize(
  ('arguments', 'words'),
  [
    ([], r"takes one shell, of \['bash', 'zsh', 'fish'\]"),
    (['bsh'], '`shell` must be one of .* Did you mean bash'),
  ],
)
def test_another_shell_is_refused(
  arguments: list[str], words: str, waggle: Waggle
) -> None:
  child = waggle('completion', *arguments)
  assert child.returncode == 2
  assert re.search(words, child.stderr)
