"""Receivers without one of their parts: what each part decides."""

from collections.abc import Callable, Sequence
import itertools

import cv2
import numpy as np
import pytest

from waggle_tasks.agents import config, group, klt, receiver, receivers
from waggle_tasks.protocol import agreement, frame, payload
from waggle_tasks.protocol.symbols import Symbol

BLACK = np.zeros((480, 640, 3), np.uint8)
TRACKERS = {
  'klt': config.Tracking, 'klt_bank': config.Tracking,
  'absolute': config.Differencing, 'view_bank': config.Differencing,
}  # fmt: skip
BANKS = ('klt_bank', 'view_bank')
SWITCHES = {
  'klt': ('separators', 'final_null', 'forward_backward'),
  'absolute': ('separators', 'final_null'),
}
Outcome = frame.Message | frame.Rejection | None


def specs() -> list[tuple[str, dict[str, bool]]]:
  """Every tracker and templates with every setting of its switches."""
  out = []
  for name, tracking in TRACKERS.items():
    flow = tracking is config.Tracking
    switches = SWITCHES['klt' if flow else 'absolute']
    for values in itertools.product((True, False), repeat=len(switches)):
      out.append((name, dict(zip(switches, values, strict=True))))
  return out


def spell(name: str, switches: dict[str, bool]) -> str:
  words = [f'{key}={"on" if on else "off"}' for key, on in switches.items()]
  return f'{name}:{",".join(words)}'


@pytest.mark.parametrize(('name', 'switches'), specs())
def test_every_combination_is_a_name(
  name: str, switches: dict[str, bool]
) -> None:
  spec = spell(name, switches)
  _, found = receivers.configured(spec)
  assert isinstance(found.tracking, TRACKERS[name])
  assert (found.views is not None) == (name in BANKS)
  groups = [found.framing, found.tracking]
  for key, on in switches.items():
    (value,) = [getattr(g, key) for g in groups if hasattr(g, key)]
    assert value is on
  assert receivers.make(spec).step(BLACK, 0.0) == ()


@pytest.mark.parametrize('name', TRACKERS)
def test_switches_are_on_by_default(name: str) -> None:
  _, plain = receivers.configured(name)
  flow = TRACKERS[name] is config.Tracking
  switches = SWITCHES['klt' if flow else 'absolute']
  spec = spell(name, dict.fromkeys(switches, True))
  assert receivers.configured(spec)[1] == plain


def run(text: str, rules: frame.Rules) -> tuple[frame.Parser, list[Outcome]]:
  """What the parser makes of symbols, 'N' for NULL and 'S' for START."""
  short = {'N': 'NULL', 'S': 'START', 'E': 'END', '?': 'UNKNOWN'}
  parser, outcomes = frame.Parser(rules=rules), []
  for each in text.split():
    parser, outcome = parser.step(Symbol(short.get(each, each)))
    outcomes.append(outcome)
  return parser, outcomes


def messages(text: str, rules: frame.Rules) -> list[str]:
  _, outcomes = run(text, rules)
  return [o.payload.bits for o in outcomes if isinstance(o, frame.Message)]


WHOLE = 'N S N 0 N 1 N 1 N 0 N 1 N 0 N E N'
BARE = 'N S 0 1 1 0 1 0 E N'
FULL = frame.Rules()
NO_SEPARATORS = frame.Rules(separators=False)
NO_FINAL_NULL = frame.Rules(final_null=False)
NEITHER = frame.Rules(separators=False, final_null=False)


@pytest.mark.parametrize(
  ('text', 'readers'),
  [
    (WHOLE, {FULL, NO_SEPARATORS, NO_FINAL_NULL, NEITHER}),
    (WHOLE[:-2], {NO_FINAL_NULL, NEITHER}),
    (BARE, {NO_SEPARATORS, NEITHER}),
    (BARE[:-2], {NEITHER}),
    ('N S N 0 1 N 1 N 0 N 1 N 0 N E N', {NO_SEPARATORS, NEITHER}),
    ('N S N N 0 N 1 N 1 N 0 N N 1 N 0 N E N', {NO_SEPARATORS, NEITHER}),
    ('N S N 0 N 1 N 1 N 0 N 1 N 0 N E ? N', {NO_FINAL_NULL, NEITHER}),
    # What is demanded in any case.
    (WHOLE[2:], set()),
    (BARE[2:], set()),
    (BARE.replace('E ', ''), set()),
    (BARE.replace('S', 'E'), set()),
    ('N S 0 1 1 0 1 E N', set()),
    ('N S 0 1 1 0 1 0 1 E N', set()),
    ('N S 0 1 ? 1 0 1 0 E N', set()),
    # A START inside of a frame begins a new one.
    (f'N S 1 1 {BARE[2:]}', {NO_SEPARATORS, NEITHER}),
    # After END nothing but a null begins the next.
    (f'N S 1 1 E {BARE[2:]}', set()),
  ],
)
def test_a_switch_decides_which_nulls_are_demanded(
  text: str, readers: set[frame.Rules]
) -> None:
  for rules in (FULL, NO_SEPARATORS, NO_FINAL_NULL, NEITHER):
    wanted = ['011010'] if rules in readers else []
    assert messages(text, rules) == wanted, rules


