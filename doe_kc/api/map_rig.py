"""`kc.map`: a channel map for a folder of a rig's own files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.axle import as_axle
from doe_kc.axle.model import Axle
from doe_kc.workflow.map_rig import propose_map

if TYPE_CHECKING:
    import pandas as pd


def map(folder: str | Path, axle: Axle | str | Path | None = None) -> pd.DataFrame:
    """Which rig channel is what, from names, units, ranges and the physics of the data; writes nothing.

    axle: a model of the car, for signs that only it tells. One row a channel, its name as index. Columns:
    quantity; side (L, R, None of the axle); unit (None where nothing tells it); sign (+1, -1); reason, in
    words. `attrs["open"]`: what stays to be said by the user; `attrs["absent"]`: what no file holds.
    InputError where the folder has no table.

    >>> channels = kc.map("examples/front_axle/rig")
    >>> channels.loc["toe_L", "quantity"], channels.attrs["open"]
    ('toe', [])
    """
    import pandas as pd

    proposal = propose_map(Path(folder), None if axle is None else as_axle(axle))
    rows = [(c.name, c.quantity, c.side, c.unit, c.sign, c.reason) for c in proposal.channels]
    frame = pd.DataFrame(rows, columns=["channel", "quantity", "side", "unit", "sign", "reason"])
    frame.attrs = {"open": list(proposal.open), "absent": list(proposal.absent)}
    return frame.set_index("channel")
