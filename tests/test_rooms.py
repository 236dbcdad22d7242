"""The picture of the rooms."""

import re

import pytest

from waggle_tasks.experiments.pages import rooms


@pytest.mark.slow
def test_the_picture_has_every_room_and_nothing_runs_up() -> None:
  found = rooms.counts()
  assert {name for pair in found for name in pair} == {*rooms.ROOMS}
  floor = rooms.ROOMS.index
  assert [pair for pair in found if floor(pair[0]) < floor(pair[1])] == []
  words = re.findall(r'>([a-z_0-9]+)</text>', rooms.draw(found))
  assert [word for word in words if not word.isdigit()][::2] == [*rooms.ROOMS]
