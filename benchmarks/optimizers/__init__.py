"""Correlation methods and their peers on one problem, counted in true-solver evaluations."""
