"""With `safety='avoid'` observers fly round each other to where messages lead.

Agents are such that know the message; nothing is drawn.
"""

from collections.abc import Callable, Sequence
import dataclasses
import itertools
import math

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import flight, payload, performance, reference
from waggle_tasks.tasks import drift, safety

Load = Callable[..., composer.Environment]
FRAME_S = 0.04


class Faked:
  """Flies the payload of a scenario from a time on, as a reader would."""

  def __init__(self, scene: scenario.Scenario, begin_s: float = 0.4) -> None:
    self._scene, self._begin_s = scene, begin_s
    self._homes_m: list[np.ndarray] = []
    self._flights: list[flight.Flight] = []

  def __call__(self, observations: Sequence[dict]) -> list[np.ndarray]:
    if not self._homes_m:
      self._homes_m = [o['position_m'].copy() for o in observations]
    time_s = float(observations[0]['time_s'])
    if time_s < self._begin_s - 1e-6:
      return [reference.Reference.hover(h).to_array() for h in self._homes_m]
    if not self._flights:
      self._flights = [self._flight(o['position_m']) for o in observations]
    return [
      reference.Reference(
        *each.motion(time_s + FRAME_S / 2), 0.0, each.goal_m
      ).to_array()
      for each in self._flights
    ]

  def _flight(self, position_m: np.ndarray) -> flight.Flight:
    way_m = self._scene.message.displacement_m(self._scene.units)
    goal_m = flight.goal_m(position_m, way_m, self._scene.agreement)
    return flight.Flight(position_m.copy(), goal_m, self._begin_s)


@dataclasses.dataclass
class Told:
  """What came of an episode without a dance and without cameras."""

  places_m: np.ndarray  # (T, V, 3)
  rewards: list[float]
  refusals: int
  targets_m: list[np.ndarray]

  def least_m(self) -> float:
    pairs = itertools.combinations(range(self.places_m.shape[1]), 2)
    return min(
      np.linalg.norm(self.places_m[:, a] - self.places_m[:, b], axis=1).min()
      for a, b in pairs
    )


@pytest.fixture
def flown(load: Load, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Told]:
  """Flies a scenario's message at once: its dance is taken as flown."""

  def run(
    seconds: float = 25.0, begin_s: float = 0.4, **fields: object
  ) -> Told:
    scene = scenario.Scenario(duration_s=seconds, **fields)
    silent = performance.Performance()
    monkeypatch.setattr(scenario.Scenario, 'performance', silent)
    environment = load('broadcast', cameras=False, duration_s=seconds, **fields)
    task, agent = environment.task, Faked(scene, begin_s)
    displacement_m = scene.message.displacement_m(scene.units)
    timestep, places, rewards = environment.reset(), [], 0.0
    for each, way in zip(
      task._flights._gates, task._flights._progress, strict=True
    ):
      way.target_m = flight.goal_m(each.hold_m, displacement_m, scene.agreement)
    task._flights._displacement_m = displacement_m
    monkeypatch.setattr(type(task), 'sends_message', True)
    while not timestep.last():
      timestep = environment.step(agent(timestep.observation))
      assert timestep.discount == 1
      rewards = rewards + np.array(timestep.reward)
      found = task.positions_m(environment.physics)
      places.append([*found.values()])
    targets = [way.target_m for way in task._flights._progress]
    return Told(np.array(places), list(rewards), len(task.refusals), targets)

  return run


AT_PERFORMER = {'distance_m': 0.6, 'payload': '000011', 'observers': 1}


def test_a_message_that_leads_through_the_performer_is_refused_as_ever(
  flown: Callable[..., Told],
) -> None:
  told = flown(3.0, **AT_PERFORMER)
  assert told.refusals == 1
  np.testing.assert_allclose(told.places_m[-1, 1], (0, -0.6, 1.3), atol=1e-4)


@pytest.mark.slow
def test_or_leads_to_the_nearest_place_beside_it(
  flown: Callable[..., Told],
) -> None:
  told = flown(**AT_PERFORMER, safety='avoid')
  assert (told.refusals, told.rewards) == (0, [1.0])
  np.testing.assert_allclose(told.places_m[-1, 1], (0, -0.2, 1.3), atol=2e-3)
  assert told.least_m() > safety.MINIMUM_SPACING_M


