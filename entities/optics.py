"""An observer's eye in plain numbers, which need no simulator."""

# Ahead of the centre of mass, clear of the airframe.
OFFSET_M = 0.03
# How its images are rendered; each gives the same picture.
CAMERAS = ('incremental', 'full')
