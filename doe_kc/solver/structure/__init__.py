"""Equations of an axle type that is data: bodies on a tree of joints, loops closed by constraint forces."""
