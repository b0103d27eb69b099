"""Effects hidden in synthetic rig records, and how well an analyser names them."""
