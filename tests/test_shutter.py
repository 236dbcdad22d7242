"""Rows are exposed one after another, each for its time."""

from collections.abc import Iterator

from dm_control import mjcf
import numpy as np
import pytest

from waggle_tasks import eyes
from waggle_tasks.entities import lenses, renderer, shutter
from waggle_tasks.protocol import camera as camera_lib

COLUMNS, ROWS, FOCAL_PX = 160, 120, 100.0
AWAY_M, WIDE_M, SPEED_MPS = 2.0, 0.2, 4.0
SPEED_PX_S = SPEED_MPS * FOCAL_PX / AWAY_M
_ROOM = """
<mujoco>
  <option gravity="0 0 0" timestep="0.004"/>
  <visual>
    <global offwidth="640" offheight="480"/>
    <headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/>
    <map znear="0.01" zfar="100"/>
  </visual>
  <statistic extent="1" center="0 0 0"/>
  <worldbody>
    <camera name="eye" fovy="{fovy}" resolution="{columns} {rows}"/>
    <body name="bar" pos="-1 0 -2">
      <joint type="slide" axis="1 0 0"/>
      <geom type="box" size="0.1 5 0.0001" rgba="1 1 1 1" mass="1"/>
    </body>
  </worldbody>
</mujoco>
"""


class Film:
  """A white bar that moves aside before an eye, and the eye's pictures."""

  def __init__(self, eye: eyes.Eye) -> None:
    seen_with = camera_lib.Camera(
      COLUMNS, ROWS, FOCAL_PX, readout_s=eye.readout_s
    )
    text = _ROOM.format(fovy=seen_with.fovy_deg, columns=COLUMNS, rows=ROWS)
    self.physics = mjcf.Physics.from_xml_string(text)
    self._renderer = renderer.Renderer(self.physics)
    self._shutter = shutter.Shutter(
      eye, seen_with, lenses.rows_of(seen_with, eye)
    )
    self.draws = 0
    self.physics.data.qvel[:] = SPEED_MPS
    self.physics.forward()
    self._shutter.begin(self.physics)

  def step(self, count: int) -> None:
    for _ in range(count):
      self.physics.step()
      self._shutter.note(self.physics)

  def draw(self) -> shutter.Drawn:
    self.draws += 1
    return self._renderer.drawn(0)

  def picture(self) -> np.ndarray:
    """(ROWS, COLUMNS) light."""
    picture = self._shutter.expose(self.physics, self.draw)
    return picture[..., 0].astype(float)

  @property
  def bar_px(self) -> float:
    """Where the bar's middle is now."""
    place_m = -1.0 + float(self.physics.data.qpos[0])
    return COLUMNS / 2 + place_m * FOCAL_PX / AWAY_M


@pytest.fixture
def film() -> Iterator[type[Film]]:
  made = []

  def make(eye: eyes.Eye) -> Film:
    made.append(Film(eye))
    return made[-1]

  yield make
  for each in made:
    each.physics.free()


def middles(light: np.ndarray) -> np.ndarray:
  """(rows,) where the light of each row has its middle."""
  return light @ (np.arange(COLUMNS) + 0.5) / light.sum(axis=1)


def test_a_moving_bar_is_slanted_as_far_as_it_goes_in_the_readout(
  film: type[Film],
) -> None:
  made = film(eyes.Eye(readout_s=0.03))
  made.step(60)
  ago_s = 0.03 * (1 - (np.arange(ROWS) + 0.5) / ROWS)
  expected = made.bar_px - SPEED_PX_S * ago_s
  np.testing.assert_allclose(middles(made.picture()), expected, atol=0.3)


def test_a_moving_bar_is_smeared_over_its_way_in_the_exposure(
  film: type[Film],
) -> None:
  made = film(eyes.Eye(shutter_s=0.08))
  made.step(60)
  light = made.picture()
  way_px, wide_px = SPEED_PX_S * 0.08, WIDE_M * FOCAL_PX / AWAY_M
  np.testing.assert_allclose(middles(light), made.bar_px - way_px / 2, atol=0.3)
  # Light is that of the bar, and spread as the bar and its way are together,
  # and a little more, as light is blended from one sub-frame to the next.
  columns = np.arange(COLUMNS) + 0.5
  row = light[ROWS // 2] / 255
  assert row.sum() == pytest.approx(wide_px, rel=0.02)
  off = columns - middles(light)[ROWS // 2]
  spread = (row * off**2).sum() / row.sum()
  step_px = SPEED_PX_S * 0.016  # From one sub-frame to the next.
  expected = (wide_px**2 + way_px**2) / 12 + step_px**2 / 6
  assert spread == pytest.approx(expected, rel=0.05)
  lit = np.flatnonzero(row > 0.01)
  assert np.ptp(lit) + 1 == pytest.approx(wide_px + way_px, abs=2)


def test_rows_that_are_exposed_for_long_are_slanted_and_smeared(
  film: type[Film],
) -> None:
  made = film(eyes.Eye(shutter_s=0.02, readout_s=0.03))
  made.step(60)
  ago_s = 0.03 * (1 - (np.arange(ROWS) + 0.5) / ROWS) + 0.02 / 2
  expected = made.bar_px - SPEED_PX_S * ago_s
  np.testing.assert_allclose(middles(made.picture()), expected, atol=0.3)


def test_the_model_is_left_as_it_was(film: type[Film]) -> None:
  made = film(eyes.Eye(readout_s=0.03))
  made.step(50)
  before = made.physics.get_state(), made.physics.data.geom_xpos.copy()
  made.picture()
  np.testing.assert_array_equal(made.physics.get_state(), before[0])
  np.testing.assert_allclose(made.physics.data.geom_xpos, before[1], atol=1e-12)


def test_what_rests_is_drawn_once(film: type[Film]) -> None:
  made = film(eyes.Eye(readout_s=0.03, shutter_s=0.01))
  made.physics.data.qvel[:] = 0
  made.step(20)
  assert np.ptp(middles(made.picture())) == 0
  assert made.draws == 1


def test_the_first_picture_of_an_episode_is_of_what_is_there(
  film: type[Film],
) -> None:
  made = film(eyes.Eye(readout_s=0.03, shutter_s=0.01))
  np.testing.assert_allclose(middles(made.picture()), made.bar_px, atol=0.3)


def test_every_row_has_as_much_light_as_all_others() -> None:
  for shutter_s, readout_s in ((0.01, 0.03), (0.03, 0.0), (0.0, 0.02)):
    takes_s = shutter_s + readout_s
    moments_s = np.linspace(-takes_s, 0, 6)
    shares = shutter.shares(moments_s, shutter_s, readout_s, 120)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=1e-6)
    assert (shares >= -1e-6).all()
