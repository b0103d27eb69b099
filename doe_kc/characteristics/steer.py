"""Steering input."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="steer.steering_ratio",
        label="Steering ratio",
        symbol="d delta / d delta_H",
        unit="deg/deg",
        load_case="steer",
        response="toe",
        objective=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)
