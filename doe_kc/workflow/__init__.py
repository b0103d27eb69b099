"""The steps of a study, each from checked input to written results."""
