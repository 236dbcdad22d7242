"""Drives Chromium over its debugging pipe; needs nothing but the browser."""

import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import types

NAMES = ('chromium', 'chromium-browser', 'google-chrome')
_FLAGS = (
  '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic',
  '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--remote-debugging-pipe',
  '--autoplay-policy=no-user-gesture-required', '--hide-scrollbars',
)  # fmt: skip
_TIMEOUT_S = 30.0
# Becomes the browser, with its pipe where it expects it. A function between
# fork and exec could wait for ever for a thread that the fork does not have.
_START = """
import fcntl, os, sys
reads, writes, *command = sys.argv[1:]
far = [fcntl.fcntl(int(end), fcntl.F_DUPFD, 64) for end in (reads, writes)]
for place, end in zip((3, 4), far):
  os.dup2(end, place)
os.execv(command[0], command)
"""
# Pairs of words in one drawing whose letters overlap by more than a pixel.
OVERLAPS = """
(() => {
  const found = [];
  for (const svg of document.querySelectorAll('svg')) {
    const words = [...svg.querySelectorAll('text')].map(
      (word) => [word.textContent, word.getBoundingClientRect()]);
    for (const [k, [a, p]] of words.entries())
      for (const [b, q] of words.slice(k + 1)) {
        const width = Math.min(p.right, q.right) - Math.max(p.left, q.left);
        // Lines of text have room above and below their letters.
        const height = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
        if (a && b && width > 1 && height > 5) found.push([a, b]);
      }
  }
  return found;
})()
"""
# Words that reach out of the card that they stand in.
CLIPPED = """
[...document.querySelectorAll('svg text, p, td, th, h1, h2, figcaption, pre')]
  .filter((word) => word.textContent && word.getClientRects().length)
  .filter((word) => {
    const card = word.closest('figure, section, header');
    const inner = word.getBoundingClientRect();
    const outer = card.getBoundingClientRect();
    const scroll = word.closest('.scroll');
    if (scroll && scroll.scrollWidth > scroll.clientWidth) return false;
    return inner.left < outer.left - 1 || inner.right > outer.right + 1;
  })
  .map((word) => word.textContent)
"""


def find() -> str | None:
  """Path of the installed browser, or None."""
  return next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
  """One page of a headless browser; a context manager."""

  def __init__(self, width: int = 1280, height: int = 800) -> None:
    self._home = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
    reads, self._out = os.pipe()
    self._in, writes = os.pipe()
    ends = reads, writes
    self._process = subprocess.Popen(
      [
        sys.executable, '-c', _START, *map(str, ends), find(), *_FLAGS,
        f'--user-data-dir={self._home.name}',
        f'--window-size={width},{height}', 'about:blank',
      ],
      stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
      stderr=subprocess.DEVNULL, pass_fds=ends,
    )  # fmt: skip
    for end in ends:
      os.close(end)
    os.set_blocking(self._in, False)
    self._buffer, self._number, self.requests = b'', 0, []
    targets = self._call('Target.getTargets')['targetInfos']
    page = next(t['targetId'] for t in targets if t['type'] == 'page')
    self._session = None
    self._session = self._call(
      'Target.attachToTarget', targetId=page, flatten=True
    )['sessionId']
    for domain in ('Page', 'Network', 'Runtime'):
      self._call(f'{domain}.enable')

  def __enter__(self) -> 'Browser':
    return self

  def __exit__(
    self,
    kind: type[BaseException] | None,
    error: BaseException | None,
    trace: types.TracebackType | None,
  ) -> None:
    self._process.kill()
    self._process.wait()
    os.close(self._in)
    os.close(self._out)
    self._home.cleanup()

  def _call(self, method: str, **params: object) -> dict:
    self._number += 1
    message = {'id': self._number, 'method': method, 'params': params}
    if getattr(self, '_session', None):
      message['sessionId'] = self._session
    os.write(self._out, json.dumps(message).encode() + b'\0')
    deadline_s = time.monotonic() + _TIMEOUT_S
    while time.monotonic() < deadline_s:
      answer = self._next()
      if answer is None:
        time.sleep(0.005)
      elif answer.get('method') == 'Network.requestWillBeSent':
        self.requests.append(answer['params']['request']['url'])
      elif answer.get('id') == self._number:
        assert 'error' not in answer, answer['error']
        return answer['result']
    raise TimeoutError(method)

  def _next(self) -> dict | None:
    with contextlib.suppress(BlockingIOError):
      self._buffer += os.read(self._in, 1 << 20)
    line, found, rest = self._buffer.partition(b'\0')
    if not found:
      return None
    self._buffer = rest
    return json.loads(line)

  def open(self, path: pathlib.Path) -> None:
    """Loads a file and waits for it."""
    self._call('Page.navigate', url=path.resolve().as_uri())
    self.wait('document.readyState === "complete"')

  def eval(self, script: str) -> object:
    """The value of an expression; promises are waited for."""
    answer = self._call(
      'Runtime.evaluate', expression=script, awaitPromise=True,
      returnByValue=True,
    )  # fmt: skip
    assert 'exceptionDetails' not in answer, answer['exceptionDetails']
    return answer['result'].get('value')

  def wait(self, condition: str) -> None:
    """Waits until an expression is true."""
    deadline_s = time.monotonic() + _TIMEOUT_S
    while not self.eval(condition):
      if time.monotonic() > deadline_s:
        raise TimeoutError(condition)
      time.sleep(0.02)

  def click(self, x: float, y: float) -> None:
    """Clicks at a place of the window."""
    for kind in ('mousePressed', 'mouseReleased'):
      self._call(
        'Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left',
        clickCount=1,
      )  # fmt: skip

  def resize(self, width: int, height: int) -> None:
    """Changes the window's size."""
    self._call(
      'Emulation.setDeviceMetricsOverride', width=width, height=height,
      deviceScaleFactor=1, mobile=False,
    )  # fmt: skip

  def media(self, name: str) -> None:
    """Shows the page as on 'screen' or in 'print'."""
    self._call('Emulation.setEmulatedMedia', media=name)
