"""Static wheel angles of the left wheel at ride height; caster as the knuckle carries it."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="static.toe",
        label="Static toe",
        symbol="delta_0",
        unit="deg",
        load_case="static",
        response="toe",
        kind="static",
        objective=True,
        constraint=True,
        in_appendix_b=True,
    )
)

characteristic(
    Characteristic(
        id="static.camber",
        label="Static camber",
        symbol="gamma_0",
        unit="deg",
        load_case="static",
        response="camber",
        kind="static",
        objective=True,
        constraint=True,
        in_appendix_b=True,
    )
)

characteristic(
    Characteristic(
        id="static.caster",
        label="Static caster",
        symbol="tau_0",
        unit="deg",
        load_case="static",
        response="spin",
        kind="static",
        objective=True,
        constraint=True,
        in_appendix_b=True,
    )
)
