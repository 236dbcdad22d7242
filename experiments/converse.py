"""Holds a conversation: several vehicles see, dance, answer and fly.

With --mission=ack one says something, all who see it confirm it with a short
dance, which it reads in strips of its own picture, and it says again what is
missing. With --mission=relay a chain passes a letter on, hop by hop. With
--mission=dancers several have letters at once: who wants to dance looks first.
Prints what was told to whom, and leaves a folder with conversation.json and a
page. With --times it holds several, each with a seed of its own, and prints
counts; with --loss their rules are played alone, without a picture, and every
frame is lost with that probability. Exit status 0 when all was told and nothing
wrong happened, 1 when not, 2 on bad input.
"""

from collections.abc import Iterator, Sequence
import contextlib
import pathlib
import sys

from absl import flags
import tqdm

from waggle_tasks import conversation, errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import conversation_flags
from waggle_tasks.experiments.pages import document, talk_page
from waggle_tasks.experiments.record import folders, talk
from waggle_tasks.experiments.results import talk_tables
from waggle_tasks.protocol import checks

conversation_flags.define()
_OUTPUT = flags.DEFINE_string(
  'output', None, 'Folder to make; unset, the next runs/converse-N.'
)
_VIDEO = flags.DEFINE_boolean(
  'video', False, 'Whether to film what all members see, in converse.webm.'
)
_TIMES = flags.DEFINE_integer(
  'times', None, 'How often it is held, to be counted; leaves no folder.'
)
_LOSS = flags.DEFINE_float(
  'loss',
  None,
  'With --times: play rules alone, and lose this share of frames.',
)


def main(argv: Sequence[str]) -> int:
  """Holds the conversation of the flags and returns the exit status."""
  del argv
  scene = conversation_flags.read()
  if _TIMES.value is not None:
    return _count(scene, _TIMES.value)
  if _LOSS.value is not None:
    raise errors.WaggleError('`loss` must be given with `times`')
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


def _count(scene: conversation.Conversation, times: int) -> int:
  """Holds a conversation many times and prints what that came to."""
  from waggle_tasks.experiments.studies import talk_study

  for name in ('output', 'video'):
    if flags.FLAGS[name].present:
      raise errors.WaggleError(f'`{name}` must not be given beside `times`')
  times = checks.integer('times', times, 1, 10**6, errors.WaggleError)
  every = talk_study.held(scene, times, _LOSS.value)
  held = [*tqdm.tqdm(every, desc='conversations', total=times, mininterval=2)]
  print(talk_tables.counts(held))
  return 0 if all(each.passed for each in held) else 1


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
