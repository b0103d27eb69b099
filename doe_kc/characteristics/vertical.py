"""Vertical motion: gradients per metre of wheel travel, ride rate per mm of pad travel."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="vertical.camber_change",
        label="Camber change",
        symbol="d gamma / d z",
        unit="deg/m",
        load_case="vertical",
        response="camber",
        abscissa="wheel_travel",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="vertical.bump_steer",
        label="Bump steer",
        symbol="d delta / d z",
        unit="deg/m",
        load_case="vertical",
        response="toe",
        abscissa="wheel_travel",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="vertical.static_caster",
        label="Static caster",
        symbol="tau_0",
        unit="deg",
        load_case="vertical",
        response="spin",
        kind="static",
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="vertical.caster_change",
        label="Caster change",
        symbol="d tau / d z",
        unit="deg/m",
        load_case="vertical",
        response="spin",
        abscissa="wheel_travel",
        scale=1000.0,
        objective=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="vertical.ride_rate",
        label="Ride rate",
        symbol="d F_z / d z_pad",
        unit="N/mm",
        load_case="vertical",
        response="tyre_load",
        abscissa="pad_travel",
        objective=True,
        in_appendix_b=True,
    )
)
