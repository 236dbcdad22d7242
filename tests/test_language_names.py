"""A language can be named with its code changed, wherever one is named."""

import pytest

from waggle_tasks import errors, scenario
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.protocol import coding, language_names, languages


def test_a_name_alone_is_the_language() -> None:
  swift = languages.LANGUAGES['swift']
  assert language_names.find('swift') == swift


@pytest.mark.parametrize(
  ('name', 'code'),
  [
    ('swift:parity=0', coding.Coding()),
    ('swift:check=crc4', coding.Coding('crc4', 2)),
    ('swift:parity=0,check=crc8', coding.Coding('crc8')),
    ('brisk:check=crc3', coding.Coding('crc3')),
  ],
)
def test_a_name_changes_the_code_and_nothing_else(
  name: str, code: coding.Coding
) -> None:
  found = language_names.find(name)
  usual = languages.LANGUAGES[name.partition(':')[0]]
  assert found.coding == code
  assert found.alphabet == usual.alphabet
  scene = scenario.Scenario(language=name)
  assert scene.agreement.coding == code
  # It is plain text, as flags and results have it.
  (flag,) = scenario_fields.flags({'language': name})
  assert flag == f'--language={name}'
  assert scenario_fields.make({'language': name}) == scene


@pytest.mark.parametrize(
  ('name', 'said'),
  [
    (
      'swft',
      "must be one of .*'paper', 'brisk', 'gentle', 'rapid', 'swift'.*"
      ' mean swift',
    ),
    ('swift:', 'must be NAME or NAME:check'),
    ('swift:parity', 'must be NAME or NAME:check'),
    ('swift:parity=', 'must be NAME or NAME:check'),
    ('swift:parity=1,parity=2', 'each part once'),
    ('swift:parity=1,', 'must be NAME or NAME:check'),
    ('swift:party=1', 'Did you mean parity'),
    ('swift:parity=two', '`parity` of `language` must be a whole number'),
    ('swift:parity=-1', '`parity` of `language` must be a whole number'),
    ('swift:parity=7', '`parity` must be between 0 and 6'),
    ('swift:check=crc5', '`check` must be one of'),
    ('brisk:parity=1', '`parity` must be between 0 and 0'),
    ('paper:check=crc3', "'paper' must stand alone"),
    ('paper:', "'paper' must stand alone"),
  ],
)
def test_a_name_that_says_no_language_is_refused(name: str, said: str) -> None:
  with pytest.raises(errors.WaggleError, match=said):
    scenario.Scenario(language=name)