BEHIND = {
  'distance_m': 0.3, 'payload': '000011', 'observers': 1, 'safety': 'avoid'
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
  'fields',
  [
    {},
    {'dynamics': 'rotors'},
    {'dynamics': 'rotors', 'estimator': 'lighthouse'},
  ],
  ids=['ideal', 'rotors', 'estimator'],
)
def test_a_message_through_the_performer_leads_round_it(
  fields: dict[str, object], flown: Callable[..., Told]
) -> None:
  told = flown(**BEHIND, **fields)
  assert told.refusals == 0
  off_m = np.linalg.norm(told.places_m[-1, 1] - told.targets_m[0])
  assert off_m < (0.03 if 'estimator' in fields else 5e-3)
  assert told.least_m() > safety.MINIMUM_SPACING_M
  # Who hovers is not pushed.
  stayed_m = np.linalg.norm(told.places_m[:, 0] - (0, 0, 1.3), axis=1)
  assert stayed_m.max() < (0.05 if 'estimator' in fields else 2e-3)


@pytest.mark.slow
def test_it_is_flown_in_the_same_way_again(flown: Callable[..., Told]) -> None:
  one, other = (flown(**BEHIND) for _ in range(2))
  np.testing.assert_array_equal(one.places_m, other.places_m)


@pytest.mark.slow
def test_who_has_nobody_in_the_way_flies_as_with_refuse(
  flown: Callable[..., Told],
) -> None:
  """Whole formations do."""
  ways = [
    flown(6.0, safety=each, observers=5, payload='001010').places_m
    for each in safety.SAFETIES
  ]
  np.testing.assert_allclose(*ways, atol=1e-6)


PLACE = {'units': payload.Units(meaning='place'), 'observers': 5}


@pytest.mark.slow
def test_a_place_has_a_slot_for_everybody(flown: Callable[..., Told]) -> None:
  told = flown(**PLACE, payload='000010', safety='avoid')
  assert told.rewards == [1.0] * 5
  np.testing.assert_allclose(told.places_m[-1, 1:], told.targets_m, atol=2e-3)
  assert told.least_m() > safety.MINIMUM_SPACING_M
  # On a ring about the place, but for the slot that the performer is in.
  about_m = np.linalg.norm(told.places_m[-1, 1:, :2] - (0, 0.4), axis=1)
  np.testing.assert_allclose(np.delete(about_m, 2), 0.5, atol=2e-3)


def test_an_unknown_safety_is_refused() -> None:
  with pytest.raises(scenario.ScenarioError, match='`safety` must be one of'):
    scenario.Scenario(safety='hope')


@pytest.mark.slow
def test_who_has_not_read_is_flown_round_and_not_moved(load: Load) -> None:
  """It is where its neighbour's way leads through."""
  fields = {
    'layout': 'line', 'observers': 2, 'spacing_m': 0.3, 'payload': '101011',
    'language': 'swift', 'safety': 'avoid',
  }  # fmt: skip
  scene = scenario.Scenario(**fields)
  begin_s = math.ceil(scene.performance.end_s / FRAME_S) * FRAME_S
  environment = load('broadcast', cameras=False, **fields)
  agent, rewards, ways_m = Faked(scene, begin_s), np.zeros(2), []
  timestep = environment.reset()
  hold = reference.Reference.hover(timestep.observation[1]['position_m'].copy())
  for _ in range(round((begin_s + 8.0) / FRAME_S)):
    asked, _ = agent(timestep.observation)
    timestep = environment.step([asked, hold.to_array()])
    rewards += timestep.reward
    found = environment.task.positions_m(environment.physics)
    ways_m.append([found['observer_1'], found['observer_2']])
  flown_m, stayed_m = np.array(ways_m).swapaxes(0, 1)
  np.testing.assert_allclose(np.ptp(stayed_m, axis=0), 0, atol=1e-4)
  away_m = np.linalg.norm(flown_m - stayed_m, axis=1)
  assert away_m.min() > safety.MINIMUM_SPACING_M
  np.testing.assert_allclose(flown_m[-1] - flown_m[0], (0.6, 0, 0), atol=2e-3)
  assert rewards.tolist() == [1, 0]


