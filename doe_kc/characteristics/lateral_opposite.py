"""Lateral force in opposition: compliances per kN."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="lateral_opposite.camber_change",
        label="Camber change",
        symbol="d gamma / d F_y",
        unit="deg/kN",
        load_case="lateral_opposite",
        response="camber",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
    )
)

characteristic(
    Characteristic(
        id="lateral_opposite.toe_change",
        label="Toe change",
        symbol="d delta / d F_y",
        unit="deg/kN",
        load_case="lateral_opposite",
        response="toe",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
    )
)

characteristic(
    Characteristic(
        id="lateral_opposite.wc_lateral_disp",
        label="WC lateral displacement",
        symbol="d y / d F_y",
        unit="mm/kN",
        load_case="lateral_opposite",
        response="wc_y",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
    )
)
