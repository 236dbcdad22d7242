"""Pages that people read: static HTML that needs neither server nor network."""
