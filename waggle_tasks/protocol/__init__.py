"""The language that performer and observers agree on: pure, no simulator."""
