"""What decides the result of an episode, as one hash."""

import hashlib
import json

from waggle_tasks import fidelity, plain, scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.episodes import ladder_table, outside
from waggle_tasks.experiments.record import provenance, source_files, writer


def of(scene: scenario.Scenario, receiver_name: str, source_digest: str) -> str:
  """A SHA-256 of all that decides the result of an episode.

  Code from outside of this project counts with its sources, and with what it
  makes: where vehicles stand, what is flown, the numbers of the receiver.

  Args:
    scene: The scenario.
    receiver_name: The receiver.
    source_digest: Of this project's sources, see `provenance`.

  Raises:
    UnknownSourceError: if code from outside has no source.
  """
  _, numbers = receivers.configured(receiver_name)
  parts = {
    'config': writer.config(scene, receiver_name),
    'sources': source_digest,
    'versions': provenance.versions(),
    'outside': source_files.hashes(outside.paths(receiver_name, [scene])),
    'poses': scene.poses(),
    'performance': scene.performance,
    'episode_s': scene.episode_s,
    'numbers': numbers,
  }
  if scene.fidelity != fidelity.PIXELS:
    parts['ladder'] = hashlib.sha256(ladder_table.PATH.read_bytes()).hexdigest()
  text = json.dumps(plain.to_plain(parts), sort_keys=True)
  return hashlib.sha256(text.encode()).hexdigest()
