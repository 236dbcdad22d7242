"""A receiver at work on images that were taken before."""

from collections.abc import Callable, Sequence
import json
import pathlib

import numpy as np

from waggle_tasks.agents import image_chain, receiver, receivers
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import archive, capture, frames, writer
from waggle_tasks.protocol import agreement as agreement_lib


class Reader:
  """One receiver, what it saw, and the proof of what it was shown.

  Attributes:
    name: The receiver's name.
    agreement: What both sides know.
    receiver: The receiver.
    events: All it confirmed, in order.
    chain: The hashes of its images.
    last_s: Time of the last image; NaN before one.
    longest_gap_s: Longest time between two images.
  """

  def __init__(
    self,
    name: str,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    make: Callable[..., receiver.Receiver] = receivers.make,
  ) -> None:
    """Makes a reader.

    Args:
      name: A receiver as `make` takes it.
      agreement: What both sides know.
      make: Of images, or `tracks.make`, of places.

    Raises:
      ReceiverError: if the receiver is not known.
    """
    self.name, self.agreement = name, agreement
    self.receiver = make(name, agreement)
    self.events: list[receiver.Event] = []
    self.chain = image_chain.Chain()
    self.last_s = np.nan
    self.longest_gap_s = 0.0

  def take(self, image: np.ndarray, time_s: float) -> None:
    """Shows it an image, (H, W, 3) uint8 RGB."""
    self.chain.add(image, time_s)
    self.events += receiver.step(self.receiver, image, time_s)
    if self.last_s < time_s:
      self.longest_gap_s = max(self.longest_gap_s, time_s - self.last_s)
    self.last_s = time_s

  @property
  def message(self) -> str | None:
    """The bits of the first whole frame, or None."""
    for event in self.events:
      if event.message is not None:
        return event.message.bits
    return None


def replay(
  path: pathlib.Path,
  names: Sequence[str],
  agreement: agreement_lib.Agreement,
) -> list[Reader]:
  """Shows a capture to receivers.

  Args:
    path: The capture.
    names: The receivers.
    agreement: What both sides know.

  Returns:
    One reader for each name.

  Raises:
    CaptureError: if the capture is damaged.
    ReceiverError: if a receiver is not known.
  """
  readers = [Reader(name, agreement) for name in names]
  for image, time_s in capture.read(path):
    for reader in readers:
      reader.take(image, time_s)
  return readers


def differences(reader: Reader, folder: pathlib.Path, observer: str) -> str:
  """What sets a replay apart from the online run; empty when nothing does.

  Args:
    reader: The replay, by the receiver of the run.
    folder: The run folder.
    observer: Whose capture it was.

  Raises:
    ArchiveError: if the event log cannot be read.
  """
  path = folder / 'events.jsonl'
  try:
    lines = path.read_text(encoding='utf-8').splitlines()
    rows = [(line, json.loads(line)) for line in lines]
    own = [(line, row) for line, row in rows if row['observer'] == observer]
    online = [line for line, row in own if row['kind'] == 'event']
    proofs = {r['provenance'] for _, r in own if r['kind'] == 'navigation'}
  except (OSError, ValueError, KeyError, TypeError) as error:
    raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
  again = [writer.event_line(observer, event) for event in reader.events]
  if again != online:
    pairs = zip(again, online, strict=False)
    same = sum(a == b for a, b in pairs)
    return f'{same} of {len(online)} events are the same, {len(again)} now'
  if proofs - {reader.chain.digest}:
    return 'the images are not those that the message was made from'
  return ''


def report(readers: Sequence[Reader]) -> str:
  """What receivers confirmed, side by side over time."""
  header = ['time s']
  for reader in readers:
    header += [reader.name, 'RMSE', 'margin', 'closure', 'span px']
  times_s = sorted({e.time_s for r in readers for e in r.events})
  rows = []
  for time_s in times_s:
    row = [f'{time_s:.2f}']
    for reader in readers:
      row += _cells([e for e in reader.events if e.time_s == time_s])
    rows.append(row)
  lines = [table.render(header, rows)]
  for reader in readers:
    lines += [
      f'{reader.name}: {event.time_s:.2f} s: {reason}'
      for event in reader.events
      for reason in _reasons(event)
    ]
    lines += [
      f'{reader.name}: {each.time_s:.2f} s: {each.words}'
      for each in frames.read(reader.events, reader.agreement)
      if each.slots
    ]
  return '\n'.join(lines)


def _cells(events: Sequence[receiver.Event]) -> list[str]:
  """What was confirmed at one time, and the scores of it."""
  names = ' '.join(event.symbol for event in events)
  scores = next((e.recognition for e in events if e.recognition), None)
  if scores is None:
    return [names, '', '', '', '']
  return [
    names,
    table.number(scores.rmse, 3),
    table.number(scores.margin, 3),
    table.number(scores.closure, 3),
    table.number(scores.span_px, 1),
  ]


def _reasons(event: receiver.Event) -> list[str]:
  """Why an event was not understood, and why it broke a frame."""
  reasons = []
  if event.recognition is not None and event.recognition.reason:
    reasons.append(f'UNKNOWN, {event.recognition.reason}')
  if event.rejection is not None:
    reasons.append(event.rejection)
  return reasons
