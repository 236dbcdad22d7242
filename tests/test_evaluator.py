"""Every scoring rule, broken by exactly one thing."""

from collections.abc import Callable
import dataclasses
import functools
import itertools

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import observer_agent, receiver, recogniser
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import flown as flown_lib
from waggle_tasks.experiments.record import traces as traces_lib
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.protocol import flight, frame, payload, schedule, timing
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import safety

BITS = '000010'
FORWARD_M = np.array([0.0, 0.4, 0.0])
TIMES_S = np.arange(2601) * 0.04  # To 104 s.
NULL_S = 95.6  # The final null, frame 2390.
ARRIVAL_S = NULL_S + 3.16
START, ARRIVAL = observer_agent.Deed.START, observer_agent.Deed.ARRIVAL


def symbols(bits: str) -> tuple[Symbol, ...]:
  return frame.events(payload.Payload.from_bits(bits))


def read(bits: str, null_s: float = NULL_S) -> list[receiver.Event]:
  """The 17 events of a message, its parts 5.7 s apart, END 3 s from its end."""
  out, parser = [], frame.Parser()
  for index, symbol in enumerate(symbols(bits)):
    parser, outcome = parser.step(symbol)
    message = outcome.payload if isinstance(outcome, frame.Message) else None
    time_s = null_s - 3.0 - 5.7 * (15 - index) if index < 16 else null_s
    out.append(receiver.Event(time_s, symbol, parser.state, message=message))
  return out


def deed(what: observer_agent.Deed, time_s: float) -> observer_agent.Navigation:
  place_m = (9.0, 9.0, 9.0)  # A navigator's word, which does not count.
  message = payload.Payload.from_bits(BITS)
  return observer_agent.Navigation(time_s, what, place_m, message, 1, 'ab')


def flown(
  home_m: np.ndarray, offset_m: np.ndarray, begin_s: float
) -> np.ndarray:
  plan = flight.Flight(home_m, home_m + offset_m, begin_s)
  return np.stack([plan.motion(time_s)[0] for time_s in TIMES_S])


@functools.cache
def danced(dance: schedule.Schedule) -> np.ndarray:  # (T, 3)
  """Where a performer at (0, 0, 1.3) is, in front of its audience."""
  home_m, axes = np.array([0.0, 0.0, 1.3]), schedule.axes(-np.pi / 2)[:2]
  offsets_m = np.stack([dance.motion(time_s)[0] for time_s in TIMES_S])
  return home_m + offsets_m @ axes


class Case:
  """An episode of two observers that passes; tests break it."""

  def __init__(self, **changes: object) -> None:
    self.scene = scenario.Scenario(observers=2, **changes)
    self.homes = {
      name: np.array(pose.position_m)
      for name, pose in self.scene.poses().items()
    }
    self.contacts: list[tuple[float, tuple[str, str]]] = []
    self.seen: dict[str, object] = {}  # What the rollout says of sight.
    self.events: dict[str, list[rollout_lib.Event]] = {}
    self.positions_m: dict[str, np.ndarray] = {}
    for name in self.homes:
      if name == 'performer':
        self.positions_m[name] = danced(self.scene.performance.schedule).copy()
        continue
      self.fly(name, FORWARD_M)
      self.events[name] = [*read(BITS), deed(START, NULL_S)]

  def fly(
    self, name: str, offset_m: np.ndarray, begin_s: float = NULL_S
  ) -> None:
    self.positions_m[name] = flown(self.homes[name], offset_m, begin_s)

  def wait(self, name: str) -> None:
    """Lets an observer see one null, and stay."""
    self.fly(name, 0 * FORWARD_M)
    self.events[name] = read(BITS)[:1]

  def move(
    self, name: str, begin_s: float, end_s: float, offset_m: float
  ) -> None:
    frames = slice(round(begin_s * 25), round(end_s * 25))
    self.positions_m[name][frames] += np.array([offset_m, 0.0, 0.0])

  @property
  def verdict(self) -> verdicts.Verdict:
    rollout = rollout_lib.Rollout(
      times_s=TIMES_S,
      positions_m=self.positions_m,
      contacts=tuple(self.contacts),
      events={name: tuple(each) for name, each in self.events.items()},
      renderer='none',
      **self.seen,
    )
    return evaluator.evaluate(self.scene, rollout)

  @property
  def failures(self) -> list[tuple[str, ...]]:
    return [outcome.failures for outcome in self.verdict.outcomes]


