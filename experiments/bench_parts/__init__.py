"""What `waggle bench` measures, a module for each part."""
