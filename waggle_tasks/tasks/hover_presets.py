"""Hovers that were measured, by name."""

from collections.abc import Mapping

from waggle_tasks.tasks import hover

PRESETS: Mapping[str, hover.Spectrum] = {
  'mocap': hover.Spectrum(
    x_mm=(10.4, 1.6, 1.65, 0.33, 0.15, 0.16),
    y_mm=(14.2, 1.3, 1.5, 0.28, 0.13, 0.12),
    z_mm=(10.4, 1.6, 1.65, 0.33, 0.15, 0.16),
    roll_deg=(0.76, 0.20, 0.29, 0.31, 0.41, 0.42),
    pitch_deg=(1.30, 0.40, 0.30, 0.46, 0.50, 0.40),
    yaw_deg=(1.6, 0.66, 0.27, 0.30, 0.31, 0.30),
  ),
  'lighthouse': hover.Spectrum(
    x_mm=(6.2, 2.2, 2.2, 0.60, 0.20, 0.16),
    y_mm=(6.2, 2.2, 2.2, 0.60, 0.20, 0.16),
    z_mm=(6.2, 2.2, 2.2, 0.60, 0.20, 0.16),
    roll_deg=(0.70, 0.20, 0.27, 0.32, 0.36, 0.36),
    pitch_deg=(0.70, 0.20, 0.27, 0.32, 0.36, 0.36),
    yaw_deg=(0.32, 0.13, 0.06, 0.06, 0.06, 0.06),
  ),
  'flow_deck': hover.Spectrum(
    x_mm=(5.0, 2.6, 3.2, 1.50, 0.40, 0.20),
    y_mm=(5.0, 2.6, 3.2, 1.50, 0.40, 0.20),
    z_mm=(5.0, 2.6, 3.2, 1.50, 0.40, 0.20),
    roll_deg=(0.70, 0.25, 0.45, 0.65, 0.45, 0.35),
    pitch_deg=(0.70, 0.25, 0.45, 0.65, 0.45, 0.35),
    yaw_deg=(0.32, 0.13, 0.06, 0.06, 0.06, 0.06),
  ),
}
