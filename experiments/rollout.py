"""Runs one episode: agents see observations, the record sees the truth."""

from collections.abc import Callable, Sequence
import dataclasses
import gc

import dm_env
import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments import provenance, sight
from waggle_tasks.experiments import traces as traces_lib
from waggle_tasks.protocol import timing
from waggle_tasks.tasks import safety

Event = receiver.Event | observer_agent.Navigation | safety.Refusal
# Called with the environment, each time step, and the team after it has acted
# on it. A watcher may look at everything and change nothing.
Watcher = Callable[
  [registry.composer.Environment, dm_env.TimeStep, observer_agent.Team], None
]


@dataclasses.dataclass(frozen=True, eq=False)
class Rollout:
  """What happened in an episode.

  Attributes:
    times_s: (T,) one time for each frame, from zero.
    positions_m: By vehicle name, (T, 3) true positions.
    contacts: Time and names of every pair that touched.
    events: By observer name, what its agent saw and did, and what the safety
      checks refused, in order of time.
    renderer: The GL renderer that drew the images.
    traces: By observer name, what its receiver saw in each image.
    drifts_m: By vehicle name, (T, 3) how far it was taken from its reference;
      nobody when empty.
    targets_px: By observer name, (T, 2) where the performer truly was in its
      picture, x right and y down; NaN behind the camera.
    receiver: How observers read.
  """

  times_s: np.ndarray
  positions_m: dict[str, np.ndarray]
  contacts: tuple[tuple[float, tuple[str, str]], ...]
  events: dict[str, tuple[Event, ...]]
  renderer: str
  traces: dict[str, traces_lib.Trace] = dataclasses.field(default_factory=dict)
  drifts_m: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
  targets_px: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
  receiver: str = ''

  def steady_m(self, name: str) -> np.ndarray:
    """(T, 3) true positions of a vehicle, less its drift: nobody's command."""
    return self.positions_m[name] - self.drifts_m.get(name, 0.0)


def run(
  scene: scenario.Scenario,
  receiver_name: str,
  watchers: Sequence[Watcher] = (),
) -> Rollout:
  """Runs a scenario with a team of one receiver.

  Args:
    scene: The scenario.
    receiver_name: One of `receivers.RECEIVERS`.
    watchers: What else looks on; they cannot change what happens.

  Raises:
    WaggleError: if the receiver is not known.
  """
  team = observer_agent.Team(scene.observers, receiver_name, scene.agreement)
  environment = registry.environment(scene)
  try:
    rollout = play(environment, team, watchers)
    return dataclasses.replace(rollout, receiver=receiver_name)
  finally:
    environment.close()
    gc.collect()  # Environments are cycles, and large.


def play(
  environment: registry.composer.Environment,
  team: observer_agent.Team,
  watchers: Sequence[Watcher] = (),
) -> Rollout:
  """Plays an episode in an environment, with a new team; closes nothing."""
  task, truth, drifts, contacts = environment.task, [], [], []
  tracer = traces_lib.Tracer(len(team.agents))
  timestep = environment.reset()
  physics = environment.physics  # Resetting may compile a new one.
  seen = sight.Sight(physics, task.observers)
  while True:
    truth.append(task.positions_m(physics))
    drifts.append(task.drifts_m())
    seen.note(physics, truth[-1]['performer'])
    time_s = (len(truth) - 1) * timing.FRAME_S
    contacts += [(time_s, pair) for pair in task.contacts]
    action = team.step(timestep.observation)
    tracer.note(team)
    for watch in watchers:
      watch(environment, timestep, team)
    if timestep.last():
      break
    timestep = environment.step(action)
  events = {}
  for each, agent in zip(task.observers, team.agents, strict=True):
    name = each.mjcf_model.model
    refused = [r for r in task.refusals if r.vehicle == name]
    events[name] = tuple(
      sorted([*agent.events, *refused], key=lambda event: event.time_s)
    )
  return Rollout(
    np.arange(len(truth)) * timing.FRAME_S,
    {name: np.stack([p[name] for p in truth]) for name in truth[0]},
    tuple(contacts),
    events,
    provenance.renderer_name(physics),
    dict(zip(events, tracer.traces(), strict=True)),
    {name: np.stack([d[name] for d in drifts]) for name in drifts[0]},
    seen.places_px(),
  )
