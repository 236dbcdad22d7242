"""What a camera's sensor makes of light is what its numbers say."""

import math

import cv2
import numpy as np
import pytest

from waggle_tasks import errors, eyes
from waggle_tasks.entities import codecs, sensors
from waggle_tasks.protocol import camera as camera_lib

CAMERA = camera_lib.Camera.of(64, 48, 60.0)
FRAME_S = 0.04


def make(eye: eyes.Eye, seed: int = 0) -> sensors.Sensor:
  return sensors.Sensor(eye, CAMERA, FRAME_S, np.random.RandomState(seed))


def flat(*level: int) -> np.ndarray:
  return np.full(CAMERA.shape, level, np.uint8)


def test_light_falls_with_the_fourth_power_of_the_cosine() -> None:
  seen = make(eyes.Eye(vignette=1.0)).picture(flat(200))[..., 0]
  rows, columns = np.indices(seen.shape) + 0.5
  off = np.hypot(columns - 32, rows - 24) / CAMERA.focal_px
  expected = 200 * np.cos(np.arctan(off)) ** 4
  assert np.abs(seen - expected).max() <= 1.5
  half = make(eyes.Eye(vignette=0.5)).picture(flat(200))[..., 0]
  assert np.abs(half - (200 + expected) / 2).max() <= 1.5


def test_a_point_out_of_focus_is_as_wide_as_its_blur() -> None:
  light = flat(0)
  light[20:29, 28:37] = 240
  seen = make(eyes.Eye(defocus_px=3.0)).picture(light)[..., 0].astype(float)
  columns = np.arange(64)
  row = seen.sum(axis=0)
  off = columns - (row @ columns) / row.sum()
  spread = (row @ off**2) / row.sum()
  assert spread == pytest.approx(3.0**2 + (9**2 - 1) / 12, rel=0.05)


def test_a_camera_without_colours_shows_luma() -> None:
  seen = make(eyes.Eye(grey=True)).picture(flat(200, 100, 50))
  luma = 0.299 * 200 + 0.587 * 100 + 0.114 * 50  # ITU-R BT.601.
  assert np.abs(seen - luma).max() <= 1
  assert (seen == seen[..., :1]).all()


def test_a_mosaic_keeps_flat_colours_and_loses_a_single_pixel_s() -> None:
  sensor = make(eyes.Eye(mosaic=True))
  np.testing.assert_array_equal(
    sensor.picture(flat(200, 100, 50)), flat(200, 100, 50)
  )
  light = flat(0)
  light[20, 30] = 0, 240, 0  # Where the mosaic has red.
  np.testing.assert_array_equal(sensor.picture(light), 0)
  light = flat(0)
  light[20, 30] = 240, 0, 0
  seen = sensor.picture(light)
  assert seen[20, 30, 0] == 240
  assert seen[20, 31, 0] == 120  # The mean of two neighbours.
  assert seen[21, 31, 0] == 60  # That of four.
  assert not seen[..., 1:].any()


@pytest.mark.parametrize('level', [40, 200])
def test_noise_is_that_of_reading_and_of_counting_electrons(level: int) -> None:
  eye = eyes.Eye(grey=True, read_noise=2.0, well_electrons=1000.0)
  sensor = make(eye)
  seen = np.stack([sensor.picture(flat(level))[..., 0] for _ in range(20)])
  expected = 2.0**2 + 255 * level / 1000 + 1 / 12
  assert seen.astype(float).var() == pytest.approx(expected, rel=0.1)
  assert seen.mean() == pytest.approx(level, abs=0.3)


def test_hot_pixels_are_white_and_stay_where_they_are() -> None:
  sensor = make(eyes.Eye(grey=True, hot_share=0.01))
  first, second = (sensor.picture(flat(10))[..., 0] for _ in range(2))
  np.testing.assert_array_equal(first, second)
  hot = (first == 255).sum()
  assert 10 < hot < 60
  assert ((first == 255) | (first == 10)).all()
  other = make(eyes.Eye(grey=True, hot_share=0.01), seed=1).picture(flat(10))
  assert (other[..., 0] != first).any()


def test_an_analogue_line_is_blurred_along_itself() -> None:
  light = flat(0)
  light[:, 32] = 200
  light[24] = 0
  seen = make(eyes.Eye(line_px=1.0)).picture(light)[..., 0].astype(float)
  assert not seen[24].any()
  columns = np.arange(64)
  spread = seen[10] @ (columns - 32) ** 2 / seen[10].sum()
  assert spread == pytest.approx(1.0, rel=0.1)


