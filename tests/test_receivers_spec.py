"""A receiver by name, and by name with some of its numbers changed."""

from collections.abc import Callable
import dataclasses
import re

import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.agents import (
  config,
  group,
  joint_config,
  joint_description,
  receiver,
  receivers,
)
from waggle_tasks.protocol import agreement, camera, gestures

AGREED = agreement.Agreement()


def numbers(value: config.Config) -> dict[str, float]:
  """Every number of a configuration, by its name alone."""
  return {
    name: number
    for group in dataclasses.asdict(value).values()
    if group is not None
    for name, number in group.items()
  }


def test_no_two_groups_have_a_number_of_the_same_name() -> None:
  groups = dataclasses.asdict(config.Config()).values()
  assert len(numbers(config.Config())) == sum(len(g or ()) for g in groups)


def test_no_changes_leave_the_papers_receiver() -> None:
  assert receivers.configure('') == config.Config()


@pytest.mark.parametrize(
  ('text', 'changes'),
  [
    ('corner_quality=0.1', {'corner_quality': 0.1}),
    ('max_corners=25', {'max_corners': 25}),
    ('max_rmse=0.2,hold_s=2.5', {'max_rmse': 0.2, 'hold_s': 2.5}),
    ('forward_backward_px=5e-1', {'forward_backward_px': 0.5}),
    ('off_s=1,on_px_s=4,levels=3', {'off_s': 1.0, 'on_px_s': 4.0, 'levels': 3}),
  ],
)
def test_only_the_named_numbers_change(
  text: str, changes: dict[str, float]
) -> None:
  found = numbers(receivers.configure(text))
  assert found == numbers(config.Config()) | changes
  for name, value in changes.items():
    assert type(found[name]) is type(value)


@pytest.mark.parametrize('name', numbers(config.Config()))
def test_every_number_can_be_written_and_read_back(name: str) -> None:
  value = numbers(config.Config())[name]
  if isinstance(value, bool):
    value = {True: 'on', False: 'off'}[value]
  assert receivers.configure(f'{name}={value}') == config.Config()


@pytest.mark.parametrize(
  ('name', 'error'),
  [
    ('', "`receiver` must be one of .*: got ''"),
    ('ktl', "`receiver` must be one of .*: got 'ktl'. Did you mean klt"),
    ('KLT', "`receiver` must be one of .*: got 'KLT'"),
    ('klt:corner_qualty=1', "got 'corner_qualty'. Did you mean corner_quality"),
    ('klt:tracking=1', "must be one of .*'max_rmse'.*: got 'tracking'"),
    ('klt:=1', "got ''"),
    ('klt:max_rmse=0.2,', "got ''"),
    ('klt: max_rmse=0.2', "got ' max_rmse'. Did you mean max_rmse"),
    ('klt:max_rmse', "`max_rmse` must be of type float: got ''"),
    ('klt:max_rmse=', "`max_rmse` must be of type float: got ''"),
    ('klt:max_rmse=x', "`max_rmse` must be of type float: got 'x'"),
    ('klt:max_rmse=0.1=0.2', "`max_rmse` must be .*: got '0.1=0.2'"),
    ('klt:max_corners=2.5', "`max_corners` must be of type int: got '2.5'"),
    ('klt:separators=no', "`separators` must be one of .*: got 'no'"),
    ('klt:final_null', "`final_null` must be one of .*: got ''"),
    ('klt:forward_backward=0', '`forward_backward` must be one of'),
    ('absolute:forward_backward=off', "got 'forward_backward'"),
    ('klt:max_rmse=nan', '`max_rmse` must be a finite number: got nan'),
    ('klt:max_rmse=inf', '`max_rmse` must be a finite number: got inf'),
    ('klt:max_rmse=-0.1', '`max_rmse` must be between .*: got -0.1'),
    ('klt:levels=-1', '`levels` must be between .*: got -1'),
    # Numbers that the tracker itself cannot take.
    ('klt:corner_quality=0', '`corner_quality` must be .*: got 0'),
    ('klt:max_corners=0', '`max_corners` must be .*: got 0'),
  ],
)
def test_a_receiver_that_does_not_exist_is_refused(
  name: str, error: str
) -> None:
  with pytest.raises(receivers.ReceiverError) as caught:
    receivers.make(name)
  assert re.search(error, str(caught.value))


@pytest.mark.parametrize(
  ('name', 'null_s'),
  [('klt', 3.0), ('klt:hold_s=1', 1.0), ('klt:min_support=1000', None)],
)
def test_a_changed_number_is_the_one_that_reads(
  load: Callable[..., registry.composer.Environment],
  name: str,
  null_s: float | None,
) -> None:
  (seen,) = load(observers=1).reset().observation
  reader = receivers.make(name)
  times_s = np.arange(80) * AGREED.frame_s
  events = [
    event for time_s in times_s for event in reader.step(seen['camera'], time_s)
  ]
  assert [event.symbol for event in events] == ['NULL'] * (null_s is not None)
  if events:
    assert events[0].time_s == pytest.approx(null_s, abs=0.09)


