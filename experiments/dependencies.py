"""What the installed package says that it needs."""

from importlib import metadata

from packaging import requirements

DISTRIBUTION = 'waggle-tasks'


def declared() -> list[requirements.Requirement]:
  """Every dependency, without those of extras.

  Raises:
    PackageNotFoundError: if the package is not installed.
  """
  lines = metadata.metadata(DISTRIBUTION).get_all('Requires-Dist', [])
  needs = map(requirements.Requirement, lines)
  return [
    need
    for need in needs
    if need.marker is None or need.marker.evaluate({'extra': ''})
  ]
