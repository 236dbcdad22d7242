"""The codebook refuses what cannot be flown or told apart; the normal form."""

from collections.abc import Callable
import itertools
import math
import random as random_lib

import hypothesis
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst
import numpy as np
import pytest

from waggle_tasks.protocol import gestures
from waggle_tasks.protocol.symbols import MOTIONS, Symbol

HOVER = (0.0, 0.0)
UP = (HOVER, (0.0, 0.6), HOVER)
VEE = (HOVER, (-0.3, 0.3), HOVER, (0.3, 0.3), HOVER)
INVERTED = (HOVER, (-0.3, -0.3), HOVER, (0.3, -0.3), HOVER)
ACROSS = (HOVER, (-0.3, 0.0), (0.3, 0.0), HOVER)
PATHS = {
  Symbol.START: UP,
  Symbol.ZERO: VEE,
  Symbol.ONE: INVERTED,
  Symbol.END: ACROSS,
}


def codebook(**changes: tuple[tuple[float, float], ...]) -> gestures.Codebook:
  """The alphabet with some paths changed, by the name of their symbol."""
  paths = PATHS | {Symbol[name]: path for name, path in changes.items()}
  return gestures.Codebook(
    tuple(gestures.Gesture(symbol, path, 5.0) for symbol, path in paths.items())
  )


def test_the_alphabet_has_the_shapes_of_the_papers_table() -> None:
  book = gestures.v_codebook()
  paths = {symbol: np.array(book[symbol].corners_m).T for symbol in MOTIONS}
  x, z = paths[Symbol.START]
  assert (x == 0).all()  # Vertical, back and forth.
  assert np.ptp(z) > 0
  x, z = paths[Symbol.END]
  assert (z == 0).all()  # Horizontal, back and forth.
  assert x.min() < 0 < x.max()
  x, z = paths[Symbol.ZERO]
  assert sorted(zip(x, z, strict=True))[0][1] > 0  # A V: its arms point up.
  assert z.min() == 0
  np.testing.assert_array_equal(paths[Symbol.ONE], (x, -z))  # Inverted.


def test_an_image_has_x_to_the_right_and_y_down() -> None:
  gesture = gestures.Gesture(Symbol.ZERO, VEE, 5.0)
  expected = [(0, 0), (-0.3, -0.3), (0, 0), (0.3, -0.3), (0, 0)]
  np.testing.assert_allclose(gesture.image_path(), expected)


def test_legs_share_the_time_of_a_gesture() -> None:
  gesture = gestures.Gesture(Symbol.ZERO, VEE, 5.0)
  assert (len(gesture), gesture.leg_s) == (5, 1.25)


@pytest.mark.parametrize('symbol', MOTIONS)
def test_a_codebook_looks_gestures_up_in_any_order(symbol: Symbol) -> None:
  book = gestures.Codebook(codebook().gestures[::-1])
  assert book[symbol].corners_m == PATHS[symbol]


@pytest.mark.parametrize('symbol', [Symbol.NULL, Symbol.UNKNOWN])
def test_only_motions_can_be_looked_up(symbol: Symbol) -> None:
  error = f'`symbol` must be one of .* got {symbol}'
  with pytest.raises(gestures.CodebookError, match=error):
    codebook()[symbol]


def test_a_gesture_named_by_its_text_is_that_gesture_or_refused() -> None:
  try:
    named = [
      gestures.Gesture(str(symbol), path, 5.0) for symbol, path in PATHS.items()
    ]
  except gestures.CodebookError:
    return
  book = gestures.Codebook(tuple(named))
  assert [book[symbol].corners_m for symbol in MOTIONS] == [*PATHS.values()]


