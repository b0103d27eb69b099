"""The units that an axle is assembled from, one textbook element a module."""
