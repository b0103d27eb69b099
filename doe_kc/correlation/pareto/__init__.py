"""Trade-offs between load cases: objectives apart, the front of confirmed designs, its knee."""