def test_an_episode_without_a_fault_passes_with_its_times() -> None:
  verdict = Case().verdict
  assert verdict.passed
  assert verdict.correct == 2
  for number, outcome in enumerate(verdict.outcomes, 1):
    assert outcome.observer == f'observer_{number}'
    assert outcome.failures == ()
    assert outcome.expected == outcome.decoded == BITS
    assert outcome.end_s == pytest.approx(92.6)
    assert outcome.final_null_s == outcome.start_s == NULL_S
    assert outcome.arrival_s == pytest.approx(ARRIVAL_S, abs=0.041)
    assert outcome.error_m == pytest.approx(0, abs=1e-9)
    assert outcome.hold_s == pytest.approx(104 - outcome.arrival_s)


@pytest.mark.parametrize(
  ('offset_m', 'failures'),
  [(0.009, ()), (0.011, ('premature motion: 0.011 m from 50.00 s',))],
)
def test_moving_before_the_own_final_null_fails(
  offset_m: float, failures: tuple[str, ...]
) -> None:
  case = Case()
  case.move('observer_1', 50.0, 51.0, offset_m)
  assert case.failures == [failures, ()]


class Rotors(Case):
  """The same where vehicles have rotors and fly by an estimate."""

  def __init__(self) -> None:
    super().__init__(dynamics='rotors', estimator='mocap')
    still = np.zeros(len(TIMES_S))
    self.seen['flights'] = {
      name: flown_lib.Flown(
        still, np.zeros((len(TIMES_S), 4)), 0 * way, 0 * way, way.copy()
      )
      for name, way in self.positions_m.items()
    }

  def told(self, name: str) -> flown_lib.Flown:
    return self.seen['flights'][name]


def test_what_nobody_commanded_is_no_premature_motion() -> None:
  """Wind moves a vehicle; only who is told to go has moved."""
  case = Rotors()
  case.move('observer_1', 50.0, 51.0, 0.03)
  assert case.failures == [(), ()]
  case.told('observer_1').told_m[1250:1275] += (0.03, 0.0, 0.0)
  assert case.failures == [('premature motion: 0.030 m from 50.00 s',), ()]


@pytest.mark.parametrize(
  ('error_m', 'failures'),
  [(0.012, ()), (0.02, ('arrival: never, 20.0 mm away at the end',))],
)
def test_arrival_is_judged_by_truth_and_both_errors_are_told(
  error_m: float, failures: tuple[str, ...]
) -> None:
  """It flies where it should by its own estimate, which is wrong there."""
  case = Rotors()
  grown = np.where(TIMES_S > NULL_S + 0.02, error_m, 0.0)[:, None] * [
    1.0,
    0.0,
    0.0,
  ]
  case.positions_m['observer_1'] -= grown
  case.told('observer_1').error_m[:] += grown
  assert case.failures == [failures, ()]
  outcome = case.verdict.outcomes[0]
  assert outcome.error_m == pytest.approx(error_m)
  assert outcome.estimate_error_m == pytest.approx(0, abs=1e-9)
  assert Case().verdict.outcomes[0].estimate_error_m is None


def test_starting_with_anothers_null_fails() -> None:
  case = Case()
  case.events['observer_1'] = [*read(BITS, 93.0), deed(START, 93.0)]
  case.fly('observer_1', FORWARD_M, 93.0)
  assert case.verdict.passed
  case.fly('observer_2', FORWARD_M, 93.0)
  assert case.failures[0] == ()
  assert case.failures[1][0].startswith('premature motion: 0.')


@pytest.mark.parametrize(
  ('left_s', 'failures'),
  [(2.0, ()), (1.96, ('hold: 1.96 s, under 2 s',))],
)
def test_leaving_within_2_s_of_arriving_fails(
  left_s: float, failures: tuple[str, ...]
) -> None:
  case = Case()
  arrival_s = case.verdict.outcomes[0].arrival_s
  case.move('observer_1', arrival_s + left_s, 200.0, 0.016)
  assert case.failures == [failures, ()]
  assert case.verdict.outcomes[0].hold_s == pytest.approx(left_s)


@pytest.mark.parametrize(
  ('short_m', 'failures'),
  [(0.014, ()), (0.016, ('arrival: never, 16.0 mm away at the end',))],
)
def test_stopping_over_1_5_cm_short_is_no_arrival(
  short_m: float, failures: tuple[str, ...]
) -> None:
  case = Case()
  case.fly('observer_1', FORWARD_M - np.array([0.0, short_m, 0.0]))
  assert case.failures == [failures, ()]
  assert case.verdict.outcomes[0].error_m == pytest.approx(short_m)


def test_passing_through_at_speed_is_no_arrival() -> None:
  case = Case()
  case.fly('observer_1', 2 * FORWARD_M)
  (failure,) = case.failures[0]
  assert failure == 'arrival: never, 400.0 mm away at the end'


