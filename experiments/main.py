"""The `waggle` command: picks a launcher and runs it.

Only the chosen launcher is imported: absl flags are global, and two launchers
may use the same names.
"""

from collections.abc import Sequence
import sys

import waggle_tasks
from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import terminal

# Name of a module in this folder -> what it does, in one line.
COMMANDS = {
  'broadcast': 'Fly one dance and let every observer read and follow it.',
  'view': "Show a dance in MuJoCo's viewer, where there is a display.",
  'agreement': 'Print what both sides know, as a file to read recordings by.',
  'converse': 'Hold a conversation: confirm, pass on, or speak in turns.',
  'decode': "Read a run's raw captures again, or any recording of a dance.",
  'report': 'Make the page of a run, suite, sweep or link again from its data.',
  'gallery': 'Make the pictures of the documentation.',
  'suite': "Run the paper's evaluation, or your own, beside its results.",
  'bench': 'Measure images, the loop and whole broadcasts on this machine.',
  'sweep': 'Fly a grid of scenarios and map where messages are read.',
  'crossings': 'Fly random crossings of vehicles that avoid each other.',
  'board': 'Rank receivers over tiers of scenes, and merge such boards.',
  'link': 'Compare languages, codes and repetition by what they deliver.',
  'ladder': 'Measure levels of fidelity on pictures and show how they agree.',
  'colony': 'Let swarms choose a site by dancing, beside published models.',
  'drift': 'Show how vehicles hover, beside what was measured.',
  'languages': 'Show how long, how quick and how far apart languages are.',
  'learn': 'Let pairs learn a language of their own, and draw how.',
  'symbols': "Fly MoCom's timelines and show which symbols are read.",
  'sensitivity': 'Move each open choice both ways and show what changes.',
  'ablate': 'Take parts out of the receivers and show what they are good for.',
  'boundary': 'Show that receivers use their own images and nothing else.',
  'bench_video': 'Time a run with and without its video and report.',
  'claims': 'Fly a part of every table again and compare with the documents.',
  'completion': 'Print what lets a shell complete commands and flags.',
  'doctor': 'Check that this machine can run the tasks, and say what to mend.',
}


def main(argv: Sequence[str] | None = None) -> int:
  """Runs one `waggle` command line and returns its exit status.

  Args:
    argv: The program and its arguments; `sys.argv` when None.
  """
  arguments = list(sys.argv if argv is None else argv)[1:]
  terminal.prepare()
  return terminal.told(lambda: _run(arguments))


def _run(arguments: list[str]) -> int:
  name = arguments[0] if arguments else '--help'
  if name in ('--help', '-h'):
    print(listing())
    return 0
  if name == '--version':
    print(f'waggle {waggle_tasks.__version__}')
    return 0
  if name not in COMMANDS:
    hint = errors.did_you_mean(name, list(COMMANDS))
    print(
      f'waggle: unknown command {name!r}, must be one of '
      f'{sorted(COMMANDS)}.{hint}',
      file=sys.stderr,
    )
    return launch.BAD_INPUT
  return launch.run(
    f'waggle_tasks.experiments.{name}',
    arguments,
    check_versions=name != 'doctor',  # Its report must show what fails here.
  )


def listing() -> str:
  """Returns the list of commands, one line each."""
  width = max(map(len, COMMANDS)) + 2
  lines = [f'  {name:{width}}{line}' for name, line in COMMANDS.items()]
  return '\n'.join(
    [
      'usage: waggle COMMAND [--flag=value ...]',
      '',
      *lines,
      '',
      '`waggle COMMAND --help` shows the flags of a command.',
    ]
  )


if __name__ == '__main__':
  sys.exit(main())
