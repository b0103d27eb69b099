"""Finds the physical effect that a model lacks: where it disagrees, what explains it, how sure that is."""
