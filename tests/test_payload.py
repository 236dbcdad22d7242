"""The bits of a payload and the displacement that they command."""

from collections.abc import Callable
import dataclasses
import math

import numpy as np
import pytest

from waggle_tasks.protocol import payload

ALL = range(64)
# World x and y of a unit step in each heading, counterclockwise from +Y.
COMPASS = [(0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0), (1, 1)]


@pytest.mark.parametrize(
  ('bits', 'displacement_m'),
  [
    # The four examples of the paper, section 'Per-observer navigation'.
    ('000010', (0, 0.4, 0)),
    ('000110', (-0.283, 0.283, 0)),
    ('001010', (-0.4, 0, 0)),
    ('100010', (0, -0.4, 0)),
  ],
)
def test_the_papers_payloads_command_the_papers_displacements(
  bits: str, displacement_m: tuple[float, float, float]
) -> None:
  got = payload.Payload.from_bits(bits).displacement_m()
  np.testing.assert_allclose(got, displacement_m, atol=2e-4)


FINE = payload.Units(math.tau / 64, 0.02, heading_bits=6, distance_bits=5)


@pytest.mark.parametrize('bits', ['0' * 12, '110100110101', '1' * 12])
def test_a_payload_may_have_finer_fields(bits: str) -> None:
  message = payload.Payload.from_bits(bits, FINE)
  assert message.bits == bits
  assert payload.Payload.from_int(int(bits, 2), FINE) == message
  away_m = message.displacement_m(FINE)
  reach_m, turn_rad = 0.02 * int(bits[7:], 2), math.tau * int(bits[1:7], 2) / 64
  back = -1 if bits[0] == '1' else 1
  ahead = np.array([-math.sin(turn_rad), math.cos(turn_rad), 0])
  np.testing.assert_allclose(away_m, back * reach_m * ahead, atol=1e-9)
  assert np.linalg.norm(away_m) <= FINE.reach_m + 1e-9


def test_bits_of_another_number_are_refused_with_the_agreed_number() -> None:
  error = "`payload` must be 12 characters of 0 and 1, such as '000000000010'"
  with pytest.raises(payload.PayloadError, match=error):
    payload.Payload.from_bits('000010', FINE)


@pytest.mark.parametrize('value', ALL)
def test_every_payload_goes_to_bits_and_integers_and_back(value: int) -> None:
  bits = f'{value:06b}'
  message = payload.Payload.from_int(value)
  assert message == payload.Payload.from_bits(bits)
  assert (message.bits, int(message)) == (bits, value)
  fields = int(bits[0]), int(bits[1:4], 2), int(bits[4:], 2)
  assert (message.direction, message.heading, message.distance) == fields
  assert message == payload.Payload(*fields)


def test_all_payloads_differ() -> None:
  assert len({payload.Payload.from_int(value) for value in ALL}) == 64


@pytest.mark.parametrize('value', ALL)
def test_a_displacement_is_its_compass_step_times_its_reach(value: int) -> None:
  message = payload.Payload.from_int(value)
  step = np.array([*COMPASS[message.heading], 0.0])
  reach_m = 0.2 * message.distance * (1 - 2 * message.direction)
  expected_m = reach_m * step / np.linalg.norm(step)
  np.testing.assert_allclose(message.displacement_m(), expected_m, atol=1e-12)


@pytest.mark.parametrize('bits', ['000000', '011100', '111100'])
def test_no_distance_is_no_displacement(bits: str) -> None:
  got = payload.Payload.from_bits(bits).displacement_m()
  np.testing.assert_array_equal(np.abs(got), np.zeros(3))


def test_other_units_are_another_value() -> None:
  units = payload.Units(heading_step_rad=math.pi / 2, distance_unit_m=0.1)
  message = payload.Payload(direction=0, heading=1, distance=3)
  np.testing.assert_allclose(
    message.displacement_m(units), (-0.3, 0, 0), atol=1e-12
  )
  assert payload.Units() == payload.Units(math.pi / 4, 0.2)


@pytest.mark.parametrize(
  'bits',
  [
    '',
    '0000',
    '0000100',
    '00002x',
    '00 010',
    '-00010',
    '\u0660' * 6,
    10,
    None,
    b'000010',
    ['0'] * 6,
  ],
)
def test_what_is_not_six_bits_is_refused(bits: object) -> None:
  with pytest.raises(payload.PayloadError) as caught:
    payload.Payload.from_bits(bits)
  rule = "`payload` must be 6 characters of 0 and 1, such as '000010': got "
  assert str(caught.value) == f'{rule}{bits!r}'


@pytest.mark.parametrize(
  ('make', 'error'),
  [
    (lambda: payload.Payload.from_int(64), 'between 0 and 63: got 64'),
    (lambda: payload.Payload.from_int(-1), 'between 0 and 63: got -1'),
    (lambda: payload.Payload.from_int(1.0), 'must be an integer: got 1.0'),
    (lambda: payload.Payload.from_int(True), 'must be an integer: got True'),
    (lambda: payload.Payload.from_int('5'), "must be an integer: got '5'"),
    (lambda: payload.Payload(2, 0, 0), '`direction` must be between 0 and 1'),
    (lambda: payload.Payload(0, 8, 0), '`heading` must be between 0 and 7'),
    (lambda: payload.Payload(0, -1, 0), '`heading` must be between 0 and 7'),
    (lambda: payload.Payload(0, 0, 4), '`distance` must be between 0 and 3'),
    (lambda: payload.Payload(0, math.nan, 0), '`heading` must be an integer'),
    (lambda: payload.Units(math.nan), '`heading_step_rad` must be a finite'),
    (lambda: payload.Units(0.0), '`heading_step_rad` must be between 0.001'),
    (lambda: payload.Units(4.0), '`heading_step_rad` must be between 0.001'),
    (lambda: payload.Units('1'), "`heading_step_rad` must be .* got '1'"),
    (
      lambda: payload.Units(distance_unit_m=math.inf),
      '`distance_unit_m` must be a finite number: got inf',
    ),
    (
      lambda: payload.Units(distance_unit_m=-0.2),
      '`distance_unit_m` must be between 0.001 and 1: got -0.2',
    ),
    (
      lambda: payload.Units(distance_unit_m=True),
      '`distance_unit_m` must be a finite number: got True',
    ),
  ],
)
def test_values_out_of_range_are_refused(
  make: Callable[[], object], error: str
) -> None:
  with pytest.raises(payload.PayloadError, match=error):
    make()


def test_a_payload_cannot_be_changed() -> None:
  message = payload.Payload(0, 0, 2)
  with pytest.raises(dataclasses.FrozenInstanceError):
    message.distance = 3
