"""Designs of experiments over the parameters of an axle."""
