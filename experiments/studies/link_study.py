"""A link as a study: a sweep whose cases are read by receivers of their own."""

from collections.abc import Sequence

from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.studies import case_rows, sweep_cases, sweep_study


class Link(sweep_study.Sweep):
  """The broadcasts of a link."""

  kind = 'link'
  files = (
    case_rows.JOURNAL, case_rows.PROVENANCE, case_rows.SUMMARY, archive.PAGE,
    *case_rows.LINK_FIGURES,
  )  # fmt: skip

  def __init__(self, cases: Sequence[sweep_cases.Sample]) -> None:
    """Makes a study of `link_cases.cases`."""
    super().__init__(cases, cases[0].receiver)
