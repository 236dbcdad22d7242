"""Messages are read though dancers and observers hover as real ones do."""

import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.protocol import gestures, timing
from waggle_tasks.tasks import drift

# Half as long as the paper's; gestures are as large.
LANGUAGE = {
  'codebook': gestures.v_codebook(duration_s=4.5),
  'pauses': timing.Timing(3.5, 1.0, 1.5, 1.0),
}
LONG = pytest.mark.long


def read(seed: int, hover: drift.Drift, **fields: object) -> verdicts.Verdict:
  """What one observer of a dance makes of it."""
  scene = scenario.Scenario(
    observers=1, seed=seed, drift=hover, **LANGUAGE, **fields
  )
  return evaluator.evaluate(scene, rollout.run(scene, 'view_bank'))


@pytest.mark.parametrize(
  'hover',
  [
    pytest.param(drift.Drift(performer_hover='mocap'), marks=LONG),
    pytest.param(drift.Drift(performer_hover='flow_deck'), marks=LONG),
    pytest.param(drift.Drift(observer_hover='mocap'), marks=LONG),
    pytest.param(
      drift.Drift(performer_hover='lighthouse', observer_hover='lighthouse'),
      marks=LONG,
    ),
  ],
  ids=['dancer', 'restless dancer', 'observer', 'both'],
)
def test_a_message_is_read_through_the_hover_of_real_vehicles(
  hover: drift.Drift,
) -> None:
  (outcome,) = read(2, hover, payload='100110').outcomes
  assert outcome.decoded == '100110'


@pytest.mark.parametrize('control', ['seven_bits', 'random_walk'])
@pytest.mark.long
def test_what_is_no_message_is_none_when_everybody_hovers(control: str) -> None:
  both = drift.Drift(performer_hover='mocap', observer_hover='mocap')
  verdict = read(3, both, control=control)
  assert verdict.outcomes[0].decoded is None
  assert verdict.passed
