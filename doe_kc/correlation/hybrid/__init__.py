"""Several searches, global and local, that share one archive of true evaluations."""
