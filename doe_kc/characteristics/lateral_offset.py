"""Lateral force 30 mm behind the contact point: compliances per kN."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="lateral_offset.camber_change",
        label="Camber change",
        symbol="d gamma / d F_y",
        unit="deg/kN",
        load_case="lateral_offset",
        response="camber",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="lateral_offset.toe_change",
        label="Toe change",
        symbol="d delta / d F_y",
        unit="deg/kN",
        load_case="lateral_offset",
        response="toe",
        scale=1000.0,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="lateral_offset.wc_lateral_disp",
        label="WC lateral displacement",
        symbol="d y / d F_y",
        unit="mm/kN",
        load_case="lateral_offset",
        response="wc_y",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)
