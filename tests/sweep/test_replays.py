"""A flight's images, shown again and again, each time spoilt in another way."""

from collections.abc import Callable
import json
import pathlib
import subprocess

import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.episodes import tape
from waggle_tasks.experiments.studies import spoilers
from waggle_tasks.protocol import agreement

Waggle = Callable[..., subprocess.CompletedProcess[str]]
AGREED = agreement.Agreement()
SECOND = [
  (np.full((96, 128, 3), 40 + number, np.uint8), number / 25)
  for number in range(25)
]


@pytest.mark.slow
def test_a_tape_plays_the_images_that_an_observer_saw(
  short: dict[str, object], hover: Callable[..., list[np.ndarray]]
) -> None:
  scene = scenario.Scenario(
    control='interrupted', observers=2, duration_s=4.6, **short
  )
  tapes = tape.record(scene, lambda frames: None)
  environment = registry.environment(scene)
  timestep = environment.reset()
  streams = [each.play() for each in tapes]
  count = 0
  while True:
    for seen, stream in zip(timestep.observation, streams, strict=True):
      image, time_s = next(stream)
      assert time_s == seen['time_s']
      np.testing.assert_array_equal(image, seen['camera'])
    count += 1
    if timestep.last():
      break
    timestep = environment.step(hover(timestep.observation))
  environment.close()
  assert [next(stream, None) for stream in streams] == [None, None]
  assert count == len(tapes[0].times_s) > 100


@pytest.mark.parametrize('kind', spoilers.LOSSES)
def test_a_loss_hides_its_time_and_nothing_else(kind: str) -> None:
  loss = spoilers.Loss(kind, 0.19, 0.4)
  seen = {time_s: image.copy() for image, time_s in loss(iter(SECOND))}
  for image, time_s in SECOND:
    if not 0.19 <= time_s < 0.59:
      np.testing.assert_array_equal(seen[time_s], image)
    elif kind == 'missing':
      assert time_s not in seen
    else:
      shown = seen[time_s]
      np.testing.assert_array_equal(shown, seen[0.2])
      assert kind in ('frozen', 'defocused') or (shown != image).any()


@pytest.mark.parametrize('name', spoilers.LASTING)
def test_what_lasts_changes_images_or_their_times(name: str) -> None:
  def shown(seed: int) -> list[tuple[float, bytes]]:
    spoiler = spoilers.LASTING[name](np.random.RandomState(seed))
    stream = spoiler(iter(SECOND))
    return [(time_s, image.tobytes()) for image, time_s in stream]

  whole = [(time_s, image.tobytes()) for image, time_s in SECOND]
  assert shown(2) == shown(2)
  assert any(shown(seed) != whole for seed in range(3))


def test_each_number_draws_another_exposure_and_always_the_same() -> None:
  def names() -> list[str]:
    return [spoilers.draw(seed, AGREED, 90.0).name for seed in range(200)]

  assert names() == names()
  assert len({*names()}) > 150
  assert '' not in names()
  text = ' '.join(names())
  for kind in (*spoilers.LOSSES, *spoilers.LASTING):
    assert kind in text


@pytest.mark.slow
def test_a_sweep_of_replays_counts_every_exposure(
  here: Waggle, tmp_path: pathlib.Path
) -> None:
  command = (
    'sweep', '--replays=3', '--control=no_send', '--duration_s=1', '--grid',
    'distance_m=0.8,1.3', '--observers=2', '--output=x', '--workers=1',
  )  # fmt: skip
  done = here(*command)
  assert done.returncode == 0, done.stderr
  assert 'right: 12/12 exposures' in done.stdout
  assert 'The 12 exposures are those of 2 broadcasts' in done.stdout
  lines = (tmp_path / 'x' / 'results.jsonl').read_text().splitlines()
  outcomes = json.loads(lines[0])['outcomes']
  assert [each['observer'] for each in outcomes] == [
    f'observer_{n}, replay {k}' for n in (1, 2) for k in range(3)
  ]
  assert len({each['spoilt'] for each in outcomes}) > 2
  # Others are another sweep.
  other = here(*(each.replace('replays=3', 'replays=4') for each in command))
  assert 'right: 16/16 exposures' in other.stdout, other.stderr