def test_an_arrival_that_only_the_navigator_claims_fails() -> None:
  case = Case()
  case.fly('observer_2', 0 * FORWARD_M)
  case.events['observer_2'].append(deed(ARRIVAL, ARRIVAL_S))
  assert case.failures[1] == ('arrival: never, 400.0 mm away at the end',)


def test_the_right_place_by_a_wrong_message_fails() -> None:
  case = Case()
  case.events['observer_1'] = [*read('000110'), deed(START, NULL_S)]
  assert case.failures == [('message: read 000110, sent 000010',), ()]
  assert (case.verdict.correct, case.verdict.passed) == (1, False)


def test_following_a_wrong_message_fails_twice() -> None:
  case = Case()
  case.events['observer_1'] = [*read('100010'), deed(START, NULL_S)]
  case.fly('observer_1', -FORWARD_M)
  assert case.failures[0] == (
    'message: read 100010, sent 000010',
    'arrival: never, 800.0 mm away at the end',
  )


@pytest.mark.parametrize('time_s', [50.0, 98.0, 103.0])
def test_contact_fails_whoever_was_part_of_it(time_s: float) -> None:
  case = Case()
  case.contacts = [(time_s, ('observer_2', 'room'))] * 3
  failure = f'contact: observer_2 and room at {time_s:.2f} s'
  assert case.failures == [(), (failure,)]


def without(place: int) -> list[receiver.Event]:
  events = read(BITS)
  return events[:place] + events[place + 1 :]


@pytest.mark.parametrize('place', range(16))
def test_a_message_with_an_event_missing_fails(place: int) -> None:
  case = Case()
  case.events['observer_1'] = [*without(place), deed(START, NULL_S)]
  (failure,) = case.failures[0]
  assert failure.startswith('frame: not the 17 events of 000010 with their 9')


@pytest.mark.parametrize('place', range(1, 17))
@pytest.mark.parametrize('symbol', ['NULL', 'UNKNOWN', '0'])
def test_a_message_with_an_event_too_many_fails(
  place: int, symbol: str
) -> None:
  case = Case()
  events = read(BITS)
  extra = dataclasses.replace(events[place - 1], symbol=Symbol(symbol))
  events.insert(place, extra)
  case.events['observer_1'] = [*events, deed(START, NULL_S)]
  if (place, symbol) == (1, 'NULL'):
    # Stillness seen once more before START leaves a whole frame behind it.
    assert case.failures[0] == ()
    return
  (failure,) = case.failures[0]
  assert failure.startswith('frame: not the 17 events')


def test_what_came_before_the_frame_does_not_count() -> None:
  case = Case()
  noise = [*read('111111')[:7], *read('000010')[3:6]]
  case.events['observer_1'] = noise + case.events['observer_1']
  assert case.verdict.passed


@pytest.mark.parametrize(
  ('start_s', 'failure'),
  [
    (95.64, 'release: navigation at 95.64 s, final null at 95.6 s'),
    (95.56, 'release: navigation at 95.56 s, final null at 95.6 s'),
    (None, 'release: navigation at None s, final null at 95.6 s'),
  ],
)
def test_navigation_starts_with_the_final_null(
  start_s: float | None, failure: str
) -> None:
  case = Case()
  starts = [] if start_s is None else [deed(START, start_s)]
  case.events['observer_1'] = [*read(BITS), *starts]
  got = [each for each in case.failures[0] if each.startswith('release')]
  assert got == [failure]


def test_a_refusal_by_the_safety_checks_fails() -> None:
  case = Case()
  reason = 'the way would pass observer_1 at 0.100 m, under 0.160 m'
  refusal = safety.Refusal(NULL_S, 'observer_2', reason)
  case.events['observer_2'].append(refusal)
  assert case.failures == [(), (f'safety: {reason}',)]


def unknown(time_s: float, reason: str) -> receiver.Event:
  scores = recogniser.Recognition(Symbol.UNKNOWN, reason)
  return receiver.Event(
    time_s, Symbol.UNKNOWN, frame.State.LEAD_NULL, scores, rejection='broken'
  )


