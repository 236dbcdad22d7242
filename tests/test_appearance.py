"""Which looks can be asked for."""

import math

import pytest

from waggle_tasks import appearance


def test_shadows_are_off_by_default() -> None:
  assert not appearance.Appearance().shadows


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    (
      {'floor': 'lava'},
      r"`floor` must be one of \['honeycomb', 'plain', 'clutter'\]: got 'lava'",
    ),
    ({'walls': 'ivy'}, r"`walls` must be one of .* got 'ivy'"),
    ({'sun': 'red'}, r"`sun` must be one of \['none', 'fixed', 'moving'\]"),
    ({'brightness': 0.0}, '`brightness` must be between 0.1 and 2: got 0.0'),
    ({'brightness': 2.1}, '`brightness` must be between 0.1 and 2: got 2.1'),
    ({'brightness': math.nan}, '`brightness` must be .* got nan'),
    ({'shadows': 'off'}, "`shadows` must be True or False: got 'off'"),
  ],
)
def test_other_looks_are_refused(changes: dict, error: str) -> None:
  with pytest.raises(appearance.AppearanceError, match=error):
    appearance.Appearance(**changes)