@pytest.mark.slow
def test_nobody_flies_into_a_dance_that_goes_on(load: Load) -> None:
  """Who has read the first round waits for the end of the second."""
  fields = {
    'language': 'swift', 'repeat': 2, 'observers': 1, 'safety': 'avoid',
    'distance_m': 0.5, 'payload': '000011',
  }  # fmt: skip
  scene = scenario.Scenario(**fields)
  said_s, end_s = scene.performance.said_s, scene.performance.end_s
  begin_s = math.ceil(said_s / FRAME_S) * FRAME_S
  assert begin_s + 1 < end_s
  environment = load('broadcast', cameras=False, **fields)
  task, agent = environment.task, Faked(scene, begin_s)
  timestep, places_m = environment.reset(), []
  rewards = 0.0
  while not timestep.last():
    timestep = environment.step(agent(timestep.observation))
    rewards += timestep.reward[0]
    found = task.positions_m(environment.physics)
    places_m.append([found['performer'], found['observer_1']])
  ways_m = np.array(places_m)
  before = round(end_s / FRAME_S) - 1
  np.testing.assert_allclose(np.ptp(ways_m[:before, 1], axis=0), 0, atol=1e-4)
  away_m = np.linalg.norm(ways_m[:, 0] - ways_m[:, 1], axis=1)
  assert away_m.min() > safety.MINIMUM_SPACING_M
  assert rewards == 1


@pytest.mark.slow
def test_data_have_no_slots_and_move_nobody(load: Load) -> None:
  units = payload.Units(meaning='place', slot_m=0.2)
  environment = load(
    'broadcast', cameras=False, language='swift', bits='1011001', observers=5,
    units=units, safety='avoid', duration_s=1.0,
  )  # fmt: skip
  timestep, places_m = environment.reset(), []
  holds = [
    reference.Reference.hover(each['position_m'].copy()).to_array()
    for each in timestep.observation
  ]
  while not timestep.last():
    timestep = environment.step(holds)
    assert timestep.reward == [0.0] * 5
    found = environment.task.positions_m(environment.physics)
    places_m.append([found[f'observer_{k}'] for k in range(1, 6)])
  np.testing.assert_allclose(np.ptp(places_m, axis=0), 0, atol=1e-4)


HOVER = drift.Drift(performer_hover='mocap', observer_hover='mocap')


@pytest.mark.slow
@pytest.mark.parametrize('seed', range(4))
def test_a_place_beside_the_performer_is_found_while_all_hover(
  seed: int, flown: Callable[..., Told]
) -> None:
  """A goal in the middle of the performer, but for how both hover."""
  told = flown(
    12.0, 3.0, **AT_PERFORMER, safety='avoid', drift=HOVER, seed=seed
  )
  assert told.rewards == [1.0]
  off_m = told.targets_m[0] - (0, -HOVER.near_m - 0.2, 1.3)
  assert np.linalg.norm(off_m) < 0.05
  assert told.least_m() > safety.MINIMUM_SPACING_M


@pytest.mark.slow
@pytest.mark.parametrize(
  'estimator', ['mocap', pytest.param('flow_deck', marks=pytest.mark.long)]
)
def test_errors_and_hover_widen_what_is_kept(
  estimator: str, flown: Callable[..., Told]
) -> None:
  fields = {
    'observers': 4, 'safety': 'avoid', 'dynamics': 'rotors',
    'estimator': estimator, 'drift': HOVER,
    'units': payload.Units(meaning='place', slot_m=1.0),
  }  # fmt: skip
  kept_m = scenario.Scenario(**fields).kept_m
  assert kept_m > safety.MINIMUM_SPACING_M + HOVER.near_m + 0.04
  told = flown(14.0, 2.0, **fields)
  assert told.least_m() > safety.MINIMUM_SPACING_M
  off_m = np.linalg.norm(told.places_m[-1, 1:] - told.targets_m, axis=1)
  assert off_m.max() < 0.1


def test_who_stands_nearer_than_is_kept_beside_errors_is_refused() -> None:
  with pytest.raises(layouts.LayoutError, match=r'must start at least 0\.3'):
    scenario.Scenario(
      distance_m=0.3, safety='avoid', dynamics='rotors', estimator='mocap',
      drift=HOVER, observers=1,
    )  # fmt: skip
