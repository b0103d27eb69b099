"""Outside models and their twins: cars, searches with other corrections of the twin, report."""
