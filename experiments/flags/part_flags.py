"""Flags for what is read of a recording, and by which agreement."""

import math
from typing import Any

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments.flags import config_flag
from waggle_tasks.experiments.record import agreement_file, archive
from waggle_tasks.experiments.video import recordings
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import checks

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

NAMES = (
  'roi', 'anchor', 'start', 'end', 'speed', 'fps', 'focal_px', 'fovy_deg',
  'config', 'agreement',
)  # fmt: skip


class PartError(errors.WaggleError):
  """A flag about a recording that is not valid."""


def define() -> None:
  """Defines the flags for the launcher that calls this."""
  flags.DEFINE_string(
    'roi', None, 'Part of the picture: left,top,width,height in pixels.'
  )
  flags.DEFINE_string(
    'anchor', None, 'Where the target hovers first: x,y in pixels.'
  )
  flags.DEFINE_float('start', 0.0, 'First moment, s of the recording.')
  flags.DEFINE_float(
    'end', None,
    'Last moment, s of the recording; of a camera, how long it looks.',
  )  # fmt: skip
  flags.DEFINE_float(
    'speed', 1.0, 'Seconds of the dance in a second of the recording.'
  )
  flags.DEFINE_float(
    'fps', None,
    'Pictures a second, where pictures have no times of their own, and of'
    ' events; of those 25 if unset.',
  )  # fmt: skip
  flags.DEFINE_float('focal_px', None, 'Focal length of the camera, in pixels.')
  flags.DEFINE_float(
    'fovy_deg',
    None,
    'Vertical field of view of the whole picture, in degrees. Unset, and'
    ' without --focal_px, that of the camera that was agreed on, which is'
    f' {camera_lib.FOVY_DEG:g} in the paper.',
  )
  config_flag.define(
    'the dance is in the language that was agreed on there. Unset, in that of'
    ' the paper.'
  )
  flags.DEFINE_string(
    'agreement', None,
    'What both sides knew, in place of --config:'
    f' {agreement_file.RULE}. Unset, {agreement_file.NAMES[0]}.',
  )  # fmt: skip


def agreement() -> agreement_lib.Agreement:
  """What the dancer and its audience knew.

  Raises:
    PartError: if two flags say it.
    WaggleError: if there is no such agreement.
  """
  config, agreed = flags.FLAGS['config'].value, flags.FLAGS['agreement'].value
  if config is not None and agreed is not None:
    raise PartError('`agreement` and `config` say the same: give one')
  if agreed is not None:
    return agreement_file.find(agreed)
  if config is not None:
    return archive.read_config(config_flag.path(config)).agreement
  return agreement_lib.Agreement()


def part() -> recordings.RecordingPart:
  """Which part of a recording is read.

  Raises:
    WaggleError: naming the flag that is not valid.
  """
  # Their counts are checked.
  roi: Any = _numbers('roi', 4, int)
  anchor: Any = _numbers('anchor', 2, float)
  values: dict[str, Any] = flags.FLAGS.flag_values_dict()
  return recordings.RecordingPart(
    values['start'], values['end'], roi, anchor, values['speed']
  )


def fps() -> float | None:
  """How many pictures a second there are, if it is said."""
  return flags.FLAGS['fps'].value


def camera_of(
  agreed: agreement_lib.Agreement, columns: int, rows: int
) -> camera_lib.Camera:
  """What a picture of some size was seen with.

  Args:
    agreed: Its camera has the field of view, where no flag says another.
    columns: Width of the picture.
    rows: Height of it.

  Raises:
    PartError: if two flags say it, or one what cannot be.
  """
  focal_px, fovy_deg = (
    flags.FLAGS[name].value for name in ('focal_px', 'fovy_deg')
  )
  if focal_px is not None and fovy_deg is not None:
    raise PartError('`focal_px` and `fovy_deg` say the same: give one')
  if focal_px is not None:
    checks.number('focal_px', focal_px, 1.0, 1e5, PartError)
  else:
    fovy_deg = agreed.camera.fovy_deg if fovy_deg is None else fovy_deg
    checks.number('fovy_deg', fovy_deg, 1.0, 170.0, PartError)
    focal_px = camera_lib.focal_length_px(rows, fovy_deg)
  return camera_lib.Camera(columns, rows, focal_px)


def _numbers(
  name: str, count: int, kind: type[int] | type[float]
) -> tuple[float, ...] | None:
  """The numbers of a flag such as '10,20', or None when it was not given."""
  value = flags.FLAGS[name].value
  if value is None:
    return None
  try:
    numbers = tuple(map(kind, value.split(',')))
  except ValueError:
    numbers = ()
  if len(numbers) != count or not all(map(math.isfinite, numbers)):
    raise PartError(
      f'`{name}` must be {count} numbers with commas between them: got'
      f' {value!r}'
    )
  return numbers
