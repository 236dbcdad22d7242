"""`waggle bench`: what it prints, what its checks find, what it leaves."""

from collections.abc import Callable
import functools
import itertools
import json
import os
import pathlib
import subprocess
import time

import numpy as np
import pytest

from waggle_tasks import registry, suites
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.bench_parts import (
  cameras,
  events,
  eye_costs,
  fidelities,
  learners,
  loops,
  pilots,
  processes,
  readers,
  sections,
  stages,
  tables,
)
from waggle_tasks.experiments.machine import cores

Waggle = Callable[..., subprocess.CompletedProcess[str]]
FRAME_S = 0.04


# What the parts of the benchmark could have measured.
MEASURED = {
  'cameras': cameras.Cameras(
    {
      cameras.STOCK: [0.05, 0.06, 0.10],
      cameras.STOCK_PLAIN: [0.005, 0.006, 0.010],
      cameras.FULL: [0.010, 0.012, 0.020],
      cameras.INCREMENTAL: [0.0005, 0.0006, 0.0005],
    },
    {cameras.MOVES: [0.001], cameras.RESTS: [0.0001]},
    {cameras.MOVES: 0.6, cameras.RESTS: 0.4},
    {
      cameras.STOCK: 36, cameras.STOCK_PLAIN: 36, cameras.FULL: 36,
      cameras.INCREMENTAL: 7560,
    },
  ),
  'eyes': eye_costs.Looking(
    {'ideal': [0.002], 'fpv': [0.010]}, {'ideal': [0.002], 'fpv': [0.0025]}
  ),
  'stages': [{'physics': 1e-4, 'rendering': 3e-4, stages.OTHER: 1e-4}],
  'receivers': [
    {'klt': [0.0003, 0.0004, 0.0005], 'view_bank': [0.0001, 0.0001, 0.0004]},
    {'klt': [0.0004, 0.0004, 0.0004], 'view_bank': [0.0001, 0.0002, 0.0003]},
  ],
  'realtime': [
    loops.Loop(3, 2500, 9.0, 10.0, 9.5), loops.Loop(3, 2500, 7.0, 8.0, 7.5),
    loops.Loop(3, 2500, 19.0, 20.0, 9.5),
  ],
  'languages': [
    loops.Loop(3, 2500 // (k + 1), 9.0, 10.0, 9.5)
    for _ in range(2)
    for k in range(len(sections.LANGUAGES))
  ],
  'dynamics': pilots.Flying(
    {
      'ideal': [loops.Loop(3, 2500, 9.0, 10.0, 9.5)],
      'rotors': [loops.Loop(3, 2500, 11.0, 12.5, 12.0)],
    },
    {'ideal': [0.0002], 'rotors': [0.0005]},
  ),
  'fidelities': fidelities.Levels(
    {'calm': {'pixels': [3.0, 4.0], 'tracks': [0.1, 0.1]}}, [(600.0, 0.1)]
  ),
  'learners': learners.Learning({'no pictures': [0.001], 'pictures': [0.003]}),
  'observers': [
    loops.Loop(count, 100, count * cost_s, 1.0, 1.0)
    for cost_s in (0.1, 0.2)
    for count in sections.OBSERVERS
  ],
  'memory': sections.Memory(310.0, [250.0, 260.0, 261.0]),
  'workers': {1: [10.0, 12.0, 11.0], 2: [19.0, 24.0, 22.0]},
}  # fmt: skip


def test_ratios_are_medians_of_what_was_measured_side_by_side() -> None:
  assert tables.ratios(MEASURED) == pytest.approx(
    {
      'stock camera / incremental camera': 100.0,
      'stock, no shadows or multisampling / incremental camera': 10.0,
      'our full render / incremental camera': 20.0,
      'picture of fpv / of an ideal camera of its size': 4.0,
      'klt receiver / view_bank': 2.0,
      'simulated time / time on one core': 10.0,
      **{
        f'speed of a broadcast, {name} / paper': pytest.approx(
          1 / (k + 2), abs=1e-3
        )
        for k, name in enumerate(sections.LANGUAGES[1:])
      },
      'simulated time / time on one core, rotors': 8.0,
      'share of a broadcast that rotors add': 0.06,
      'tracks / pixels, calm': 35.0,
      'life of a swarm of 1000 / time': 6000.0,
      'steps of a learner, no pictures / pictures': 3.0,
      'cost of a receiver and frame, 16 observers / 2': 1.0,
      'throughput, 2 processes / 1': 2.0,
    }
  )


def test_a_report_tells_the_ratios_before_anything_else() -> None:
  first, *others = tables.text(MEASURED).split('\n\n')
  assert first.splitlines()[0] == 'ratio'
  assert len(first.splitlines()) == 2 + len(tables.ratios(MEASURED))
  assert len(others) == len(sections.SECTIONS)
  lines = [line for each in others for line in each.splitlines()]
  assert {
    'stock 60.000 36',
    'all rest 0.100 40%',
    'fpv 640x480 10.00 2.50',
    'rendering 300 60%',
    'view_bank 150 200',
    'everything 10.00 10.0',
    'no pictures 1,000',
    'broadcast 3 261',
  } <= {' '.join(line.split()) for line in lines}
  assert max(map(len, lines)) <= 80


def test_a_part_alone_has_a_report_of_its_own() -> None:
  text = tables.text({'memory': MEASURED['memory']})
  assert text.startswith('peak memory of a process')


@pytest.mark.parametrize(
  ('call', 'message'),
  [
    (
      functools.partial(sections.chosen, ['stages', 'camera']),
      r"`only` must be one of \['cameras', .*\]: got 'camera'\. Did you mean",
    ),
    (
      functools.partial(sections.Settings, 'a', repeats=0),
      r'`repeats` must be between 1 and 1000: got 0',
    ),
    (
      functools.partial(sections.Settings, 'a', simulated_s=float('nan')),
      r'`simulated_s` must be a finite number: got nan',
    ),
    (
      functools.partial(sections.Settings, 'a', simulated_s=0.04),
      r'`simulated_s` must be between 0\.08 and 600: got 0\.04',
    ),
  ],
)
def test_a_measurement_that_cannot_be_made_is_refused(
  call: Callable[[], object], message: str
) -> None:
  with pytest.raises(sections.BenchError, match=message):
    call()


def test_parts_are_measured_in_their_own_order() -> None:
  assert sections.chosen(['workers', 'cameras']) == ['cameras', 'workers']
  assert sections.chosen([]) == [*sections.SECTIONS]


def test_learners_are_measured_where_what_they_take_is_installed(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setattr(learners, 'installed', lambda: False)
  assert sections.chosen([]) == [
    name for name in sections.SECTIONS if name != 'learners'
  ]
  with pytest.raises(
    sections.BenchError, match=r"pip install 'waggle-tasks\[rl"
  ):
    sections.chosen(['learners'])


def test_a_length_that_is_asked_for_holds_for_every_broadcast() -> None:
  settings = sections.Settings('a', simulated_s=3.0)
  for scene in (settings.whole, settings.gesture, settings.glimpse):
    assert scene.episode_s == 3.0


def test_unasked_the_main_broadcast_is_whole_and_others_are_shorter() -> None:
  settings = sections.Settings('a')
  assert settings.whole == registry.find('broadcast')
  assert settings.gesture.episode_s == 4.0 + 7.5 + 4.0
  assert settings.glimpse.episode_s < settings.gesture.episode_s
  assert sections.Settings('a', long=True).glimpse == settings.whole


@pytest.mark.parametrize(
  ('name', 'clock'),
  [
    ('llvmpipe (LLVM 15.0.6, 256 bits)', time.process_time),
    ('softpipe', time.process_time),
    ('NVIDIA H200/PCIe/SSE2', time.perf_counter),
    ('', time.perf_counter),
  ],
)
def test_processor_time_counts_only_where_the_processor_draws(
  name: str, clock: processes.Clock
) -> None:
  assert processes.clock(name) is clock


def test_a_process_that_measures_has_one_core_and_one_drawing_thread() -> None:
  core = cores.usable()[0]
  with processes.worker(core) as worker:
    assert worker.submit(os.getenv, 'LP_NUM_THREADS').result() == '0'
    # Where the system does not confine, it is not confined.
    confined = hasattr(os, 'sched_setaffinity')
    ours = [core] if confined else cores.usable()
    assert worker.submit(cores.usable).result() == ours


def test_a_process_that_dies_while_it_is_measured_is_told_in_one_line() -> None:
  with pytest.raises(
    processes.ProcessError, match='a process died while it was measured: see'
  ):
    processes.alone(os._exit, 1)


def test_a_stage_inside_another_is_not_counted_twice() -> None:
  timer = stages.Timer(itertools.count().__next__)  # A second for each look.
  inner = timer.timed(lambda: None, 'inner', '')
  outer = timer.timed(lambda: [inner(), inner()], 'outer', '')
  elsewhere = timer.timed(lambda: None, 'inner', 'outer')
  outer()
  elsewhere()
  assert timer.seconds['inner'] == 2
  assert timer.seconds['outer'] == 3


def test_a_stage_that_raises_has_ended() -> None:
  timer = stages.Timer(itertools.count().__next__)
  with pytest.raises(ZeroDivisionError):
    timer.timed(lambda: 1 / 0, 'failing', '')()
  timer.timed(lambda: None, 'next', '')()
  assert timer.seconds['failing'] == 1


@pytest.mark.slow
def test_timing_a_broadcast_leaves_every_call_as_it_was() -> None:
  def calls() -> list[object]:
    return [vars(each.owner).get(each.name) for each in stages.STAGES]

  before = calls()
  scene = registry.find('broadcast', observers=1, duration_s=5 * FRAME_S)
  (found,) = stages.measure(scene, 1, time.perf_counter)
  assert calls() == before
  assert {*found} == {each.stage for each in stages.STAGES} | {stages.OTHER}
  spent = [found[name] for name in ('physics', 'rendering', 'receiver: grey')]
  assert min(spent) > 0.0


def test_a_loop_counts_steps_and_not_what_is_around_them() -> None:
  scene = registry.find('broadcast', observers=1, duration_s=5 * FRAME_S)
  loop = loops.run(scene, clock=itertools.count(0.0, 0.5).__next__)
  assert (loop.observers, loop.frames) == (1, 5)
  assert loop.simulated_s == pytest.approx(5 * FRAME_S)
  # The clock was looked at once for each time step.
  assert loop.loop_s == 2.5
  assert loop.receiver_frame_s == 0.5
  assert loop.whole_s > 0.0


@pytest.mark.slow
def test_peak_memory_never_falls() -> None:
  scene = registry.find('broadcast', observers=1, duration_s=FRAME_S)
  peaks_mb = loops.peaks_mb(scene, 2)
  assert 50.0 < peaks_mb[0] <= peaks_mb[1] < 10_000.0


@pytest.mark.slow
def test_the_flight_that_cameras_draw_is_danced_read_and_flown(
  short: dict[str, object],
) -> None:
  scene = registry.find('broadcast', observers=1, **short)
  flight = cameras.fly(scene)
  assert {*flight.phases} == {*cameras.PHASES}
  assert flight.phases[:3] == (cameras.RESTS,) * 3
  observer_m = flight.qpos[:, 7:10]
  np.testing.assert_allclose(
    observer_m[-1] - observer_m[0], [0.0, 0.4, 0.0], atol=0.015
  )


@pytest.mark.slow
def test_every_camera_draws_the_flight() -> None:
  scene = registry.find('broadcast', observers=2, duration_s=4 * FRAME_S)
  found = cameras.measure(scene, 1, itertools.count().__next__)
  # Its clock ticks once for the images of one frame, which are two.
  assert {*found.mean_s} == {
    cameras.STOCK, cameras.STOCK_PLAIN, cameras.FULL, cameras.INCREMENTAL,
  }  # fmt: skip
  assert [*found.mean_s.values()] == [[0.5]] * 4
  assert found.images[cameras.INCREMENTAL] == 2 * 5
  assert sum(found.share.values()) == pytest.approx(1.0)


@pytest.mark.parametrize(
  ('one', 'other', 'pair'),
  [
    ([], [], None),
    (['a', 'b'], ['a', 'b'], None),
    (['a', 'b'], ['a', 'c'], ('b', 'c')),
    (['a'], ['a', 'b'], ('', 'b')),
    (['a', 'b'], ['a'], ('b', '')),
  ],
)
def test_event_logs_differ_at_their_first_unequal_line(
  one: list[str], other: list[str], pair: tuple[str, str] | None
) -> None:
  assert events.difference(one, other) == pair


@pytest.mark.slow
def test_either_camera_gives_the_same_events(
  capsys: pytest.CaptureFixture[str],
) -> None:
  scene = registry.find('broadcast', observers=1, duration_s=3.2)
  case = suites.Case('a-null', 'own', '', scene)
  (logs,) = events.compare([case], workers=2)
  assert logs == events.Logs('a-null', 1, None)
  # The bar ends where it should: as many seconds as were to be simulated.
  assert '6/6 s simulated' in capsys.readouterr().err.splitlines()[-1]


def test_unequal_event_logs_are_shown() -> None:
  found = [
    events.Logs('one', 17, None),
    events.Logs('two', 17, ('{"time_s": 3.0}', '')),
  ]
  lines = events.report(found).splitlines()
  assert lines[-3:] == [
    'two, incremental: {"time_s": 3.0}',
    'two, full: nothing',
    '1 of 2 event logs are equal.',
  ]


@pytest.mark.slow
def test_the_command_prints_a_report_and_leaves_json(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'bench.json'
  options = ('--only=realtime', '--repeats=1', '--simulated_s=0.08')
  child = waggle('bench', *options, f'--json={path}')
  assert child.returncode == 0, child.stderr
  title, clock, _, first, *_ = child.stdout.splitlines()
  found = json.loads(path.read_text(encoding='utf-8'))
  assert title.startswith(f'{found["renderer"]}, {found["cores"]} cores, load')
  assert clock.endswith(f'images and loops by {found["clock"]}.')
  assert first == 'ratio'
  (loop,) = found['measured']['realtime']
  assert loop['frames'] == 2
  assert found['ratios'] == {
    'simulated time / time on one core': pytest.approx(0.08 / loop['whole_s'])
  }
  again = waggle('bench', *options, f'--json={path}')
  assert again.returncode == 2
  assert again.stdout == ''
  assert again.stderr == (
    'waggle bench: `json` must be a new file in a folder that exists: got'
    f' {str(path)!r}\n'
  )


def test_every_receiver_is_timed_on_the_same_images() -> None:
  scene = registry.find('broadcast', observers=1, duration_s=0.4)
  (found,) = readers.measure(
    scene, 1, itertools.count().__next__, [*receivers.RECEIVERS]
  )
  assert {*found} == {*receivers.RECEIVERS}
  assert all(seconds == [1] * 11 for seconds in found.values())