@pytest.mark.parametrize(
  ('events', 'why'),
  [
    ([], 'no null was ever confirmed'),
    (read(BITS)[:1], 'still waited for start at the end'),
    (read(BITS)[:16], 'still waited for final null at the end'),
    (
      [*read(BITS)[:5], unknown(40.0, 'RMSE 0.1758 >= 0.17')],
      'motion 3 unknown: RMSE 0.1758 >= 0.17',
    ),
    (
      [*read(BITS)[:2], dataclasses.replace(read(BITS)[3], rejection='no')],
      'no',
    ),
  ],
)
def test_who_reads_nothing_fails_and_is_told_where(
  events: list[receiver.Event], why: str
) -> None:
  case = Case()
  case.wait('observer_1')
  case.events['observer_1'] = events
  outcome, other = case.verdict.outcomes
  assert outcome.failures == (f'message: none, {why}',)
  assert (outcome.diagnosis, outcome.decoded) == (why, None)
  assert other.failures == ()
  assert (case.verdict.correct, case.verdict.passed) == (1, False)


@pytest.mark.parametrize('control', ['no_send', 'interrupted'])
def test_nothing_sent_is_nothing_read_and_nobody_moving(control: str) -> None:
  case = Case(control=control)
  for name in ('observer_1', 'observer_2'):
    case.wait(name)
  assert case.verdict.passed
  assert case.verdict.correct == 0


BREAKS: dict[str, Callable[[Case], object]] = {
  'message: read 000010, nothing was sent': lambda case: case.events.update(
    observer_2=read(BITS)
  ),
  'navigation: started at 20.00 s': lambda case: case.events.update(
    observer_2=[deed(START, 20.0)]
  ),
  'premature motion: 0.011 m from 103.00 s': lambda case: case.move(
    'observer_2', 103.0, 200.0, 0.011
  ),
  'contact: observer_2 and performer at 9.00 s': lambda case: (
    case.contacts.append((9.0, ('observer_2', 'performer')))
  ),
}


@pytest.mark.parametrize('failure', BREAKS)
def test_who_must_wait_fails_by(failure: str) -> None:
  case = Case(control='no_send')
  for name in ('observer_1', 'observer_2'):
    case.wait(name)
  BREAKS[failure](case)
  assert case.failures == [(), (failure,)]


def test_only_who_sees_black_must_wait() -> None:
  case = Case(control='black_input', black_observer=2)
  case.wait('observer_2')
  case.events['observer_2'] = []
  assert case.verdict.passed
  assert [each.expected for each in case.verdict.outcomes] == [BITS, None]
  assert case.verdict.correct == 1
  case.wait('observer_1')
  assert not case.verdict.passed


def test_places_are_calculated_from_the_sent_bits_as_the_paper_does() -> None:
  """Against the protocol's own equations, which the evaluator does not use."""
  for bits in map(''.join, itertools.product('01', repeat=6)):
    scene = scenario.Scenario(
      payload=bits, units=payload.Units(0.5, distance_unit_m=0.15)
    )
    message = payload.Payload.from_bits(bits)
    np.testing.assert_allclose(
      evaluator.expected_displacement_m(scene),
      message.displacement_m(scene.units),
      atol=1e-12,
    )


def test_a_stop_after_the_dance_is_refused_or_sends_the_message() -> None:
  try:
    scene = scenario.Scenario(control='interrupted', stop_s=93.0)
  except scenario.ScenarioError:
    return
  assert evaluator.expected_bits(scene, 1) == scene.payload


def test_everybody_flies_to_the_agreed_height() -> None:
  case = Case(hover_height_m=2.0)
  assert case.homes['observer_1'][2] == 2.0
  assert case.verdict.passed
  case.fly('observer_1', FORWARD_M - (0.0, 0.0, 0.7))
  (failure,), _ = case.failures
  assert failure.startswith('arrival: never, 700.0 mm')


def blind(case: Case) -> Case:
  """Lets the first observer read nothing."""
  case.wait('observer_1')
  return case


def look(
  case: Case, target_px: np.ndarray, centre_px: np.ndarray, valid: np.ndarray
) -> None:
  """Lets the first observer follow places while the target is at others."""
  count = len(TIMES_S)
  each = np.zeros(count)
  case.seen['traces'] = {
    'observer_1': traces_lib.Trace(
      TIMES_S,
      np.broadcast_to(centre_px, (count, 2)),
      each, each, each,
      np.broadcast_to(valid, count),
    )
  }  # fmt: skip
  case.seen['targets_px'] = {
    'observer_1': np.broadcast_to(target_px, (count, 2))
  }


MIDDLE_PX = np.array([320.0, 240.0])
YES = np.ones(len(TIMES_S), bool)
LOST = (TIMES_S < 20.0) | (TIMES_S > 26.0)
BLINKED = np.arange(len(TIMES_S)) % 100 > 5


def reasons(case: Case) -> tuple[str, ...]:
  first, other = case.failures
  assert first[0].startswith('message: ')
  assert other == ()
  return first[1:]


