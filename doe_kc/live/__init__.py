"""The live page: an axle explored by hand, every picture of it the true model's."""
