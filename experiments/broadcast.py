"""Flies one dance; every observer reads it from its own camera and follows it.

Prints a table with a line for each observer and the verdict on the group, and
leaves a run folder: index.html is its report, to be opened in a browser, made
from the data beside it. At another --fidelity than pixels nobody flies, and
only the table is left. --video films the episode, --raw keeps every image
that a receiver took. Exit status 0 when the group passed, 1 when it did not, 2
on bad input.
"""

from collections.abc import Iterator, Sequence
import contextlib
import pathlib
import sys

from absl import flags

from waggle_tasks import fidelity, scenario
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import (
  config_flag,
  foresight,
  receiver_flag,
  recording_flags,
  scenario_flags,
)
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.pages import document, run_page
from waggle_tasks.experiments.record import (
  episode,
  folders,
  frames,
  provenance,
  source_files,
  told,
  verdicts,
  writer,
)
from waggle_tasks.experiments.studies import job_progress, live

scenario_flags.define()
recording_flags.define()
_RECEIVER = receiver_flag.define()
_CONFIG = config_flag.define(
  'its scenario and its receiver are flown again. Flags that are given beside'
  ' it change what it says.'
)
_OUTPUT = flags.DEFINE_string(
  'output', None, 'Run folder to make; unset, the next runs/broadcast-N.'
)
_LIVE = flags.DEFINE_boolean(
  'live', False, 'Whether to show what each observer has read, as it flies.'
)


def main(argv: Sequence[str]) -> int:
  """Runs the scenario of the flags and returns the exit status."""
  scene, receiver_name = config_flag.chosen(_CONFIG, _RECEIVER)
  foresight.tell([scene], receiver_name)
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import evaluator, low_level, outside

  if scene.fidelity != fidelity.PIXELS:
    low_level.check([scene], receiver_name)
    verdict, _ = low_level.run(scene, receiver_name)
    print(report(scene, verdict))
    return 0 if verdict.passed else 1
  command = provenance.command_line('broadcast', launch.given_flags())
  try:
    foreign = outside.paths(receiver_name, [scene])
  except source_files.UnknownSourceError as error:
    foreign = {}  # One flight stands for itself; it is only not told so well.
    print(f'provenance.json will not be complete: {error}', file=sys.stderr)
  with _folder() as (draft, folder):
    start = provenance.Start.now(command, foreign)
    with recording_flags.recorders(draft, scene) as onlookers:
      rollout = _roll(scene, receiver_name, onlookers)
    verdict = evaluator.evaluate(scene, rollout)
    writer.write_run(
      draft, scene, receiver_name, rollout, verdict,
      start.end(rollout.renderer),
    )  # fmt: skip
  run_page.leave(folder)
  print(report(scene, verdict))
  for name, events in rollout.events.items():
    for line in frames.lines(events, scene.agreement):
      print(f'{name}: {line}')
  print(f'Run folder: {folder}, report: {folder / document.NAME}')
  return 0 if verdict.passed else 1


@contextlib.contextmanager
def _folder() -> Iterator[tuple[pathlib.Path, pathlib.Path]]:
  """A draft of the run folder of the flags, and that folder."""
  if not _OUTPUT.value:
    with folders.next_folder('broadcast') as pair:
      yield pair
    return
  folder = pathlib.Path(_OUTPUT.value)
  with folders.new_folder(folder) as draft:
    yield draft, folder


def _roll(
  scene: scenario.Scenario,
  receiver_name: str,
  onlookers: Sequence[episode.Onlooker],
) -> episode.Rollout:
  """Runs the episode behind a progress bar of simulated seconds."""
  from waggle_tasks.experiments.episodes import rollout as rollout_lib

  frame = job_progress.ticks(scene.agreement.frame_s)
  form = '{desc}: {percentage:3.0f}%|{bar}| {n:.0f}/{total:.0f} s'
  with (
    job_progress.seconds_bar(
      scene.episode_s,
      desc='broadcast',
      bar_format=form + ' simulated [{elapsed} < {remaining}]',
    ) as bar,
    live.onlookers(scene, _LIVE.value) as lines,
  ):

    def watch(step: episode.Step) -> None:
      if not step.timestep.first():
        job_progress.advance(bar, frame)

    return rollout_lib.run(scene, receiver_name, [*onlookers, *lines, watch])


def report(scene: scenario.Scenario, verdict: verdicts.Verdict) -> str:
  """The table of observers and the verdict, for people."""
  rows = [
    (
      each.observer,
      told.short(each.expected or 'nothing'),
      told.short(each.decoded or '-'),
      table.number(each.end_s),
      table.number(each.final_null_s),
      table.number(each.start_s),
      table.number(each.arrival_s),
      table.number(each.error_m, 1, 1e3),
      *_estimated(scene, table.number(each.estimate_error_m, 1, 1e3)),
      table.number(each.hold_s),
      'FAIL' if each.failures else 'pass',
    )
    for each in verdict.outcomes
  ]
  header = (
    'observer', 'sent', 'decoded', 'END s', 'final null s', 'start s',
    'arrival s', 'error mm', *_estimated(scene, 'by estimate'), 'hold s',
    'checks',
  )  # fmt: skip
  lines = [table.render(header, rows), '']
  for each in verdict.outcomes:
    lines += [f'{each.observer}: {failure}' for failure in each.failures]
  expecting = sum(each.expected is not None for each in verdict.outcomes)
  lines.append(
    f'Group {"passed" if verdict.passed else "FAILED"}: {verdict.correct} of'
    f' {expecting} observers decoded {told.message(scene.payload, scene.bits)}.'
    if expecting
    else f'Group {"passed" if verdict.passed else "FAILED"}: nothing was to be'
    ' decoded.'
  )
  return '\n'.join(lines)


def _estimated(scene: scenario.Scenario, cell: str) -> tuple[str, ...]:
  """A cell of the column that only estimates have."""
  return () if scene.estimator == 'none' else (cell,)


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
