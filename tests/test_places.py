"""A payload may name a place, about which everybody has a slot."""

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.protocol import agreement, flight, payload


def test_a_slot_follows_from_ones_own_place() -> None:
  agreed = agreement.Agreement(units=payload.Units(meaning='place'))
  way_m = np.array([0.0, 0.4, 0.0])
  front = flight.goal_m(np.array([0, -1.3, 1.0]), way_m, agreed)
  np.testing.assert_allclose(front, (0, -0.1, 1.3), atol=1e-12)
  right = flight.goal_m(np.array([1.3, -1.3, 1.3]), way_m, agreed)
  np.testing.assert_allclose(right, (0.5, 0.4, 1.3), atol=1e-12)


def test_slots_that_are_too_near_are_refused() -> None:
  units = payload.Units(meaning='place', slot_m=0.2)
  with pytest.raises(scenario.ScenarioError, match='`slot_m` must be such'):
    scenario.Scenario(units=units, observers=5)


def test_an_unknown_meaning_is_refused() -> None:
  with pytest.raises(payload.PayloadError, match='`meaning` must be one of'):
    payload.Units(meaning='wish')


def test_a_place_may_be_said_in_any_language() -> None:
  place = payload.Units(meaning='place')
  for language in ('swift', 'brisk'):
    scene = scenario.Scenario(language=language, units=place, safety='avoid')
    agreed = scene.agreement
    assert agreed.units.meaning == 'place'
    assert scene.performance.message == scene.message
    sooner_s = scenario.Scenario(language=language).episode_s
    assert scene.episode_s == sooner_s + scenario.AVOIDING_S
