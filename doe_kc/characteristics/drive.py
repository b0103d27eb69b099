"""Drive force: compliances per kN, load transfer in percent."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="drive.drive_steer",
        label="Drive steer",
        symbol="d delta / d F_x",
        unit="deg/kN",
        load_case="drive",
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
        id="drive.anti_lift",
        label="Load transfer (anti-lift)",
        symbol="d F_z / d F_x",
        unit="%",
        load_case="drive",
        response="tyre_load",
        scale=100.0,
        objective=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="drive.wc_longitudinal_disp",
        label="WC longitudinal displacement",
        symbol="d x / d F_x",
        unit="mm/kN",
        load_case="drive",
        response="wc_x",
        scale=1000.0,
        objective=True,
        constraint=True,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)
