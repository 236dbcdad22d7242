"""A language of twelve bits: 64 headings, and 32 distances of 2 cm."""

import math

import loop

import waggle_tasks
from waggle_tasks.protocol import payload

UNITS = payload.Units(math.tau / 64, 0.02, heading_bits=6, distance_bits=5)


def main() -> None:
  """Sends 0.4 m, 45 degrees to the left."""
  bits = payload.Payload(0, 8, 20, heading_bits=6, distance_bits=5).bits
  loop.fly(
    waggle_tasks.load(
      'broadcast', observers=1, payload=bits, units=UNITS, **loop.FAST
    )
  )


if __name__ == '__main__':
  main()
