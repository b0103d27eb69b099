"""Containers of rig records behind one interface: `read_table` gives a `ChannelTable` of any of them."""

from __future__ import annotations

from doe_kc.measurement.containers._registry import CONTAINERS, read_table

__all__ = ["CONTAINERS", "read_table"]
