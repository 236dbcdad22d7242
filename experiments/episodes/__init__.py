"""Flies an episode, and scores it by truth."""
