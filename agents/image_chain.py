"""What a receiver's message was made from, as a chain of hashes."""

import hashlib
from typing import Any

import numpy as np
import xxhash


class Chain:
  """SHA-256 over the hash and the time of every image, in order.

  Images are hashed with XXH3, which costs a fiftieth of a cryptographic
  digest and is meant against mistakes, not forgery (https://xxhash.com).

  Attributes:
    images: How many there were.
  """

  def __init__(self) -> None:
    self._sha = hashlib.sha256()
    self.images = 0

  def add(self, image: np.ndarray, time_s: float) -> None:
    """Adds an image that a receiver is about to take, of any shape."""
    shape = 'x'.join(map(str, image.shape))
    whole: Any = np.ascontiguousarray(image)
    digest = xxhash.xxh3_64_hexdigest(whole)
    self._sha.update(f'{shape} {digest} {time_s!r}\n'.encode())
    self.images += 1

  @property
  def digest(self) -> str:
    """Hexadecimal SHA-256 of all images so far."""
    return self._sha.hexdigest()
