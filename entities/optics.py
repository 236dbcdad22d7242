"""An observer's eye in plain numbers, which need no simulator."""

FOVY_DEG = 60.0  # Paper, section 'Scene, sensors, and information boundaries'.
# Ahead of the centre of mass, clear of the airframe.
OFFSET_M = 0.03
# How its images are rendered; each gives the same picture.
CAMERAS = ('incremental', 'full')
