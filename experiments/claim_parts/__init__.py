"""What documents say, and what is made to see whether it is so."""
