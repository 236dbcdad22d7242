"""The open choices of the reproduction, each moved alone.

The paper gives no sizes of gestures, no appearance, no settings of the tracker
and no spacing of the line.
"""

from collections.abc import Mapping
import dataclasses
from typing import Any

from waggle_tasks import appearance
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.studies import case_rows
from waggle_tasks.protocol import gestures

Results = Mapping[str, list[case_rows.SuiteRow]]


@dataclasses.dataclass(frozen=True)
class Variant:
  """What is moved, or left out.

  Attributes:
    label: Its description, for tables.
    changes: Fields of `Scenario` and their new values.
    receiver: The receiver.
  """

  label: str
  changes: dict[str, Any] = dataclasses.field(default_factory=dict)
  receiver: str = 'klt'


def _moved(label: str, **changes: object) -> Variant:
  return Variant(label, changes)


def _codebook(label: str, **sizes: float) -> Variant:
  return _moved(label, codebook=gestures.v_codebook(**sizes))


def _look(
  label: str, floor: str = 'honeycomb', brightness: float = 1.0
) -> Variant:
  look = appearance.Appearance(floor, brightness=brightness)
  return _moved(label, appearance=look)


def _klt(change: str) -> Variant:
  return Variant(change, receiver=f'klt:{change}')


VARIANTS = {
  'base': _moved('as chosen'),
  'half-width-low': _codebook('V 0.270 m', half_width_m=0.27),
  'half-width-high': _codebook('V 0.300 m', half_width_m=0.3),
  'start-low': _codebook('START 0.58 m', start_height_m=0.58),
  'start-high': _codebook('START 0.66 m', start_height_m=0.66),
  'gesture-short': _codebook('gesture 6.5 s', duration_s=6.5),
  'gesture-long': _codebook('gesture 8.5 s', duration_s=8.5),
  'corner-quality-low': _klt('corner_quality=0.03'),
  'corner-quality-high': _klt('corner_quality=0.1'),
  'corners-few': _klt('max_corners=25'),
  'corners-many': _klt('max_corners=60'),
  'check-strict': _klt('forward_backward_px=0.5'),
  'check-loose': _klt('forward_backward_px=2.0'),
  'floor-plain': _look('plain floor', floor='plain'),
  'dim': _look('light 0.7', brightness=0.7),
  'bright': _look('light 1.3', brightness=1.3),
  'spacing-low': _moved('line spacing 0.5 m', spacing_m=0.5),
  'spacing-high': _moved('line spacing 0.7 m', spacing_m=0.7),
  'eye-back': _moved('eye at the centre', eye_offset_m=0.0),
  'eye-ahead': _moved('eye 0.06 m ahead', eye_offset_m=0.06),
  **{
    f'jitter-{seed}': _moved(
      f'j = 0.01 m, seed {seed}', jitter_m=0.01, seed=seed
    )
    for seed in range(10)
  },
}


def of(receiver: str) -> dict[str, Variant]:
  """The variants for a receiver: numbers of the paper's are not moved."""
  return {
    name: dataclasses.replace(variant, receiver=receiver)
    for name, variant in VARIANTS.items()
    if variant.receiver == VARIANTS['base'].receiver
  }


def report(results: Results) -> str:
  """Puts what changed into a table.

  Args:
    results: By names of `VARIANTS`, the rows of their cases.
  """
  lines = []
  for name, rows in results.items():
    changed = [
      f'{row.case} {row.correct}/{row.observers}'
      f' not {row.published.correct}/{row.observers}'
      for row in rows
      if row.published is not None and not row.as_published
    ]
    got = case_rows.Tally.of(rows)
    lines.append(
      (
        VARIANTS[name].label, got.messages, got.groups,
        '; '.join(changed) or 'none',
      )
    )  # fmt: skip
  header = ('choice moved', 'messages', 'groups', 'rows unlike the paper')
  return table.render(header, lines)
