"""Prints what lets a shell complete `waggle`: its commands, and their flags.

  waggle completion bash > ~/.local/share/bash-completion/completions/waggle
  waggle completion zsh > ~/.zfunc/_waggle    # a folder of your fpath
  waggle completion fish > ~/.config/fish/completions/waggle.fish

Print it again after another version was installed. It takes some seconds, as
every command is asked for its flags.
"""

from collections.abc import Mapping, Sequence
from concurrent import futures
import re
import shlex
import subprocess
import sys

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments import main as commands
from waggle_tasks.experiments.machine import cores
from waggle_tasks.protocol import checks

ARGUMENTS = 'SHELL'
_FLAG = re.compile(r'^  --(\[no\])?(\w+)(=?)', re.MULTILINE)


class ShellError(errors.WaggleError):
  """A shell that nothing is known of."""


def main(argv: Sequence[str]) -> int:
  """Prints the script and returns the exit status."""
  if len(argv) != 2:
    raise flags.Error(f'takes one shell, of {[*_SHELLS]}: got {argv[1:]}.')
  checks.choice('shell', argv[1], [*_SHELLS], ShellError)
  with futures.ThreadPoolExecutor(len(cores.usable())) as pool:
    found = [*pool.map(flags_of, commands.COMMANDS)]
  print(script(argv[1], dict(zip(commands.COMMANDS, found, strict=True))))
  return 0


def script(shell: str, of: Mapping[str, Sequence[str]]) -> str:
  """What a shell, one of `_SHELLS`, reads: the flags of each command."""
  return _SHELLS[shell](of)


def flags_of(command: str) -> list[str]:
  """Every flag of a command, as it is typed; with = where a value follows."""
  child = subprocess.run(
    [sys.executable, '-m', 'waggle_tasks', command, '--help'],
    capture_output=True, text=True, check=True,
  )  # fmt: skip
  out = ['--help']
  for negated, name, equals in _FLAG.findall(child.stdout):
    out += [f'--{name}{equals}', *([f'--no{name}'] if negated else [])]
  return out


def _bash(of: Mapping[str, Sequence[str]]) -> str:
  cases = '\n'.join(
    f"    {name}) flags='{' '.join(each)}' ;;" for name, each in of.items()
  )
  return f"""# bash completion of waggle.
_waggle() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} flags=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{' '.join(of)} --help --version' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "$flags" -- "$word")) ;;
  esac
  case ${{COMPREPLY[0]-}} in
    *=) compopt -o nospace 2>/dev/null ;;
  esac
}}
complete -o default -F _waggle waggle"""


def _zsh(of: Mapping[str, Sequence[str]]) -> str:
  listed = '\n'.join(
    f'    {shlex.quote(f"{name}:{commands.COMMANDS[name]}")}' for name in of
  )
  cases = '\n'.join(
    f'  {name}) flags=({" ".join(each)}) ;;' for name, each in of.items()
  )
  return f"""#compdef waggle
local -a listed flags
if (( CURRENT == 2 )); then
  listed=(
{listed}
  )
  _describe command listed
  return
fi
case $words[2] in
{cases}
esac
if [[ $PREFIX == -* ]]; then
  compadd -S '' -- $flags
else
  _files
fi"""


def _fish(of: Mapping[str, Sequence[str]]) -> str:
  lines = ['# fish completion of waggle.']
  first = 'complete -c waggle -n __fish_use_subcommand'
  for name in of:
    told = shlex.quote(commands.COMMANDS[name])
    lines.append(f'{first} -f -a {name} -d {told}')
  for name, each in of.items():
    seen = f"complete -c waggle -n '__fish_seen_subcommand_from {name}'"
    for flag in each:
      needs = ' -r' if flag.endswith('=') else ''
      lines.append(f'{seen} -l {flag.strip("-=")}{needs}')
  return '\n'.join(lines)


_SHELLS = {'bash': _bash, 'zsh': _zsh, 'fish': _fish}


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
