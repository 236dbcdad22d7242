"""Runs one episode: agents see observations, the record sees the truth."""

from collections.abc import Sequence
import dataclasses
import gc

import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.agents import observer_agent
from waggle_tasks.experiments.episodes import true_places
from waggle_tasks.experiments.record import episode, flown, provenance
from waggle_tasks.experiments.record import traces as traces_lib

# For whoever flies and needs nothing else of an episode.
Event = episode.Event
Rollout = episode.Rollout


def run(
  scene: scenario.Scenario,
  receiver_name: str,
  onlookers: Sequence[episode.Onlooker] = (),
  team: observer_agent.Team | None = None,
) -> Rollout:
  """Runs a scenario with a team of one receiver.

  Args:
    scene: The scenario.
    receiver_name: One of `receivers.RECEIVERS`.
    onlookers: What else looks on; they cannot change what happens.
    team: A new team of that receiver, where its maker looks into it.

  Raises:
    WaggleError: if the receiver is not known.
  """
  team = team or observer_agent.Team(
    scene.observers, receiver_name, scene.agreement
  )
  environment = registry.environment(scene)
  try:
    rollout = play(environment, team, onlookers)
    return dataclasses.replace(rollout, receiver=receiver_name)
  finally:
    environment.close()
    gc.collect()  # Environments are cycles, and large.


def play(
  environment: registry.composer.Environment,
  team: observer_agent.Team,
  onlookers: Sequence[episode.Onlooker] = (),
) -> Rollout:
  """Plays an episode in an environment, with a new team; closes nothing."""
  task, truth, drifts, contacts = environment.task, [], [], []
  flights: dict[str, list] = {}
  frame_s = task.agreement.frame_s
  tracer = traces_lib.Tracer(len(team.agents))
  timestep = environment.reset()
  physics = environment.physics  # Resetting may compile a new one.
  seen = true_places.TruePlaces(physics, task.observers)
  while True:
    truth.append(task.positions_m(physics))
    drifts.append(task.drifts_m())
    errors_m = task.fleet.errors_m((len(truth) - 1) * frame_s)
    for name, moment in task.fleet.flown().items():
      flights.setdefault(name, []).append(
        (*moment, errors_m[name], task.fleet.told_m[name])
      )
    seen.note(physics, truth[-1]['performer'])
    time_s = (len(truth) - 1) * frame_s
    contacts += [(time_s, pair) for pair in task.contacts]
    action = team.step(timestep.observation)
    tracer.note(team)
    for watch in onlookers:
      watch(episode.Step(environment, timestep, team))
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
    np.arange(len(truth)) * frame_s,
    {name: np.stack([p[name] for p in truth]) for name in truth[0]},
    tuple(contacts),
    events,
    provenance.renderer_name(physics),
    dict(zip(events, tracer.traces(), strict=True)),
    {name: np.stack([d[name] for d in drifts]) for name in drifts[0]},
    seen.places_px(),
    flights={
      name: flown.Flown(*map(np.stack, zip(*moments, strict=True)))
      for name, moments in flights.items()
    },
  )
