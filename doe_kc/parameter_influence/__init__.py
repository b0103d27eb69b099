"""The parameter-influence study: one at a time and exact."""