def brightness(eye: eyes.Eye, levels: list[int]) -> np.ndarray:
  """The picture's level in each frame, of light of some levels."""
  sensor, out = make(eye), []
  for level in levels:
    light = flat(level)
    cv2.convertScaleAbs(light, dst=light, alpha=sensor.gain)
    out.append(sensor.picture(light).mean())
  return np.array(out)


def test_exposure_follows_a_step_of_light_with_its_lag() -> None:
  lag_s = 0.4
  levels = [100] * 5 + [50] * 60
  seen = brightness(eyes.Eye(exposure_lag_s=lag_s), levels)
  assert (seen[:5] == 100).all()  # It has settled.
  after_s = np.arange(25) * FRAME_S
  expected = 100 * 0.5 ** np.exp(-after_s / lag_s)
  np.testing.assert_allclose(seen[5:30], expected, atol=1.5)
  assert seen[-1] == pytest.approx(100, abs=2.5)  # Within its band.


def test_a_fixed_exposure_follows_nothing() -> None:
  assert [*brightness(eyes.Eye(vignette=0.0), [100, 50, 50])] == [100, 50, 50]


def test_white_balance_follows_a_lamp_of_another_colour_with_its_lag() -> None:
  sensor = make(eyes.Eye(balance_lag_s=0.4))
  sensor.picture(flat(100, 100, 100))
  seen = np.array(
    [sensor.picture(flat(100, 100, 60)).mean(axis=(0, 1)) for _ in range(60)]
  )
  after_s = np.arange(20) * FRAME_S
  expected = 100 * 0.6 ** np.exp(-after_s / 0.4)
  np.testing.assert_allclose(seen[:20, 2], expected, atol=2)
  assert (seen[:, :2] == 100).all()


def _scene() -> np.ndarray:
  shape = (120, 160)
  x = np.arange(160) * np.ones((120, 1))
  light = np.stack([x, 255 - x, np.full(shape, 90)], axis=-1)
  light[40:80, 60:100] = 230, 40, 40
  return light.astype(np.uint8)


@pytest.mark.parametrize(
  ('fine', 'coarse'),
  [
    ({'codec': 'jpeg', 'jpeg_quality': 95}, {'jpeg_quality': 5}),
    ({'codec': 'h264', 'h264_crf': 10}, {'h264_crf': 50}),
  ],
)
def test_coded_pictures_are_near_those_that_were_sent(
  fine: dict[str, object], coarse: dict[str, object]
) -> None:
  if fine['codec'] == 'h264':
    pytest.importorskip('av')
  light, seen_with = _scene(), camera_lib.Camera.of(160, 120, 60.0)
  errors_ = []
  for eye in (eyes.Eye(**fine), eyes.Eye(**{**fine, **coarse})):
    codec = codecs.make(eye, seen_with)
    for step in range(3):  # None of them is late.
      sent = np.roll(light, 8 * step, axis=1)
      come = codec.picture(sent)
      off = np.abs(come.astype(float) - sent)
    errors_.append(off.mean())
  assert errors_[0] < min(2.5, errors_[1] / 2)


def test_a_coded_stream_is_the_same_each_time() -> None:
  pytest.importorskip('av')
  light, seen_with = _scene(), camera_lib.Camera.of(160, 120, 60.0)
  streams = []
  for _ in range(2):
    codec = codecs.make(eyes.Eye(codec='h264'), seen_with)
    streams.append([codec.picture(np.roll(light, n, 1)) for n in range(4)])
  np.testing.assert_array_equal(*streams)


def test_h264_without_pyav_says_what_to_install(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setitem(__import__('sys').modules, 'av', None)
  with pytest.raises(errors.WaggleError, match=r"`codec` 'h264'.*\[video\]"):
    codecs.make(eyes.Eye(codec='h264'), CAMERA)


def test_h264_refuses_an_odd_side() -> None:
  pytest.importorskip('av')
  odd = camera_lib.Camera.of(65, 48, 60.0)
  with pytest.raises(errors.WaggleError, match=r'even width and height.*65'):
    codecs.make(eyes.Eye(codec='h264'), odd)


def test_a_control_reaches_only_so_far() -> None:
  control = sensors.Control(0.04, FRAME_S)
  control.see(np.array(100.0))
  for _ in range(200):
    control.see(np.array(1.0))
  assert float(control.gain) == pytest.approx(8.0)
  assert math.isfinite(float(control.gain))
