"""The axle file: read, checked key by key, and written back."""

from __future__ import annotations

from doe_kc.axle_file.read import axle_from_document, read_axle
from doe_kc.axle_file.write import write_axle

__all__ = ["axle_from_document", "read_axle", "write_axle"]
