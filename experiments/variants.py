"""The open choices of the reproduction, each moved alone.

The paper gives no sizes of gestures, no appearance, no settings of the tracker
and no spacing of the line.
"""

from collections.abc import Callable, Sequence
import dataclasses

from waggle_tasks import appearance
from waggle_tasks.experiments import table
from waggle_tasks.protocol import gestures


@dataclasses.dataclass(frozen=True)
class Variant:
  """One choice moved.

  Attributes:
    label: What was moved, for the table.
    changes: Fields of `Scenario` and their new values.
    receiver: The receiver.
  """

  label: str
  changes: dict[str, object] = dataclasses.field(default_factory=dict)
  receiver: str = 'klt'


def _codebook(**sizes: float) -> dict[str, object]:
  return {'codebook': gestures.v_codebook(**sizes)}


def _look(**choices: object) -> dict[str, object]:
  return {'appearance': appearance.Appearance(**choices)}


def _klt(change: str) -> Variant:
  return Variant(change, {}, f'klt:{change}')


VARIANTS = {
  'base': Variant('as chosen'),
  'half-width-low': Variant('V 0.270 m', _codebook(half_width_m=0.27)),
  'half-width-high': Variant('V 0.300 m', _codebook(half_width_m=0.3)),
  'start-low': Variant('START 0.58 m', _codebook(start_height_m=0.58)),
  'start-high': Variant('START 0.66 m', _codebook(start_height_m=0.66)),
  'gesture-short': Variant('gesture 6.5 s', _codebook(duration_s=6.5)),
  'gesture-long': Variant('gesture 8.5 s', _codebook(duration_s=8.5)),
  'corner-quality-low': _klt('corner_quality=0.03'),
  'corner-quality-high': _klt('corner_quality=0.1'),
  'corners-few': _klt('max_corners=25'),
  'corners-many': _klt('max_corners=60'),
  'check-strict': _klt('forward_backward_px=0.5'),
  'check-loose': _klt('forward_backward_px=2.0'),
  'floor-plain': Variant('plain floor', _look(floor='plain')),
  'dim': Variant('light 0.7', _look(brightness=0.7)),
  'bright': Variant('light 1.3', _look(brightness=1.3)),
  'spacing-low': Variant('line spacing 0.5 m', {'spacing_m': 0.5}),
  'spacing-high': Variant('line spacing 0.7 m', {'spacing_m': 0.7}),
  'eye-back': Variant('eye at the centre', {'eye_offset_m': 0.0}),
  'eye-ahead': Variant('eye 0.06 m ahead', {'eye_offset_m': 0.06}),
  **{
    f'jitter-{seed}': Variant(
      f'j = 0.01 m, seed {seed}', {'jitter_m': 0.01, 'seed': seed}
    )
    for seed in range(10)
  },
}  # fmt: skip


def report(
  run: Callable[[str, Variant], list[dict[str, object]]], names: Sequence[str]
) -> str:
  """Runs variants and puts what changed into a table.

  Args:
    run: Runs a variant and returns the rows of its cases.
    names: Keys of `VARIANTS`.
  """
  rows = []
  for name in names:
    results = run(name, VARIANTS[name])
    changed = [
      f'{row["case"]} {row["correct"]}/{row["observers"]}'
      f' not {row["published"]["correct"]}/{row["observers"]}'
      for row in results
      if (row['correct'], row['passed'])
      != (row['published']['correct'], row['published']['passed'])
    ]
    correct = sum(row['correct'] for row in results)
    rows.append(
      (
        VARIANTS[name].label,
        f'{correct}/{sum(row["observers"] for row in results)}',
        f'{sum(row["passed"] for row in results)}/{len(results)}',
        '; '.join(changed) or 'none',
      )
    )
  header = ('choice moved', 'messages', 'groups', 'rows unlike the paper')
  return table.render(header, rows)
