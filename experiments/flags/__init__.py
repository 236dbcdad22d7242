"""Flags that launchers share: of scenarios, receivers and recordings."""
