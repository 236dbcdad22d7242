"""A board as a study: a sweep whose cases are read by receivers of their own.

Its films are made before anything is flown, in the folder of the board, and
sent to whoever reads them.
"""

from collections.abc import Callable, Mapping, Sequence
import hashlib
import json
import pathlib
from typing import Protocol

from waggle_tasks import plain
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.record import archive, source_files
from waggle_tasks.experiments.studies import (
  board_cases,
  board_flight,
  board_tiers,
  case_rows,
  pool,
  sweep_cases,
  sweep_study,
)

FILE, PICTURES, FILMS = 'board.json', 'pictures', 'films'


class Films(Protocol):
  """What makes films of dances, and what reads them.

  Attributes:
    read: Reads a film: called in a worker with what reports progress, the
      case, its identity, the film's name and what it holds.
  """

  read: Callable[..., case_rows.SweepRow]

  def sources(self) -> str:
    """A hash of what decides what is read in a film."""
    ...

  def made(
    self, case: sweep_cases.Sample, folder: pathlib.Path
  ) -> pathlib.Path:
    """The film of a case in a folder, made if it is not there."""
    ...


class Board(sweep_study.Sweep):
  """The cases of a board."""

  kind = 'board'
  files = (
    case_rows.JOURNAL, case_rows.PROVENANCE, case_rows.SUMMARY,
    archive.PAGE, FILE, PICTURES, FILMS,
  )  # fmt: skip

  def __init__(
    self,
    cases: Sequence[sweep_cases.Sample],
    films: Films,
    tell: Callable[[Sequence[sweep_cases.Sample]], None],
  ) -> None:
    """Makes a study of `board_cases.cases`.

    Args:
      cases: The cases.
      films: What makes and reads films.
      tell: Told which of them are to be flown, before the first is.
    """
    super().__init__(cases, cases[0].receiver)
    self._films, self._tell = films, tell

  def rank(self, case: sweep_cases.Sample) -> float:
    """The longest first, to end together."""
    return -case.scene.episode_s * case.scene.observers

  def beside(self, case: sweep_cases.Sample) -> str:
    """Which film is read, and by what."""
    if not _is_film(case):
      return ''
    return f' film {case.cell[board_cases.SCENE]} {self._films.sources()}'

  def known(
    self, folder: pathlib.Path, identities: Mapping[str, str]
  ) -> dict[str, case_rows.SweepRow]:
    """See `sweep_study.Sweep`; tells what is missing."""
    found = super().known(folder, identities)
    self._tell([case for case in self.cases if case.name not in found])
    return found

  def job(
    self,
    case: sweep_cases.Sample,
    identity: str,
    command: str,
    folder: pathlib.Path,
  ) -> pool.Job:
    """Flies a case, or reads its film."""
    del command
    if not _is_film(case):
      return pool.Job(case.name, board_flight.fly, (case, identity))
    path = self._films.made(case, folder / FILMS)
    arguments = case, identity, path.name, path.read_bytes()
    return pool.Job(case.name, self._films.read, arguments)


def readers(names: Sequence[str]) -> dict[str, str]:
  """By receiver, a hash of its numbers and of its sources from outside.

  Raises:
    UnknownSourceError: if it has none.
  """
  out = {}
  for name in names:
    _, numbers = receivers.configured(name)
    told = {
      'numbers': numbers,
      'outside': source_files.hashes(outside.paths(name, [])),
    }
    text = json.dumps(plain.to_plain(told), sort_keys=True)
    out[name] = hashlib.sha256(text.encode()).hexdigest()
  return out


def _is_film(case: sweep_cases.Sample) -> bool:
  return case.cell[board_cases.TIER] == board_tiers.RECORDINGS