def test_a_message_without_final_null_is_complete_with_its_end() -> None:
  parser, outcomes = run(WHOLE, NO_FINAL_NULL)
  assert isinstance(outcomes[-2], frame.Message)
  assert outcomes[-1] is None  # A null that may begin the next frame.
  assert parser.state is frame.State.START
  again = f'{WHOLE} {WHOLE[2:]}'
  assert messages(again, NO_FINAL_NULL) == ['011010'] * 2


def test_without_separators_motions_come_one_after_the_other() -> None:
  parser, outcomes = run('N S N 0 1 N', NO_SEPARATORS)
  assert outcomes == [None] * 6
  assert (parser.state, parser.bits) == (frame.State.BIT, '01')
  parser, _ = run('N S 0 1 1 0 1 0', NO_SEPARATORS)
  assert parser.state is frame.State.END


@pytest.mark.parametrize('rules', [NO_SEPARATORS, NO_FINAL_NULL, NEITHER])
@pytest.mark.parametrize('value', range(0, 64, 9))
def test_rules_outlive_a_broken_frame(rules: frame.Rules, value: int) -> None:
  bits = f'{value:06b}'
  whole = ' '.join(frame.events(payload.Payload.from_bits(bits)))
  assert messages(f'N S N ? {whole} N 1 {whole}', rules) == [bits, bits]


def test_a_switch_is_true_or_false() -> None:
  with pytest.raises(frame.FrameError, match='`separators` must be True or'):
    frame.Rules(separators='off')
  with pytest.raises(group.ReceiverError, match='`forward_backward` must be'):
    config.Tracking(forward_backward=0)


Read = Callable[[str, Sequence[np.ndarray]], list[receiver.Event]]


@pytest.fixture
def read(clip: object, short: dict[str, object]) -> Read:
  """Shows images to a receiver at the times of the rendered clip."""

  def show(name: str, images: Sequence[np.ndarray]) -> list[receiver.Event]:
    reader = receivers.make(name, agreement.Agreement(**short))
    return [
      event
      for image, time_s in zip(images, clip.times_s, strict=False)
      for event in reader.step(image, time_s)
    ]

  return show


def names(events: Sequence[receiver.Event]) -> str:
  return ' '.join(event.symbol for event in events)


@pytest.mark.parametrize('name', TRACKERS)
def test_both_trackers_work_with_both_kinds_of_templates(
  name: str, clip: object, read: Read
) -> None:
  events = read(name, clip.images)
  assert names(events) == 'NULL START NULL 0 NULL'
  (zero,) = (e.recognition for e in events if e.symbol is Symbol.ZERO)
  assert (zero.view_angle_deg is not None) == (name in BANKS)
  if name in BANKS:
    assert zero.view_angle_deg == pytest.approx(0, abs=20)
    assert zero.distance_m == pytest.approx(1.3, rel=0.15)


@pytest.mark.parametrize(
  ('name', 'state'), [('klt', 'start'), ('klt:separators=off', 'bit')]
)
def test_a_null_that_was_not_confirmed_is_forgiven_without_separators(
  name: str, state: str, clip: object, read: Read
) -> None:
  """The camera is dark for a moment in the rest between START and 0."""
  images = [*clip.images]
  for first in (175, 205):  # 7.0 and 8.2 s.
    images[first : first + 3] = [BLACK] * 3
  events = read(name, images)
  assert names(events[:3]) == 'NULL START 0'
  broken = events[2].rejection
  if state == 'bit':
    assert broken is None
    assert events[-1].state is frame.State.BIT
  else:
    assert broken.startswith('expected a separating null, got 0')
    assert events[-1].state is frame.State.START


def passing_noise() -> list[np.ndarray]:
  """A target at rest, and a grainy thing that passes in front of it."""
  rng = np.random.RandomState(3)
  blocks = np.kron(rng.randint(0, 256, (4, 12)), np.ones((6, 8)))
  rest = np.full((480, 640), 120.0)
  rest[228:252, 272:368] = blocks
  rest = cv2.GaussianBlur(rest, (0, 0), 1)
  grains = rng.randint(0, 256, (80, 40))
  images = []
  for index in range(40):
    image = rest.copy()
    image[200:280, 260 + 3 * index :][:, :40] = grains
    images.append(np.repeat(image.astype(np.uint8)[..., None], 3, axis=2))
  return images


def test_the_check_drops_features_of_what_passes_in_front() -> None:
  support = {}
  for checked in (True, False):
    # Without new features for those that are lost.
    tracking = config.Tracking(forward_backward=checked, redetect_below=1)
    tracker = klt.KltTracker(tracking)
    tracks = [
      tracker.step(image, index * 0.04)
      for index, image in enumerate(passing_noise())
    ]
    support[checked] = np.array([track.support for track in tracks[1:]])
  assert (support[True] <= support[False]).all()
  assert support[True][-1] < support[False][-1] - 5, support


@pytest.mark.parametrize(
  ('checked', 'words'),
  [(True, 'forward-backward ratio'), (False, 'support ratio')],
)
def test_a_loss_is_named_after_the_checks_there_are(
  checked: bool, words: str
) -> None:
  track = klt.Track(0.0, np.zeros(2), 0.0, 6, 0.15, False)
  reason = track.loss(config.Tracking(forward_backward=checked))
  assert reason == f'{words} 0.15 < 0.2'