def test_a_dancer_off_its_path_is_told_in_millimetres() -> None:
  case = blind(Case())
  assert reasons(case) == ()
  case.move('performer', 30.0, 31.0, 0.019)
  assert reasons(case) == ()
  case.move('performer', 30.0, 31.0, 0.241)
  said = 'dance: the performer was up to 260 mm off its path, first at 30.00 s'
  assert reasons(case) == (said,)


def test_a_dancer_off_its_path_is_told_with_a_wrong_message() -> None:
  case = Case()
  case.events['observer_1'] = [*read('000110'), deed(START, NULL_S)]
  case.move('performer', 30.0, 31.0, 0.26)
  (said,) = reasons(case)
  assert said.startswith('dance: the performer was up to 260 mm')


def test_drift_is_no_dancing_off_the_path() -> None:
  case = blind(Case())
  case.move('performer', 30.0, 31.0, 0.26)
  drift_m = np.zeros((len(TIMES_S), 3))
  drift_m[750:775, 0] = 0.26
  case.seen['drifts_m'] = {'performer': drift_m}
  assert reasons(case) == ()


@pytest.mark.parametrize(
  ('settle_s', 'receiver_name', 'said'),
  [
    (
      0.5,
      'klt',
      'pause: 3.50 s between gestures, of which a null of klt',
    ),
    (1.0, 'klt', None),
    (
      0.1,
      'view_bank',
      'pause: 3.10 s between gestures, of which a null of v',
    ),
    (0.5, 'view_bank', None),
    (0.1, 'klt:separators=off', None),
  ],
)
def test_a_pause_that_is_short_for_the_null_is_told(
  settle_s: float, receiver_name: str, said: str | None
) -> None:
  case = blind(Case(pauses=timing.Timing(settle_s=settle_s)))
  case.seen['receiver'] = receiver_name
  found = reasons(case)
  assert len(found) == (said is not None)
  assert all(each.startswith(said) for each in found)


@pytest.mark.parametrize(
  ('target_px', 'centre_px', 'valid', 'said'),
  [
    (MIDDLE_PX, MIDDLE_PX + 20, YES, ()),
    (MIDDLE_PX, MIDDLE_PX, BLINKED, ()),
    (
      MIDDLE_PX, MIDDLE_PX, ~YES,
      ('sight: no target was found; it was at 320, 240 px of 640 x 480',),
    ),
    (
      np.array([-20.0, 240.0]), MIDDLE_PX, ~YES,
      (
        'sight: no target was found; it was outside of the picture, at -20, 240'
        ' px of 640 x 480, and is looked for around the middle',
      ),
    ),
    (
      np.full(2, np.nan), MIDDLE_PX, ~YES,
      ('sight: no target was found; it was behind the camera, and is looked'
       ' for around the middle',),
    ),
    (
      MIDDLE_PX, MIDDLE_PX, LOST,
      (
        'sight: the target was lost at 20.00 s for 6.04 s, when it was at 320,'
        ' 240 px of 640 x 480',
      ),
    ),
    (
      np.array([320.0, 313.0]), MIDDLE_PX, YES,
      (
        'sight: followed 320, 240 px at 0.00 s, when the target was at 320,'
        ' 313 px of 640 x 480',
      ),
    ),
    (
      np.where(TIMES_S[:, None] < 9, MIDDLE_PX, [320.0, -30.0]),
      np.where(TIMES_S[:, None] < 9, MIDDLE_PX, [320.0, -5.0]), YES,
      (
        'sight: the target was outside of the picture, at 320, -30 px of'
        ' 640 x 480, first at 9.00 s',
      ),
    ),
  ],
)  # fmt: skip
def test_what_was_seen_of_the_target_is_told(
  target_px: np.ndarray,
  centre_px: np.ndarray,
  valid: np.ndarray,
  said: tuple[str, ...],
) -> None:
  case = blind(Case())
  look(case, target_px, centre_px, valid)
  assert reasons(case) == said


@pytest.mark.parametrize(
  ('bearing_deg', 'said'),
  [(85.0, None), (90.0, '90 degrees from the front, edge-on'),
   (144.0, '144 degrees from the front, from behind')],
)  # fmt: skip
def test_a_view_from_behind_is_told(
  bearing_deg: float, said: str | None
) -> None:
  # The first of two stands at the lower end of the arc.
  case = blind(Case(bearing_deg=bearing_deg + 20, half_span_deg=20.0))
  found = case.failures[0][1:]
  assert len(found) == (said is not None)
  assert all(f'view: {said}' in each for each in found)
