"""Vertical motion: gradients per metre of wheel travel, ride rate per mm of pad travel.

A rig sees caster only as the rotation of the wheel, so the entry that is compared with a measurement
(Appendix B, caster compensation) reads the kingpin line carried by the knuckle; the caster columns of
Appendix C are those of the kingpin axis itself, LWB to UPB, which only a model knows: with it the
published column correlates to 0.99, with the carried line to 0.88.
"""

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
        label="Static caster, kingpin",
        symbol="tau_k0",
        unit="deg",
        load_case="vertical",
        response="caster",
        kind="static",
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="vertical.caster_change",
        label="Caster change, kingpin",
        symbol="d tau_k / d z",
        unit="deg/m",
        load_case="vertical",
        response="caster",
        abscissa="wheel_travel",
        scale=1000.0,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="vertical.caster_compensation",
        label="Caster compensation",
        symbol="d tau / d z",
        unit="deg/m",
        load_case="vertical",
        response="spin",
        abscissa="wheel_travel",
        scale=1000.0,
        objective=True,
        in_appendix_b=True,
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
