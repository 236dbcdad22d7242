"""The incremental camera shows what a full render shows."""

import numpy as np
import pytest
import sameness

from waggle_tasks.entities import renderer


@pytest.fixture(scope='module')
def honest() -> list[sameness.Comparison]:
  return list(sameness.compare(scenes=2, seed=2))


def test_incremental_pictures_are_those_of_a_full_render(
  honest: list[sameness.Comparison],
) -> None:
  assert len(honest) == 20 + 2 * 20  # The second scene has two cameras.
  assert sameness.worst_levels(honest) <= sameness.MAX_LEVELS
  text = sameness.report(honest)
  assert 'grey levels at most in 60 pictures:\nthe same, 1 is allowed' in text


def test_the_check_changes_scenes_in_many_ways(
  honest: list[sameness.Comparison],
) -> None:
  changes = {change.__name__ for change in sameness.CHANGES}
  assert len({each.change for each in honest} & changes) >= 5


class Forgetful(renderer.Renderer):
  """Does not look again at a band of the picture."""

  band: np.ndarray | None = None

  def image(self, camera_id: int, incremental: bool = True) -> np.ndarray:
    picture = super().image(camera_id, incremental).copy()
    if self.band is None:
      self.band = picture[200:280].copy()
    picture[200:280] = self.band
    return picture


def test_the_check_finds_a_part_that_was_forgotten() -> None:
  found = list(sameness.compare(1, seed=3, incremental=Forgetful))
  assert sameness.worst_levels(found) > 20
  text = sameness.report(found)
  assert 'NOT the same' in text
  assert 'vehicles' in text


def test_a_difference_is_its_largest_level_and_its_number_of_pixels() -> None:
  one = np.zeros((4, 5, 3), np.uint8)
  other = one.copy()
  other[0, 0] = 3, 0, 9
  other[2, 1, 1] = 1
  assert sameness.Difference.of(one, other) == sameness.Difference(9, 2)
  assert sameness.Difference.of(other, one) == sameness.Difference(9, 2)
  assert sameness.Difference.of(one, one) == sameness.Difference(0, 0)
