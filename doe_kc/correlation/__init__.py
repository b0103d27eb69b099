"""Correlation: targets, rating, methods, and what they found."""
