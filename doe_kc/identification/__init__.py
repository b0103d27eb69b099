"""An axle from its influence matrix."""
