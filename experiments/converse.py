"""Holds a conversation: several vehicles see, dance, answer and fly.

With --mission=ack one says something, all who see it confirm it with a short
dance, which it reads in strips of its own picture, and it says again what is
missing. With --mission=relay a chain passes a letter on, hop by hop. With
--mission=dancers several have letters at once: who wants to dance looks first.
Prints what was told to whom, and leaves a folder with conversation.json and a
page. Exit status 0 when all was told and nothing wrong happened, 1 when not, 2
on bad input.
"""

from collections.abc import Iterator, Sequence
import contextlib
import pathlib
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import conversation_flags
from waggle_tasks.experiments.pages import document, talk_page
from waggle_tasks.experiments.record import folders, talk
from waggle_tasks.experiments.results import talk_tables

conversation_flags.define()
_OUTPUT = flags.DEFINE_string(
  'output', None, 'Folder to make; unset, the next runs/converse-N.'
)
_VIDEO = flags.DEFINE_boolean(
  'video', False, 'Whether to film what all members see, in converse.webm.'
)


def main(argv: Sequence[str]) -> int:
  """Holds the conversation of the flags and returns the exit status."""
  del argv
  scene = conversation_flags.read()
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import talking
  from waggle_tasks.experiments.video import talk_film

  with _folder() as (draft, folder), contextlib.ExitStack() as stack:
    onlookers: tuple[talking.Onlooker, ...] = ()
    if _VIDEO.value:
      film = stack.enter_context(talk_film.TalkFilm(draft, scene))
      onlookers = (film.watch,)
    held = talking.hold(scene, onlookers)
    talk.write(draft, held)
    talk_page.save(draft, held)
  print(talk_tables.report(held))
  print(f'Folder: {folder}, page: {folder / document.NAME}')
  return 0 if held.passed else 1


@contextlib.contextmanager
def _folder() -> Iterator[tuple[pathlib.Path, pathlib.Path]]:
  """A draft of the folder of the flags, and that folder."""
  if not _OUTPUT.value:
    with folders.next_folder('converse') as pair:
      yield pair
    return
  folder = pathlib.Path(_OUTPUT.value)
  with folders.new_folder(folder) as draft:
    yield draft, folder


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