@pytest.mark.parametrize(
  ('make', 'error'),
  [
    (
      lambda: gestures.Codebook(codebook().gestures[:3]),
      "`gestures` must hold each of .* once: got .*'0'.*'1'.*'START'",
    ),
    (lambda: gestures.Codebook(()), r'must hold each of .* once: got \[\]'),
    (
      lambda: gestures.Codebook((*codebook().gestures, codebook().gestures[0])),
      '`gestures` must hold each of .* once',
    ),
    (
      lambda: codebook(ONE=VEE),
      '`gestures` must differ: 0 and 1 have normalised paths 0.000 apart',
    ),
    (
      lambda: codebook(ONE=tuple((x / 2, z / 2) for x, z in VEE)),
      '`gestures` must differ: 0 and 1 .* 0.000 apart, under 0.15',
    ),
    (
      lambda: codebook(END=(HOVER, (0.02, 0.6), HOVER)),
      '`gestures` must differ: START and END',
    ),
    (
      lambda: codebook(START=(HOVER, (0.0, 0.6), (0.0, 0.1))),
      r'`gesture START corners_m` must begin and end at \(0, 0\): got .*0.1\)',
    ),
    (
      lambda: codebook(START=((0.1, 0.0), (0.0, 0.6), HOVER)),
      r'`gesture START corners_m` must begin and end at \(0, 0\)',
    ),
    (
      lambda: codebook(ZERO=(HOVER, (math.nan, 0.3), HOVER)),
      '`gesture 0 corners_m` must be a finite number: got nan',
    ),
    (
      lambda: codebook(ZERO=(HOVER, (0.0, -math.inf), HOVER)),
      '`gesture 0 corners_m` must be a finite number: got -inf',
    ),
    (
      lambda: codebook(ZERO=(HOVER, (0.0, 'up'), HOVER)),
      "`gesture 0 corners_m` must be a finite number: got 'up'",
    ),
    (
      lambda: codebook(ONE=(HOVER, (0.0, -1.3), HOVER)),  # Into the floor.
      '`gesture 1 corners_m` must be between -1.2 and 2: got -1.3',
    ),
    (
      lambda: codebook(END=(HOVER, HOVER)),
      '`gesture END corners_m` must have at least 3 corners: got 2',
    ),
    (
      lambda: codebook(END=(HOVER, (0.3, 0.0), (0.3, 0.0), HOVER)),
      '`gesture END corners_m` must not rest on one corner',
    ),
    (
      lambda: gestures.Gesture(Symbol.NULL, UP, 5.0),
      '`symbol` must be one of .* got <Symbol.NULL',
    ),
    (
      lambda: gestures.Gesture('STRAT', UP, 5.0),
      "`symbol` must be one of .* got 'STRAT'. Did you mean START",
    ),
    (
      lambda: gestures.Gesture(Symbol.END, UP, math.nan),
      '`gesture END duration_s` must be a finite number: got nan',
    ),
    (
      lambda: gestures.Gesture(Symbol.END, UP, 0.0),
      '`gesture END duration_s` must be between 0.1 and 60: got 0.0',
    ),
    (
      lambda: gestures.v_codebook(half_width_m=math.nan),
      'half_width_m` must be a finite number: got nan',
    ),
    (
      lambda: gestures.v_codebook(half_width_m=0.0),
      'half_width_m` must be between',
    ),
    (
      lambda: gestures.v_codebook(duration_s=-1.0),
      'duration_s` must be between 0.1 and 60: got -1.0',
    ),
  ],
)
def test_a_codebook_that_cannot_work_is_refused(
  make: Callable[[], object], error: str
) -> None:
  with pytest.raises(gestures.CodebookError, match=error):
    make()


# Corners are tens of pixels apart, as in an image, and not all on one spot.
COORDINATES = st.floats(-300, 300, width=16)
PATHS_PX = npst.arrays(
  np.float64, st.tuples(st.integers(2, 12), st.just(2)), elements=COORDINATES
).filter(lambda path: np.ptp(path, axis=0).max() > 10)


@hypothesis.given(PATHS_PX)
def test_a_normal_form_begins_at_the_origin_and_spans_one(
  path: np.ndarray,
) -> None:
  points = gestures.normalise(path)
  assert points.shape == (80, 2)  # Paper, section 'RGB optical flow'.
  np.testing.assert_allclose(points[0], 0, atol=1e-12)
  assert np.ptp(points, axis=0).max() == pytest.approx(1)


@hypothesis.given(
  PATHS_PX, st.floats(0.01, 100), st.tuples(COORDINATES, COORDINATES)
)
def test_a_normal_form_forgets_scale_and_place(
  path: np.ndarray, scale: float, shift: tuple[float, float]
) -> None:
  np.testing.assert_allclose(
    gestures.normalise(scale * path + shift),
    gestures.normalise(path),
    atol=1e-6,
  )


@hypothesis.given(PATHS_PX, st.integers(1, 7), st.randoms())
def test_a_normal_form_forgets_how_a_path_was_sampled(
  path: np.ndarray, extra: int, random: random_lib.Random
) -> None:
  dense = [path[0]]
  for begin, end in itertools.pairwise(path):
    shares = sorted(random.random() for _ in range(extra))
    dense += [begin + share * (end - begin) for share in shares] + [end]
  np.testing.assert_allclose(
    gestures.normalise(np.array(dense)), gestures.normalise(path), atol=1e-6
  )


@pytest.mark.parametrize('symbol', MOTIONS)
def test_a_normal_form_remembers_rotation(symbol: Symbol) -> None:
  path = gestures.v_codebook()[symbol].image_path()
  upright = gestures.normalise(path)
  for turned in (path @ [[0, 1], [-1, 0]], -path, path @ [[0, -1], [1, 0]]):
    apart = gestures.separation(upright, gestures.normalise(turned))
    assert apart > 0.17


def test_a_resampled_path_has_equal_steps() -> None:
  points = gestures.resample(np.array([(0.0, 0.0), (6.0, 0.0), (6.0, 2.0)]), 5)
  expected = [(0, 0), (2, 0), (4, 0), (6, 0), (6, 2)]
  np.testing.assert_allclose(points, expected)


def test_a_path_without_length_stays_where_it_is() -> None:
  points = gestures.resample(np.full((3, 2), 7.0), 4)
  np.testing.assert_array_equal(points, np.full((4, 2), 7.0))


def test_separation_is_the_root_mean_square_distance() -> None:
  a, b = np.zeros((4, 2)), np.array([(3.0, 4.0), (0, 0), (0, 0), (0, 0)])
  assert gestures.separation(a, b) == pytest.approx(2.5)
  assert gestures.separation(b, a) == pytest.approx(2.5)
  assert gestures.separation(b, b) == 0
