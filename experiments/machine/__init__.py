"""This machine: its renderer, its packages, its terminal and its files."""
