"""Containers of rig records behind one interface: `read_table` gives a `ChannelTable` of any of them."""

from __future__ import annotations

from doe_kc.measurement.containers._registry import CONTAINERS, READABLE, read_table, table_parts

__all__ = ["CONTAINERS", "READABLE", "read_table", "table_parts"]
