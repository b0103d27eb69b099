"""doe_kc: make a suspension simulation agree with the measured car."""

__version__ = "0.1.0"
