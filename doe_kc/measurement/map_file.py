"""The channel map as users write it: `[channels]` in `test.toml`, a map file of its own, or a preset."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.fields import Finite, Positive, Strict
from doe_kc.ground.files import read_toml, validate

Quantity = Literal[
    "time", "pad_z", "roll", "force_x", "force_y", "steering_wheel",
    "toe", "camber", "caster", "wc_x", "wc_y", "wc_z", "tyre_load",
]  # fmt: skip
Frame = Literal["doe_kc", "adams", "iso_8855", "sae_j670"]
LoadCaseName = Literal[
    "vertical", "roll", "lateral", "lateral_opposite", "lateral_offset", "drive", "brake", "steer"
]
PRESETS = "doe_kc.measurement.presets"


class MapEntry(Strict):
    """What one rig channel is: value = sign * scale * (recorded - offset), in `unit`.

    quantity: of this package. side: of the wheel; by default from `{side}` in the channel's name, None for
    what both wheels share. unit: by default that of the heading. offset: in the channel's unit. cases: load
    cases in which the channel is this, by default all.
    """

    quantity: Quantity
    side: Literal["L", "R"] | None = None
    unit: Annotated[str, Field(min_length=1)] | None = None
    sign: Literal[1, -1] = 1
    scale: Positive = 1.0
    offset: Finite = 0.0
    cases: list[LoadCaseName] = Field(default=[])


class MapSides(Strict):
    """What `{side}` stands for in the rig's names."""

    L: str = "L"
    R: str = "R"


class MapFile(Strict):
    """The whole map.

    preset: a preset or file whose entries count for the quantities that `map` leaves out. frame: the rig's
    axes, for displacements and wheel forces. absent: what the rig does not measure: a quantity (`caster`), a
    channel (`caster_R`), a wheel (`R`), `time`. map: rig channel -> what it is, or several for several cases.
    """

    schema_: Literal["doe_kc.channels/1"] = Field(default="doe_kc.channels/1", alias="schema")
    preset: str | None = None
    frame: Frame | None = None
    sides: MapSides = MapSides()
    absent: list[str] = Field(default=[])
    map: dict[str, list[MapEntry]] = Field(default={})

    @field_validator("map", mode="before")
    @classmethod
    def _entries(cls, value: Any) -> Any:
        if isinstance(value, dict):
            return {name: [e] if isinstance(e, dict) else e for name, e in value.items()}
        return value


def preset_names() -> list[str]:
    """Presets that ship with the package."""
    files = resources.files(PRESETS).iterdir()
    return sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml"))


def read_map(name: str, folder: Path, source: str) -> tuple[MapFile, str]:
    """A preset by its name or a map file by its path from `folder`, and where it is.

    source: the file that names it, for the message. InputError for one that is neither, or wrong.
    """
    if name in preset_names():
        path = Path(str(resources.files(PRESETS).joinpath(f"{name}.toml")))
        return validate(MapFile, read_toml(path), f"preset {name}"), f"preset {name}"
    path = folder / name
    if not path.suffix and not path.exists():
        known = preset_names()
        raise InputError(
            f'{source}: channels names "{name}", which is neither a preset ({", ".join(known)}) nor a file; '
            f"correct it.{nearest(name, known)}"
        )
    return validate(MapFile, read_toml(path), str(path)), str(path)
