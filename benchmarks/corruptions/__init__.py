"""Corruptions of rig records, and whether the checks tell them."""
