"""Solvers that turn parameter values into K&C curves: the package's own, or an outside one."""
