"""What people read of a sweep: a text, a page and pictures of its envelope."""

from collections.abc import Sequence
import pathlib

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.pages import sweep_page
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import envelope, figures, sweep_tables
from waggle_tasks.experiments.studies import case_rows


def write(folder: pathlib.Path, rows: Sequence[envelope.Row]) -> pathlib.Path:
  """Writes everything that follows from results.

  Args:
    folder: Where; a sweep's own, or another for several sweeps together.
    rows: The results.

  Returns:
    The page.
  """
  folder.mkdir(parents=True, exist_ok=True)
  text = sweep_tables.report(rows, None)
  files.replace(folder / case_rows.SUMMARY, f'{text}\n')
  origin = folder / case_rows.PROVENANCE
  known = archive.read_json(origin) if origin.exists() else None
  if figures.can_draw():
    figures.draw(envelope.panels(rows), folder)
  return sweep_page.write(folder, rows, known)
