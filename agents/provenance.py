"""What a receiver's message was made from, as a chain of hashes."""

import functools
import hashlib

import numpy as np


@functools.cache
def _weights(count: int) -> np.ndarray:  # (count,) uint64
  return np.random.RandomState(0).randint(1, 2**64, size=count, dtype=np.uint64)


def image_hash(image: np.ndarray) -> int:
  """A 64-bit hash of an image: multilinear, modulo 2^64.

  Multilinear hashing of 64-bit words costs a tenth of a cryptographic digest
  and is meant against mistakes, not forgery (Lemire and Kaser 2014,
  doi:10.1093/comjnl/bxt070).

  Args:
    image: Any contiguous uint8 array.
  """
  data = np.ascontiguousarray(image).reshape(-1)
  padded = np.pad(data, (0, -data.size % 8)) if data.size % 8 else data
  words = padded.view(np.uint64)
  return int(np.dot(words, _weights(words.size)))


class Chain:
  """SHA-256 over the hash and the time of every image, in order."""

  def __init__(self) -> None:
    self._sha = hashlib.sha256()
    self.images = 0

  def add(self, image: np.ndarray, time_s: float) -> None:
    """Adds an image that a receiver is about to take."""
    shape = 'x'.join(map(str, image.shape))
    self._sha.update(f'{shape} {image_hash(image):016x} {time_s!r}\n'.encode())
    self.images += 1

  @property
  def digest(self) -> str:
    """Hexadecimal SHA-256 of all images so far."""
    return self._sha.hexdigest()
