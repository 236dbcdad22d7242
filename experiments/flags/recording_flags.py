"""Flags for what is kept of an episode beside its events, and the keeping."""

from collections.abc import Iterator
import contextlib
import pathlib
from typing import Any

from absl import flags

from waggle_tasks import scenario
from waggle_tasks.experiments.record import capture, episode
from waggle_tasks.experiments.video import encoders, layout

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

_ABOUT_VIDEO = ('view', 'video_file', 'video_fps', 'video_scale', 'video_marks')


def define() -> None:
  """Defines the flags for the launcher that calls this."""
  flags.DEFINE_boolean('video', False, 'Whether to film the episode.')
  flags.DEFINE_string(
    'view',
    layout.COMPOSITE,
    f'What is filmed: {layout.COMPOSITE} for everyone, or one of'
    f' {", ".join(layout.SHARED)}, observer_1, observer_2, ...',
  )
  flags.DEFINE_string(
    'video_file',
    None,
    f'Name of the video, ending in one of {", ".join(encoders.ENCODERS)}; .mp4'
    ' needs the extra [video]. Unset, VIEW.webm.',
  )
  flags.DEFINE_float(
    'video_fps', layout.FPS, 'Pictures a simulated second, --rate_hz at most.'
  )
  flags.DEFINE_float('video_scale', 1.0, 'Size of the video, 0.25 to 2.')
  flags.DEFINE_boolean(
    'video_marks',
    True,
    'Whether a single view shows track and symbols; without, it is what a'
    ' camera would record.',
  )
  flags.DEFINE_boolean(
    'raw', False, "Whether to keep every observer's images, lossless."
  )


@contextlib.contextmanager
def recorders(
  folder: pathlib.Path, scene: scenario.Scenario
) -> Iterator[list[episode.Onlooker]]:
  """The onlookers that the flags ask for; their files are complete at the end.

  Args:
    folder: The run folder.
    scene: What will be flown.

  Raises:
    VideoError: if a choice or the codec is refused.
  """
  values: dict[str, Any] = flags.FLAGS.flag_values_dict()
  for name in _ABOUT_VIDEO:
    if flags.FLAGS[name].present and not values['video']:
      raise layout.VideoError(f'`{name}` is about a video: add --video')
  with contextlib.ExitStack() as stack:
    onlookers: list[episode.Onlooker] = []
    if values['raw']:
      onlookers.append(stack.enter_context(capture.Recorder(folder)))
    if values['video']:
      # Imported here: what films draws with the simulator.
      from waggle_tasks.experiments.video import film

      shot = film.Film(
        folder,
        scene,
        name=values['video_file'],
        view=values['view'],
        fps=values['video_fps'],
        scale=values['video_scale'],
        marks=values['video_marks'],
      )
      onlookers.append(stack.enter_context(shot))
    yield onlookers
