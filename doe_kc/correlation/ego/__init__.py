"""Composite efficient global optimization: surrogates of the outputs, the rating computed on them."""
