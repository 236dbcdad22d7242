"""The flight room, its views, and the layouts observers stand in."""
