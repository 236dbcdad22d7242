"""Images of 320x240, fifty in a second: the agreement says so to both sides."""

import loop

import waggle_tasks


def main() -> None:
  """Flies a message before such a camera."""
  loop.fly(
    waggle_tasks.load(
      'broadcast',
      observers=1,
      camera_width_px=320,
      camera_height_px=240,
      rate_hz=50,
      **loop.FAST,
    )
  )


if __name__ == '__main__':
  main()
