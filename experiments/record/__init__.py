"""What happened in an episode, as values and as files; nothing here flies."""
