"""The quasi-static K&C solver of an axle."""
