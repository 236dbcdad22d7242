"""Videos of an episode: what everyone sees, and what observers make of it."""
