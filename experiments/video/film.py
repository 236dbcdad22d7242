"""Films an episode while it runs: an onlooker that leaves video files."""

import functools
import pathlib

from waggle_tasks import scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.record import changes, episode, moves, told
from waggle_tasks.experiments.video import encoders, layout, lens, page
from waggle_tasks.protocol import checks

# Of a scenario, what its title or the pictures themselves say.
_TOLD = ('control', 'payload', 'bits', 'layout', 'distance_m', 'observers')


class Film:
  """Watches a rollout and writes one video, or one for each page.

  A context manager: its files are complete when it ends. It renders the
  shared views only for the pictures of the video, copies what a picture shows
  and leaves drawing and encoding to a thread.
  """

  def __init__(
    self,
    folder: pathlib.Path,
    scene: scenario.Scenario,
    *,
    name: str | None = None,
    view: str = layout.COMPOSITE,
    fps: float = layout.FPS,
    scale: float = 1.0,
    marks: bool = True,
  ) -> None:
    """Opens the files; refused codecs are known before the episode begins.

    Args:
      folder: Where they go.
      scene: What will be flown.
      name: Of the file, named after the view when None; its ending chooses
        the codec. Pages after the first get a number.
      view: 'composite', an observer's name, or one of `layout.SHARED`.
      fps: Pictures a simulated second, at most those that there are.
      scale: Size.
      marks: Whether a single view shows what its receiver makes of it.

    Raises:
      VideoError: if a choice or the codec is refused.
    """
    name = name or f'{view}.webm'
    encoders.check_name(name)
    names = layouts.names(scene.observers)
    views = [layout.COMPOSITE, *names, *layout.SHARED]
    checks.choice('view', view, views, layout.VideoError)
    agreement = scene.agreement
    checks.number('video_fps', fps, 0.1, agreement.rate_hz, layout.VideoError)
    self._rate_hz, self._fps, self._pictures = agreement.rate_hz, fps, 0
    if view == layout.COMPOSITE:
      self._lens = lens.Lens(scene)
      shown = layout.pages(names)
      plans: list[page.Composite | page.Single] = [
        composite(scene, each, scale) for each in shown
      ]
    else:
      self._lens = lens.Lens(scene, [n for n in layout.SHARED if n == view])
      shown = [tuple(n for n in names if n == view)]
      size = agreement.camera.size if view in names else layout.VIEW_PX
      plans = [page.Single(view, scale, marks, size)]
    paths = page_paths(folder / name, len(plans))
    # Of each page: the observers it shows, how it is drawn, who encodes it.
    self._pages = [
      (names, plan, encoders.Worker(encoders.make(path, plan.size, fps)))
      for path, names, plan in zip(paths, shown, plans, strict=True)
    ]

  def __enter__(self) -> 'Film':
    return self

  def __exit__(self, kind: object, error: object, trace: object) -> None:
    """Completes the files; an error of the episode goes before theirs."""
    errors = []
    for _, _, worker in self._pages:
      try:
        worker.close()
      except Exception as own:
        errors.append(own)
    if errors and error is None:
      raise errors[0]

  def __call__(self, step: episode.Step) -> None:
    """Looks at a frame, and films it when the video has a picture for it."""
    self._lens.note(step)
    due = round(self._pictures * self._rate_hz / self._fps)
    if self._lens.frame < due:
      return
    self._pictures += 1
    shared = self._lens.shared()
    for names, plan, worker in self._pages:
      now = self._lens.moment(names, shared)
      worker.put(functools.partial(plan.draw, now))


def composite(
  scene: scenario.Scenario, names: tuple[str, ...], scale: float = 1.0
) -> page.Composite:
  """A page of a scenario's composite for some of its observers."""
  sent = moves.sent(scene.performance, scene.agreement, scene.episode_s)
  return page.Composite(
    names,
    title(scene),
    sent,
    scene.agreement,
    scene.episode_s,
    scale,
    changes.of(scene, _TOLD),
  )


def page_paths(path: pathlib.Path, count: int) -> list[pathlib.Path]:
  """The files of a video's pages: x.webm, x-2.webm, ..."""
  return [
    path.with_stem(f'{path.stem}-{k}') if k > 1 else path
    for k in range(1, count + 1)
  ]


def title(scene: scenario.Scenario) -> str:
  """A scenario in a line."""
  where = scene.layout if isinstance(scene.layout, str) else 'own layout'
  control = '' if scene.control == 'none' else f'{scene.control}, '
  said = f'payload {scene.payload}'
  if scene.bits:
    said = f'data {told.message(scene.payload, scene.bits)}'
  return f'{control}{said}, {where}, {scene.distance_m:g} m'
