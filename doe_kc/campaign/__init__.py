"""Campaigns: true-solver evaluations in parallel, stored, never run twice."""
