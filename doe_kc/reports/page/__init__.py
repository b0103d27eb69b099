"""The report pages, one module each: a self-contained HTML file made of sections."""
