"""The tasks: what is danced, what is seen, what ends an episode."""
