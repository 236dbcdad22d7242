"""What studies found: counts with limits, maps, tables and figures."""
