"""What the receiver of whole frames asks of them, as it is told to people."""

from waggle_tasks.agents import description, joint_config
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import levels


def of(
  agreement: agreement_lib.Agreement, config: joint_config.Config
) -> description.Description:
  """The limits of `joint`, see `receivers.describe`.

  Args:
    agreement: What both sides know.
    config: Its numbers.
  """
  limits, lost = config.reading, config.tracking.lost_share
  alphabet = agreement.spoken.alphabet
  by_levels = isinstance(alphabet, levels.Levels)
  rest = (
    f', within {limits.max_rest:.0%} of the way from the hover point to the'
    ' nearest level'
  )
  view = f'from up to {limits.max_angle_deg:g} degrees to either side'
  return description.Description(
    support=description.Measure('support', 'pixels'),
    quality=description.Measure(
      'share seen', 'of the target', (lost,), f'a track needs {lost:g}'
    ),
    frames=(
      f'START is seen for {limits.min_seen:.0%} of its time, and of its size'
      f' {limits.max_start:.0%} is left unexplained at most',
      f'it is at most {limits.max_distance_m:g} m away,'
      f' {"from any side" if by_levels else view}',
      f'the word is clear by {limits.min_clear:g}: nearer than any other by'
      ' that share of how far they are apart',
      'its strokes are flown as it has them: error at most'
      f' {limits.max_misfit:g} of the way to others, {limits.max_worst:g} of'
      f' any one, and {limits.max_astray:.0%} of the track elsewhere',
      f'no other word is nearer by more than {limits.max_mended:g} of how far'
      ' they are apart, though a code would mend it',
      f'END and the rest after it are seen for {limits.min_seen:.0%} of their'
      f' time, error at most {limits.max_end:g}{rest if by_levels else ""}',
      'what the code and the check of the language ask for holds',
    ),
  )
