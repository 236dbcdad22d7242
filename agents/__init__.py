"""What an observer runs: receivers, the navigator and their agent."""
