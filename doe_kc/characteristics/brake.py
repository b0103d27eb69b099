"""Brake force: compliances per kN, load transfer in percent."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="brake.brake_steer",
        label="Brake steer",
        symbol="d delta / d F_x",
        unit="deg/kN",
        load_case="brake",
        response="toe",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="brake.wind_up",
        label="Wind-up",
        symbol="d tau / d F_x",
        unit="deg/kN",
        load_case="brake",
        response="spin",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="brake.anti_dive",
        label="Load transfer (anti-dive)",
        symbol="d F_z / d F_x",
        unit="%",
        load_case="brake",
        response="tyre_load",
        scale=100.0,
        objective=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="brake.wc_longitudinal_disp",
        label="WC longitudinal displacement",
        symbol="d x / d F_x",
        unit="mm/kN",
        load_case="brake",
        response="wc_x",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)
