"""What the methods share: archive of outputs, rating on them, trust region, forecast and proposal."""
