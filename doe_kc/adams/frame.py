"""The frame of a database: its axes in this project's (X rearwards, Y right, Z up, ground at z = 0)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class AdamsFrame:
    """signs: (3,) +1 or -1, of x, y, z. ground: height of the ground in mm, after the signs."""

    signs: FloatArray
    ground: float = 0.0

    def place(self, point: FloatArray) -> FloatArray:
        """(3,) mm of a point of the files in the chassis frame."""
        return np.asarray(self.signs * point - np.array([0.0, 0.0, self.ground]))

    def direction(self, vector: FloatArray) -> FloatArray:
        """(3,) components of a direction of the files in the chassis frame."""
        return np.asarray(self.signs * vector)

    def words(self) -> str:
        """`X rearwards, Y right, Z up`."""
        x, y, z = self.signs
        return (
            f"X {'rearwards' if x > 0 else 'forwards'}, Y {'right' if y > 0 else 'left'}, "
            f"Z {'up' if z > 0 else 'down'}"
        )


def frame_signs(x: float | None, y: float | None, z: float | None) -> FloatArray:
    """(3,) signs of a right-handed frame, one of them perhaps left open (None).

    ValueError for a left-handed one, or more than one open.
    """
    known = [s for s in (x, y, z) if s is not None]
    product = float(np.prod(known))
    if len(known) == 3 and product < 0:
        raise ValueError("these axes are left-handed")
    if len(known) < 2:
        raise ValueError("two axes are open")
    return np.array([product if s is None else s for s in (x, y, z)])
