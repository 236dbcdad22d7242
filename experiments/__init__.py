"""The launchers of the `waggle` command and what they share."""
