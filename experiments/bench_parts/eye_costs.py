"""What one picture of each camera that has a name takes, while it is danced."""

from collections.abc import Mapping, Sequence
import contextlib
import dataclasses
import importlib.util
import statistics

from waggle_tasks import eye_presets, eyes, registry, scenario
from waggle_tasks.experiments.bench_parts import processes
from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import reference

_BEGIN_S, _END_S = 2.5, 5.0  # Of 'swift': the performer moves.
_STRETCH = 10  # Pictures of one camera, and then those of the next.
_TAKES_AV = 'h264'


@dataclasses.dataclass(frozen=True)
class Looking:
  """Seconds for one picture, by camera, for each repeat.

  Attributes:
    picture_s: Of the camera.
    ideal_s: Of an ideal one of its size and its rate.
  """

  picture_s: Mapping[str, Sequence[float]]
  ideal_s: Mapping[str, Sequence[float]]


def names() -> list[str]:
  """Of the cameras that can be measured here."""
  has_av = importlib.util.find_spec('av') is not None
  codecs = {n: each.eye.codec for n, each in eye_presets.PRESETS.items()}
  return [n for n in eyes.NAMES if has_av or codecs.get(n) != _TAKES_AV]


def measure(
  scene: scenario.Scenario, repeats: int, clock: processes.Clock
) -> Looking:
  """Films a quick dance with each camera, and with ideal ones of their sizes.

  Args:
    scene: The scenario, of which one observer watches.
    repeats: How often.
    clock: What pictures are measured by.
  """
  scene = dataclasses.replace(scene, language='swift', observers=1)
  picture_s, ideal_s = {}, {}
  for name in names():
    chosen = dataclasses.replace(scene, **eye_presets.fields(name))
    plain = dataclasses.replace(chosen, eye=eyes.Eye())
    found = [_both_s((chosen, plain), clock) for _ in range(repeats)]
    picture_s[name], ideal_s[name] = map(list, zip(*found, strict=True))
  return Looking(picture_s, ideal_s)


def _both_s(
  scenes: Sequence[scenario.Scenario], clock: processes.Clock
) -> list[float]:
  """Mean seconds of a picture of each, in turns."""
  with contextlib.ExitStack() as stack:
    studios = [
      _Studio(stack.enter_context(contextlib.closing(registry.environment(s))))
      for s in scenes
    ]
    spent: list[list[float]] = [[] for _ in scenes]
    while not all(each.over for each in studios):
      for studio, seconds in zip(studios, spent, strict=True):
        seconds += [studio.draw(clock) for _ in range(_STRETCH)]
    return [statistics.fmean(each) for each in spent]


class _Studio:
  """One camera before a dance."""

  def __init__(self, environment: registry.Environment) -> None:
    self._environment = environment
    timestep = environment.reset()
    (observer,) = environment.task.observers
    camera = observer.observables.camera
    camera.enabled = False  # It is asked here.
    environment.reset()
    self._take = camera.observation_callable(environment.physics)
    place_m = timestep.observation[0]['position_m']
    self._rest = [reference.Reference.hover(place_m).to_array()]
    while environment.physics.time() < _BEGIN_S:
      environment.step(self._rest)
    self._take()

  @property
  def over(self) -> bool:
    """Whether the dance has been filmed."""
    return self._environment.physics.time() >= _END_S

  def draw(self, clock: processes.Clock) -> float:
    """Takes the next picture; returns its seconds."""
    self._environment.step(self._rest)
    begin_s = clock()
    self._take()
    return clock() - begin_s


def ratios(found: Looking) -> dict[str, float]:
  """How many times an ideal camera's picture each takes, by its title."""
  return {
    f'picture of {name} / of an ideal camera of its size': statistics.median(
      one / other
      for one, other in zip(seconds, found.ideal_s[name], strict=True)
    )
    for name, seconds in found.picture_s.items()
    if name != eyes.IDEAL
  }


def text(found: Looking) -> str:
  """The table."""
  rows = []
  for name, seconds in found.picture_s.items():
    preset = eye_presets.PRESETS.get(name)
    usual = scenario.Scenario()
    wide, high = (
      getattr(preset or usual, f'camera_{side}_px')
      for side in ('width', 'height')
    )
    each_s = (seconds, found.ideal_s[name])
    middle = [table.number(statistics.median(s), 2, 1e3) for s in each_s]
    rows.append((name, f'{wide}x{high}', *middle))
  header = ('one picture while it is danced', 'size', 'ms', 'ideal of its size')
  return table.render(header, rows)
