"""Many episodes: their cases, and one run of them here or on a cluster."""
