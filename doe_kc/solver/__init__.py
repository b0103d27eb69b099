"""The quasi-static K&C solver of a McPherson front axle."""
