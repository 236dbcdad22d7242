"""The page of a run names the limits of the receiver that made it."""

import dataclasses
import html
import pathlib
import re

import chromium
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import description, receivers
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.pages import (
  document,
  gesture_plots,
  run_page,
  signals,
)
from waggle_tasks.experiments.record import (
  provenance,
  story,
  traces,
  verdicts,
  writer,
)

NAMES = (
  'view_bank',
  'absolute:final_null=off',
  'klt_bank:forward_backward=off',
)


@dataclasses.dataclass(frozen=True, eq=False)
class Run:
  """A run folder of one receiver, and the words of its page."""

  folder: pathlib.Path
  rollout: rollout_lib.Rollout
  verdict: verdicts.Verdict
  words: str


@pytest.fixture(scope='module')
def runs(
  short: dict[str, object], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Run]:
  """The same dance, read by each receiver; by flow up to its first bit."""
  whole = scenario.Scenario(observers=1, **short)
  begun = dataclasses.replace(whole, duration_s=14.0)
  made = {}
  for name in NAMES:
    scene = begun if name.startswith('klt') else whole
    folder = tmp_path_factory.mktemp('run')
    rollout = rollout_lib.run(scene, name)
    verdict = evaluator.evaluate(scene, rollout)
    origin = provenance.Start.now('waggle x').end(rollout.renderer)
    writer.write_run(folder, scene, name, rollout, verdict, origin)
    run_page.write(folder)
    page = (folder / document.NAME).read_text(encoding='utf-8')
    page = re.sub('<(style|script).*?</', '<', page, flags=re.DOTALL)
    words = html.unescape(re.sub('<[^>]+>', ' ', page))
    made[name] = Run(folder, rollout, verdict, ' '.join(words.split()))
  return made


@pytest.mark.slow
@pytest.mark.parametrize('name', NAMES[:2])
def test_an_absolute_track_has_limits_of_its_own(
  name: str, runs: dict[str, Run]
) -> None:
  run = runs[name]
  (motion, *_) = run.rollout.traces['observer_1'].motions
  away_px, span_px = 0.12 * motion.width_px, 0.3 * motion.width_px
  assert (
    'a null stays within 15 px, a motion leaves its rest by'
    f' {away_px:.1f} px (0.12 widths, at least 2 px)'
  ) in run.words
  assert (
    f'dashed: motion ends under {0.15 * motion.width_px:.1f} px/s'
    ' (0.15 widths/s, at least 2.5 px/s)'
  ) in run.words
  assert 'share seen of the target' in run.words
  assert 'a null needs 0.2, the track 0.1' in run.words
  assert f'\u2265 {span_px:.3g} (0.3 widths) \u2713' in run.words
  for foreign in ('f-b ratio', 'features', 'at least 5', 'begins over'):
    assert foreign not in run.words


@pytest.mark.slow
def test_a_track_by_flow_has_the_papers_with_any_templates(
  runs: dict[str, Run],
) -> None:
  words = runs['klt_bank:forward_backward=off'].words
  assert 'dashed: a null stays within 15 px ' in words
  assert 'a motion leaves' not in words
  assert 'motion begins over 3.5 px/s and ends under 2.5 px/s' in words
  assert 'support features' in words
  assert 'a null needs 0.2, the track 0.2' in words
  assert '\u2265 28 \u2713' in words
  assert 'kept ratio no f-b check' in words
  assert 'widths' not in words
  assert 'f-b ratio' not in words


@pytest.mark.slow
def test_changed_numbers_are_those_of_the_page(
  runs: dict[str, Run], tmp_path: pathlib.Path
) -> None:
  run = runs['view_bank']
  trace = run.rollout.traces['observer_1']
  told = receivers.describe(
    'absolute:radius_px=7,off_px_s=30,min_span_widths=0.5,lost_share=0.3',
    width_px=signals.width_px(trace),
  )
  drawn = signals.draw(trace, 60.0, told)
  assert 'by 7.0 px (0.12 widths, at least 7 px)' in drawn
  assert 'under 30.0 px/s (0.15 widths/s, at least 30 px/s)' in drawn
  assert 'the track 0.3' in drawn
  events = [e for e in run.rollout.events['observer_1'] if e.time_s < 10][1:2]
  scores = gesture_plots.draw(events, trace, told)
  least_px = 0.5 * trace.motions[0].width_px
  assert f'{least_px:.3g} (0.5 widths)' in scores


@pytest.mark.slow
def test_what_a_receiver_does_not_tell_is_left_out(
  runs: dict[str, Run],
) -> None:
  run = runs['view_bank']
  trace = run.rollout.traces['observer_1']
  drawn = signals.draw(trace, 60.0, description.Description())
  assert 'speed, px/s, log, over time' in drawn
  assert 'dashed' not in drawn
  events = [e for e in run.rollout.events['observer_1'] if e.time_s < 10][1:2]
  figures = gesture_plots.draw(events, trace, description.Description())
  assert 'aria-label="track of the motion"' in figures
  assert 'best' not in figures
  assert 'RMSE' not in figures


@pytest.mark.slow
def test_widths_are_kept_with_the_tracks(runs: dict[str, Run]) -> None:
  for name, run in runs.items():
    kept = traces.load(run.folder / 'traces.npz')['observer_1'].motions
    known = [motion.width_px for motion in kept]
    assert known == [
      m.width_px for m in run.rollout.traces['observer_1'].motions
    ]
    assert len(known) == (2 if name.startswith('klt') else 8)
    assert all((width is None) == name.startswith('klt') for width in known)


@pytest.mark.slow
def test_without_final_null_the_message_stands_and_the_group_fails(
  runs: dict[str, Run],
) -> None:
  run = runs['absolute:final_null=off']
  (outcome,) = run.verdict.outcomes
  assert outcome.correct
  assert not run.verdict.passed
  assert outcome.final_null_s is None
  assert outcome.end_s == outcome.start_s
  assert any('no final null' in failure for failure in outcome.failures)
  last = story.readings(run.rollout.events['observer_1'])[-1][1]
  assert [m.label for m in last.symbols] == ['START', *'000010', 'END']
  whole = story.readings(runs['view_bank'].rollout.events['observer_1'])
  assert whole[-1][1].symbols == last.symbols


@pytest.mark.slow
@pytest.mark.parametrize('width', [1280, 820])
@pytest.mark.parametrize('name', NAMES)
def test_no_limit_overlaps_another_word(
  browser: chromium.Browser, runs: dict[str, Run], name: str, width: int
) -> None:
  browser.open(runs[name].folder / document.NAME)
  browser.resize(width, 800)
  assert browser.eval(chromium.OVERLAPS) == []
  assert browser.eval(chromium.CLIPPED) == []
