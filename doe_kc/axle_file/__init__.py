"""The axle file: read, checked key by key, and written back (by `write`, which only some commands import)."""

from __future__ import annotations

from doe_kc.axle_file.read import axle_from_document, read_axle

__all__ = ["axle_from_document", "read_axle"]
