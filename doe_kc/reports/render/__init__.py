"""A table as a data frame, a sheet, a page's table, a terminal's lines or JSON records."""
