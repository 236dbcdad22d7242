"""Flags for every choice of a scenario, and the scenario that they make."""

from typing import Any

from absl import flags

from waggle_tasks import appearance, scenario
from waggle_tasks.entities import optics
from waggle_tasks.experiments.record import scenario_fields

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

_HELP = {
  'control': 'What is sent, and to whom.',
  'observers': 'How many observers.',
  'layout': 'Where observers stand.',
  'distance_m': 'Radius of the arc, or distance of the line, in m.',
  'half_span_deg': 'Angle from the middle of the arc to its end, in degrees.',
  'bearing_deg': 'Angle by which the middle of the arc is turned, in degrees.',
  'spacing_m': 'Distance between neighbours in a line, in m.',
  'payload': 'Six bits: one of direction, three of heading, two of distance.',
  'jitter_m': 'Bound of the initial x and y offset of each vehicle, in m.',
  'seed': 'Seed of the environment.',
  'black_observer': 'Who sees black images with --control=black_input.',
  'stop_s': 'When sending stops with --control=interrupted, in s.',
  'duration_s': 'Longest episode, in s; unset, what the control needs.',
  'rate_hz': 'Images and references in a second, 250 over a whole number.',
  'hover_height_m': 'Where all hover, and where a message leads to, in m.',
  'camera_width_px': "Width of the observers' images, in pixels.",
  'camera_height_px': "Height of the observers' images, in pixels.",
  'camera_fovy_deg': 'Vertical field of view of these images, in degrees.',
  'camera': 'How images are rendered; the picture is the same.',
  'eye_offset_m': "How far an eye is ahead of its vehicle's centre, in m.",
  'floor': 'The floor of the room.',
  'walls': 'The walls of the room.',
  'sun': 'A low sun, with shadows on the floor.',
  'brightness': 'Brightness of every light, 1 as designed.',
  'shadows': 'Whether lights cast shadows; slower.',
  'bystanders': 'How many other vehicles fly behind the performer, 4 at most.',
  'occluder_every_s': 'Mean time between passes of a board, in s; 0 is none.',
  'occluder_width_m': 'Width of the board, in m.',
  'occluder_mps': 'Speed of the board, in m/s.',
  'performer_drift_m': "Rms of the performer's drift along each axis, in m.",
  'observer_drift_m': "Rms of each observer's drift along each axis, in m.",
  'observer_yaw_drift_deg': "Rms of each observer's drift in heading.",
  'drift_time_s': 'Time in which a drift becomes another, in s.',
  'step_gain': 'Factor of brightness from --step_s on; 1 is none.',
  'step_s': 'When brightness changes, in s.',
  'flicker_share': 'Amplitude of flicker, as a share of brightness.',
  'flicker_hz': 'Frequency of flicker, in Hz.',
  'exposure_s': 'Exposure of an image, in s: motion is blended in.',
  'noise_sigma': 'Gaussian noise of images, in grey levels.',
  'photons': 'Photons at full white, for shot noise; 0 is none.',
  'blackout_s': 'When images turn black, in s.',
  'blackout_length_s': 'How long images are black, in s; 0 is never.',
  'blackout_share': 'Share of the width of images that turns black.',
  'repeated_share': 'Probability that the last image comes with a new time.',
  'freeze_s': 'When images freeze, in s.',
  'freeze_length_s': 'How long images are frozen, in s; 0 is never.',
  'late_frames': 'How many frames late images come, with their own times.',
  'dropped_share': 'Probability that no image comes in a frame.',
  'initial_hover_s': 'Stillness before START, in s.',
  'settle_s': 'Stillness after a gesture, in s.',
  'gap_s': 'Hover gap between gestures, in s.',
  'lead_in_s': 'Stillness before a gesture, in s.',
  'clock_rate': 'By what share the paces of two clocks may differ.',
  'clock_delay_s': 'How much later one motion may be seen than another, in s.',
  'half_width_m': 'Half width, and height, of a V, in m.',
  'start_height_m': 'How far START climbs, in m.',
  'gesture_s': 'Time that a gesture takes, in s.',
  'heading_step_deg': 'Angle of one heading count, in degrees.',
  'distance_unit_m': 'Length of one distance count, in m.',
  'heading_bits': "Bits of the payload's heading.",
  'distance_bits': "Bits of the payload's distance.",
}
_CHOICES = {
  'control': scenario.CONTROLS,
  'layout': scenario.LAYOUTS,
  'camera': optics.CAMERAS,
  'floor': appearance.FLOORS,
  'walls': appearance.WALLS,
  'sun': appearance.SUNS,
}


def define() -> None:
  """Defines the flags for the launcher that calls this."""
  for name, default in scenario_fields.defaults().items():
    text = _HELP[name]
    if name in _CHOICES:
      text = f'{text} One of {", ".join(_CHOICES[name])}.'
    match default:
      case bool():
        flags.DEFINE_boolean(name, default, text)
      case str():
        flags.DEFINE_string(name, default, text)
      case int():
        flags.DEFINE_integer(name, default, text)
      case _:
        flags.DEFINE_float(name, default, text)


def read() -> scenario.Scenario:
  """The scenario that the flags make.

  Raises:
    WaggleError: if a value breaks a rule of the scenario.
  """
  return scenario_fields.make(values())


def values() -> dict[str, Any]:
  """What the flags say, by the names of `scenario_fields`."""
  return {name: flags.FLAGS[name].value for name in scenario_fields.defaults()}
