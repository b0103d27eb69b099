"""Production scatter: what a design's cars differ by, and what of it matters."""
