"""What all pages share: their frame, their style and how they are saved."""

from collections.abc import Mapping, Sequence
import functools
import json
import pathlib
from typing import Any

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.pages import markup
from waggle_tasks.experiments.record import archive

NAME = archive.PAGE

tag = markup.tag


def page(
  title: str,
  body: Sequence[markup.Content],
  facts: Mapping[str, Any] | None = None,
) -> markup.Markup:
  """A whole page with its style, and what its script needs to know."""
  script = None
  if facts is not None:
    # A closing tag inside of a script would end it.
    data = json.dumps(facts).replace('</', '<\\/')
    script = tag(
      'script', markup.Markup(f'const RUN = {data};\n{_file("run.js")}')
    )
  whole = tag(
    'html',
    tag(
      'head',
      tag('meta', charset='utf-8'),
      tag('meta', name='viewport', content='width=device-width'),
      tag('title', title),
      tag('style', markup.Markup(_file('style.css'))),
    ),
    tag('body', tag('main', *body), script),
    lang='en',
  )
  return markup.Markup(f'<!doctype html>\n{whole}\n')


@functools.cache
def _file(name: str) -> str:
  return pathlib.Path(__file__).with_name(name).read_text(encoding='utf-8')


def chip(good: bool, *words: markup.Content) -> markup.Markup:
  """A verdict: a word and a sign, not only a colour."""
  sign = '\u2713 ' if good else '\u2717 '
  return tag('span', sign, *words, class_=f'chip {"good" if good else "bad"}')


def save(folder: pathlib.Path, whole: markup.Markup) -> pathlib.Path:
  """Replaces a folder's page as a whole and returns its path."""
  return files.replace(folder / NAME, whole)
