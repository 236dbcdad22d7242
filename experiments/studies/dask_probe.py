"""Asks whether a Dask scheduler listens at an address.

Dask's own client waits for ever for a port that only accepts, and takes what
anything else says for lengths of messages.
"""

import asyncio
import json
import pathlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
  from distributed import comm


def ask(address: str, limit_s: float) -> dict[str, dict]:
  """What a scheduler says of itself.

  Args:
    address: tcp://HOST:PORT.
    limit_s: How long to wait for all of it.

  Returns:
    Its 'workers', and the versions of its 'packages'.

  Raises:
    ConnectionError: if no scheduler answers there.
  """
  return asyncio.run(_ask(address, limit_s))


def written(path: str) -> str:
  """The address in the file that a scheduler wrote.

  Raises:
    OSError: if it cannot be read.
    ValueError: if it holds no address.
  """
  text = pathlib.Path(path).read_text(encoding='utf-8')
  if not text.strip():
    raise ValueError('it is empty: its scheduler has not begun to listen yet')
  try:
    address = json.loads(text)['address']
  except ValueError as error:
    raise ValueError(f'it is no JSON: {error}') from None
  except (KeyError, TypeError, IndexError):
    address = None
  if not isinstance(address, str):
    raise ValueError('it holds no address')
  return address


async def _ask(address: str, limit_s: float) -> dict[str, dict]:
  from distributed import comm

  link = None
  try:
    async with asyncio.timeout(limit_s):
      link = await comm.connect(address, timeout=limit_s)
      about = await _send(link, 'identity')
      packages = (await _send(link, 'versions'))['packages']
    kind, workers = about['type'], about['workers']
  except TimeoutError:
    raise ConnectionError(
      f'what listens there answers nothing within {limit_s:g} s'
    ) from None
  except Exception as error:  # Whatever comes of what others say.
    raise ConnectionError(
      f'what listens there is no scheduler: {type(error).__name__}'
    ) from None
  finally:
    if link is not None:
      link.abort()
  if kind != 'Scheduler':
    raise ConnectionError(
      f'what listens there is no scheduler: a {kind} of Dask'
    )
  return {'workers': workers, 'packages': packages}


async def _send(link: 'comm.Comm', operation: str) -> dict:
  await link.write({'op': operation, 'reply': True})
  return await link.read()