# What was once flown, or is close to what makes sense; with the limit's name.
REFUSED = (
  'angles=0', 'angles=1', 'angles=-3', 'distances=0', 'max_angle_deg=181',
  'max_angle_deg=nan', 'min_distance_m=0', 'min_distance_m=5',
  'max_distance_m=-1', 'learn_s=nan', 'learn_s=0', 'watch_px=0',
  'min_contrast=256', 'min_levels=0', 'noise_levels=-1', 'box_px=0',
  'box_sigmas=-1', 'slack_px=-1', 'speed_s=0', 'gate_widths=-0.1',
  'gate_px=inf', 'lost_share=1.1', 'most_share=0.5', 'separate_s=-1',
  'relearn_s=nan', 'max_gap_s=-1', 'radius_widths=nan', 'radius_px=-2',
  'on_s=-1', 'lead_s=0', 'off_s=nan', 'jump_s=-1', 'stay_s=-1',
  'outside_s=-inf', 'null_quality=2', 'in_sight_s=nan',
)  # fmt: skip


@pytest.mark.parametrize('change', REFUSED)
def test_numbers_that_cannot_work_are_refused(change: str) -> None:
  name, _, value = change.partition('=')
  rule = f'^`{name}` must be .*: got {value}'
  with pytest.raises(receivers.ReceiverError, match=rule):
    receivers.configured(f'view_bank:{change}')


def test_limits_are_changed_together() -> None:
  _, found = receivers.configured('view_bank:min_distance_m=5,max_distance_m=6')
  assert (found.views.min_distance_m, found.views.max_distance_m) == (5.0, 6.0)


@pytest.mark.parametrize('change', ['angles=2', 'distances=1,angles=181',
                                    'max_angle_deg=180,min_distance_m=0.2',
                                    'max_angle_deg=0'])  # fmt: skip
def test_views_within_their_limits_can_be_made(change: str) -> None:
  large = agreement.Agreement(codebook=gestures.v_codebook(1.2, 2.0, 60.0))
  reader = receivers.make(f'view_bank:{change}', large)
  told = receivers.describe(f'view_bank:{change}', large)
  assert np.isfinite(told.templates().paths).all()
  assert reader.step(np.zeros((480, 640, 3), np.uint8), 0.0) == ()


@pytest.mark.parametrize('name', receivers.RECEIVERS)
@pytest.mark.parametrize('focal_px', [1.0, 30.0, 3000.0])
def test_no_camera_makes_a_number_that_is_refused(
  name: str, focal_px: float
) -> None:
  seen = camera.Camera(focal_px=focal_px)
  receivers.make(name, agreement.Agreement(camera=seen))


def test_a_camera_that_shows_no_gesture_is_refused_by_banks_of_views() -> None:
  seen = agreement.Agreement(camera=camera.Camera(focal_px=1e5))
  for name in ('klt', 'absolute'):
    receivers.make(name, seen)
  error = r'`focal_px` must be so short that START is in the picture .* 100000'
  for name in ('klt_bank', 'view_bank'):
    with pytest.raises(receivers.ReceiverError, match=error):
      receivers.make(name, seen)


def test_a_window_is_as_small_as_it_was_asked_for() -> None:
  small = config.Tracking(window_px=3)
  assert group.zoomed(small, 1.0) == small
  assert group.zoomed(small, 0.1) == dataclasses.replace(
    group.zoomed(config.Tracking(), 0.1), window_px=3
  )


@pytest.mark.parametrize(
  ('parts', 'error'),
  [
    ({'tracking': 3}, '`tracking` must be a Tracking or Differencing: got 3'),
    ({'views': ()}, r'`views` must be a Views or None: got \(\)'),
    ({'framing': None}, '`framing` must be a Rules: got None'),
    ({'motion': config.Excursion()}, '`motion` must be an Excursion with Diff'),
    ({'tracking': config.Differencing()}, '`motion` must be .*: got Motion'),
  ],
)
def test_parts_that_do_not_go_together_are_refused(
  parts: dict[str, object], error: str
) -> None:
  with pytest.raises(receivers.ReceiverError, match=error):
    receiver.KltReceiver(config=config.Config(**parts))


def test_what_joint_asks_of_a_frame_is_told_in_words() -> None:
  asked = joint_config.Config()
  clear = f'clear by {asked.reading.min_clear:g}'
  swift = scenario.Scenario(language='swift').agreement
  told = ' '.join(joint_description.of(swift, asked).frames)
  assert clear in told
  assert 'from any side' in told
  assert 'from the hover point' in told
  brisk = scenario.Scenario(language='brisk').agreement
  told = ' '.join(joint_description.of(brisk, asked).frames)
  assert f'up to {asked.reading.max_angle_deg:g} degrees' in told
  assert 'from the hover point' not in told
