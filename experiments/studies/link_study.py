"""A link as a study: a sweep whose cases are read by receivers of their own."""

from collections.abc import Sequence

from waggle_tasks.experiments.studies import case_rows, sweep_cases, sweep_study


class Link(sweep_study.Sweep):
  """The broadcasts of a link."""

  kind = 'link'
  files = (*sweep_study.Sweep.files, *case_rows.LINK_FIGURES)

  def __init__(self, cases: Sequence[sweep_cases.Sample]) -> None:
    """Makes a study of `link_cases.cases`."""
    super().__init__(cases, cases[0].receiver)
