"""Roll motion: gradients per metre of wheel travel in the body, roll rate per mm of pad travel."""

from __future__ import annotations

from doe_kc.characteristics._base import Characteristic, characteristic

characteristic(
    Characteristic(
        id="roll.camber_change",
        label="Camber change",
        symbol="d gamma / d z",
        unit="deg/m",
        load_case="roll",
        response="camber",
        abscissa="wheel_travel",
        scale=1000.0,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="roll.roll_steer",
        label="Roll steer",
        symbol="d delta / d z",
        unit="deg/m",
        load_case="roll",
        response="toe",
        abscissa="wheel_travel",
        scale=1000.0,
        in_appendix_b=True,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="roll.wc_lateral_disp",
        label="WC lateral displacement",
        symbol="d y / d z",
        unit="mm/m",
        load_case="roll",
        response="wc_y",
        abscissa="wheel_travel",
        scale=1000.0,
        in_appendix_c=True,
    )
)

characteristic(
    Characteristic(
        id="roll.roll_rate",
        label="Roll rate",
        symbol="d F_z / d z_pad",
        unit="N/mm",
        load_case="roll",
        response="tyre_load",
        abscissa="pad_travel",
        in_appendix_b=True,
    )
)
