"""Surrogates of the true solver: one model a characteristic, chosen by cross-validation."""
