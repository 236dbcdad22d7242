"""An observer reads its own images until it has a message, then flies it."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from waggle_tasks import errors
from waggle_tasks.agents import image_chain, navigator, observer_agent, receiver
from waggle_tasks.protocol import frame, payload
from waggle_tasks.protocol.symbols import Symbol

HOME_M = np.array([0.0, -1.3, 1.3])
GREY = np.full((48, 64, 3), 90, np.uint8)
FORWARD = payload.Payload.from_bits('000010')


def null(
  time_s: float, message: payload.Payload | None = None
) -> receiver.Event:
  return receiver.Event(time_s, Symbol.NULL, frame.State.START, message=message)


class Script:
  """A receiver that confirms what it is told to; it counts its images."""

  def __init__(self, *events: receiver.Event) -> None:
    self._events = {event.time_s: event for event in events}
    self.times_s: list[float] = []

  def step(self, image: np.ndarray, time_s: float) -> Sequence[receiver.Event]:
    assert image.dtype == np.uint8
    self.times_s.append(time_s)
    return tuple(e for t, e in self._events.items() if t == time_s)


def observation(
  time_s: float, position_m: np.ndarray = HOME_M, image: np.ndarray = GREY
) -> dict[str, np.ndarray]:
  return {
    'camera': image,
    'time_s': np.array(time_s),
    'position_m': np.array(position_m),
  }


def agent_of(script: Script) -> observer_agent.ObserverAgent:
  return observer_agent.ObserverAgent(script, navigator.Navigator())


def fly(
  agent: observer_agent.ObserverAgent, frames: int
) -> list[observer_agent.Navigation]:
  """Follows its actions exactly; returns what it did."""
  position_m = HOME_M
  for index in range(frames):
    action = agent.step(observation(round(index * 0.04, 6), position_m))
    assert action.shape == (13,)
    position_m = action[:3]
  kind = observer_agent.Navigation
  return [event for event in agent.events if isinstance(event, kind)]


def test_without_a_message_it_hovers() -> None:
  script = Script(null(0.2), null(1.0))
  agent = agent_of(script)
  assert fly(agent, 100) == []
  assert [event.symbol for event in agent.events] == [Symbol.NULL] * 2
  action = agent.step(observation(9.0, HOME_M + 0.1))
  np.testing.assert_array_equal(action[:3], HOME_M)
  assert len(script.times_s) == 101


def test_it_starts_at_the_time_of_its_final_null() -> None:
  agent = agent_of(Script(null(2.0, FORWARD)))
  start, arrival = fly(agent, 200)
  assert agent.events.index(start) == 1  # Right after the null.
  assert (start.deed, start.time_s) == (observer_agent.Deed.START, 2.0)
  assert start.payload == FORWARD
  np.testing.assert_allclose(start.target_m, (0.0, -0.9, 1.3), atol=1e-12)
  assert arrival.deed is observer_agent.Deed.ARRIVAL
  assert arrival.time_s == pytest.approx(2.0 + 3.144, abs=0.07)


def test_recognition_stops_while_it_navigates() -> None:
  script = Script(null(2.0, FORWARD), null(4.0, FORWARD), null(7.0))
  agent = agent_of(script)
  fly(agent, 200)
  assert script.times_s[-1] == 2.0
  start, arrival = agent.events[1:]
  # Images go on, but they are not part of the message any more.
  assert start.images == arrival.images == 51
  assert start.provenance == arrival.provenance


def test_it_flies_from_where_it_is_and_not_from_where_it_was() -> None:
  agent = agent_of(Script(null(0.04, FORWARD)))
  agent.step(observation(0.0))
  agent.step(observation(0.04, HOME_M + np.array([0.01, 0.0, 0.0])))
  (start,) = agent.events[1:]
  np.testing.assert_allclose(start.target_m, (0.01, -0.9, 1.3))


def test_an_image_that_comes_again_is_not_read_again() -> None:
  script = Script(null(0.08, FORWARD))
  agent = agent_of(script)
  first = agent.step(observation(0.0, image=IMAGES[0]))
  for time_s in (0.0, 0.0):
    again = agent.step(observation(time_s, HOME_M + 0.1, IMAGES[0]))
    np.testing.assert_array_equal(again, first)
  for time_s, image in ((0.04, IMAGES[1]), (0.08, IMAGES[2]), (0.04, GREY)):
    agent.step(observation(time_s, image=image))
  assert script.times_s == TIMES_S
  assert agent.events[-1].images == 3
  assert agent.events[-1].provenance == digest(IMAGES, TIMES_S)


def test_it_arrives_once_when_every_other_image_is_missing() -> None:
  agent = agent_of(Script(null(0.0, FORWARD)))
  position_m = HOME_M
  for index in range(200):
    position_m = agent.step(
      observation(round(index // 2 * 0.08, 6), position_m)
    )[:3]
  deeds = [each.deed for each in agent.events[1:]]
  assert deeds == [observer_agent.Deed.START, observer_agent.Deed.ARRIVAL]


def digest(images: Sequence[np.ndarray], times_s: Sequence[float]) -> str:
  chain = image_chain.Chain()
  for image, time_s in zip(images, times_s, strict=True):
    chain.add(image, time_s)
  assert chain.images == len(images)
  return chain.digest


IMAGES = [
  np.random.RandomState(i).randint(0, 256, (48, 64, 3), np.uint8)
  for i in range(3)
]
TIMES_S = [0.0, 0.04, 0.08]


def test_a_start_names_the_images_that_were_read() -> None:
  agent = agent_of(Script(null(0.08, FORWARD)))
  for image, time_s in zip(IMAGES, TIMES_S, strict=True):
    agent.step(observation(time_s, image=image))
  assert agent.events[-1].provenance == digest(IMAGES, TIMES_S)


@pytest.mark.parametrize('index', [0, 1, 2])
@pytest.mark.parametrize('place', [(0, 0, 0), (17, 31, 1), (47, 63, 2)])
def test_one_pixel_changes_the_digest(
  index: int, place: tuple[int, int, int]
) -> None:
  changed = [image.copy() for image in IMAGES]
  changed[index][place] ^= 1
  assert digest(changed, TIMES_S) != digest(IMAGES, TIMES_S)


@pytest.mark.parametrize('index', [0, 1, 2])
def test_one_timestamp_changes_the_digest(index: int) -> None:
  times_s = [*TIMES_S]
  times_s[index] += 1e-6
  assert digest(IMAGES, times_s) != digest(IMAGES, TIMES_S)


def test_order_shape_and_number_of_images_change_the_digest() -> None:
  swapped = [IMAGES[1], IMAGES[0], IMAGES[2]]
  turned = [IMAGES[0].reshape(64, 48, 3), *IMAGES[1:]]
  digests = {
    digest(IMAGES, TIMES_S),
    digest(swapped, TIMES_S),
    digest(turned, TIMES_S),
    digest(IMAGES[:2], TIMES_S[:2]),
    digest([], []),
  }
  assert len(digests) == 5
  assert all(len(each) == 64 for each in digests)


def test_the_digest_is_the_same_in_every_memory_layout() -> None:
  mirrored = [image[:, ::-1][:, ::-1] for image in IMAGES]
  odd = [np.asfortranarray(image) for image in IMAGES]
  expected = digest(IMAGES, TIMES_S)
  assert digest(mirrored, TIMES_S) == digest(odd, TIMES_S) == expected


@pytest.mark.parametrize('count', [1, 4])
def test_a_team_has_one_agent_for_each_observer(count: int) -> None:
  team = observer_agent.Team(count)
  assert len({*map(id, (each.receiver for each in team.agents))}) == count
  actions = team.step([observation(0.0)] * count)
  assert len(actions) == count
  for action in actions:
    np.testing.assert_array_equal(action[:3], HOME_M)


def test_a_team_of_an_unknown_receiver_is_refused() -> None:
  with pytest.raises(errors.WaggleError, match='`receiver` must be one of'):
    observer_agent.Team(1, 'ktl')


@pytest.mark.parametrize(
  ('spoil', 'error'),
  [
    (lambda o: o[:1], 'one for each of 2 agents: got 1'),
    (lambda o: [*o, o[0]], 'one for each of 2 agents: got 3'),
    (lambda o: [], 'one for each of 2 agents: got 0'),
    (lambda o: o[0], 'one for each of 2 agents: got 3'),
    (lambda o: ['camera', o[1]], 'agent 1 lacks camera, time_s, position_m'),
    (lambda o: [o[0], {**o[1], 'position_m': [0, 1]}], 'agent 2 must be 3 fin'),
    (
      lambda o: [o[0], {**o[1], 'time_s': np.nan}],
      'of agent 2 must be a finite',
    ),
    (
      lambda o: [o[0], {**o[1], 'time_s': None}],
      'agent 2 must be a finite num',
    ),
    (
      lambda o: [o[0], {**o[1], 'position_m': [0, 1, np.nan]}],
      '`position_m` of agent 2 must be 3 finite numbers',
    ),
    *(
      (
        lambda o, name=name: [o[0], {k: o[1][k] for k in o[1] if k != name}],
        f'camera, time_s, position_m: that of agent 2 lacks {name}$',
      )
      for name in observer_agent.SIGHTS
    ),
  ],
)
def test_a_team_refuses_what_is_no_observation_before_anybody_takes_it(
  spoil: Callable[[list], object], error: str
) -> None:
  team = observer_agent.Team(2)
  scripts = Script(), Script()
  team.agents = tuple(map(agent_of, scripts))
  seen = [observation(0.0), observation(0.0, HOME_M + 1)]
  with pytest.raises(observer_agent.ObservationError, match=error):
    team.step(spoil(seen))
  assert [script.times_s for script in scripts] == [[], []]
  actions = team.step(seen)  # The team goes on.
  np.testing.assert_array_equal(actions[1][:3], HOME_M + 1)


def test_an_image_that_its_receiver_refuses_was_never_taken() -> None:
  class Picky(Script):
    def step(self, image: np.ndarray, time_s: float) -> tuple:
      if image.size == 0:
        raise ValueError('empty')
      return super().step(image, time_s)

  def run(*images: np.ndarray) -> observer_agent.Navigation:
    agent = agent_of(Picky(null(0.04, FORWARD)))
    for image in images:
      if image.size == 0:
        with pytest.raises(ValueError, match='empty'):
          agent.step(observation(0.04, image=image))
      else:
        agent.step(observation(0.0 if agent._action is None else 0.04))
    return agent.events[-1]

  clean = run(GREY, GREY)
  spoilt = run(GREY, GREY[:0], GREY)
  assert (spoilt.images, spoilt.provenance) == (clean.images, clean.provenance)


def test_an_agent_alone_refuses_what_is_no_observation() -> None:
  script = Script()
  agent = agent_of(script)
  with pytest.raises(
    observer_agent.ObservationError, match='that of this agent lacks camera'
  ):
    agent.step({'time_s': 0.0, 'position_m': HOME_M})
  assert script.times_s == []
