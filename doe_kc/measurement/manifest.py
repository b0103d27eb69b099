"""`test.toml`: what the test engineer hands over with the records, and its faults as sentences for him."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from doe_kc.ground.errors import InputError, nearest
from doe_kc.load_cases import LOAD_CASES
from doe_kc.measurement.channel_map import ChannelMap, channel_map, named_map
from doe_kc.measurement.map_file import MapFile


def refuse_unknown(path: Path, data: Mapping[str, Any], model: type[BaseModel], prefix: str = "") -> None:
    """InputError for a key that `model` does not know, with the nearest known one.

    Where a model allows further keys, only those are refused that look like a known key misspelt.
    """
    known = list(model.model_fields)
    for key, value in data.items():
        if key not in known:
            if _tolerated(key, known, model):
                continue
            raise InputError(
                f"{path}: key {prefix}{key} is unknown, expected one of {', '.join(known)};"
                f"{nearest(key, known)} Rename or delete it."
            )
        inner = _submodel(model.model_fields[key].annotation)
        if inner is not None and isinstance(value, dict):
            refuse_unknown(path, value, inner, f"{prefix}{key}.")


def _tolerated(key: str, known: list[str], model: type[BaseModel]) -> bool:
    misspelt = bool(difflib.get_close_matches(key, known, n=1, cutoff=0.8))
    return model.model_config.get("extra") == "allow" and not misspelt


def _submodel(annotation: Any) -> type[BaseModel] | None:
    options = get_args(annotation) if get_origin(annotation) in (Union, UnionType) else (annotation,)
    for option in options:
        if isinstance(option, type) and issubclass(option, BaseModel):
            return option
    return None


def sentence(path: Path, error: ValidationError) -> str:
    """The first fault of a validation error: file, key, what was expected, what to do."""
    fault = error.errors(include_url=False)[0]
    if fault["type"] == "value_error":
        return f"{path}: {fault['ctx']['error']}."
    key = ".".join(str(part) for part in fault["loc"])
    if fault["type"] == "missing":
        return f"{path}: key {key} is missing; expected it in the file, add it."
    expected = fault["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    return f"{path}: key {key} = {_short(fault['input'])}, expected {expected}; correct the value."


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0)]
Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-45.0, le=45.0)]
Text = Annotated[str, Field(strict=True)]


class _Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Setup(_Section):
    """How the rig was set up. Further keys are kept as notes.

    reference_wheel_load_N: static load per wheel the axle was loaded to, N. lateral_offset_mm: distance
    of the force behind the contact point in `lateral_offset`. rack_mm_per_rev: rack travel per
    steering-wheel turn.
    """

    model_config = ConfigDict(frozen=True, extra="allow")

    loading: Text = ""
    reference_wheel_load_N: Positive | None = None
    body: Text = ""
    steering: Text = ""
    lateral_offset_mm: Finite = 30.0
    rack_mm_per_rev: Positive = 52.0


class RigState(_Section):
    """What state the car was in, as far as it changes the model. Further keys (engine, tyre pressure) are
    kept as notes.

    arb: whether the anti-roll bar of the measured axle was connected.
    """

    model_config = ConfigDict(frozen=True, extra="allow")

    arb: Literal["on", "off"] = "on"


class SideAlignment(_Section):
    """Static angles of one wheel at ride height, deg.

    Toe-in +, camber top outwards +, caster top rearwards +.
    caster_deg is that of the design kingpin line carried by the knuckle: the static `spin`.
    """

    toe_deg: Angle | None = None
    camber_deg: Angle | None = None
    caster_deg: Angle | None = None


class AlignmentSd(_Section):
    """Standard deviation of the bench's angles, deg; defaults are those of a good alignment bench."""

    toe_deg: Positive = 0.01
    camber_deg: Positive = 0.01
    caster_deg: Positive = 0.02


class Alignment(_Section):
    """Both wheels; None where the bench gave nothing."""

    left: SideAlignment | None = None
    right: SideAlignment | None = None
    sd: AlignmentSd = AlignmentSd()


class SensorResolution(_Section):
    """Resolution of the rig's sensors; the defaults are those of an ordinary K&C rig."""

    angle_deg: Positive = 0.003
    displacement_mm: Positive = 0.02
    tyre_load_N: Positive = 4.0


class CheckOptions(_Section):
    """accept: globs of findings, as `sign.vertical.pad_z`, that the test engineer has looked at: they are
    told
    as warnings and stop nothing."""

    accept: tuple[Text, ...] = ()


class Manifest(_Section):
    """The whole file. `records`: load case -> files, main run first, then its repeats.

    axle: a note, which axle was tested. channels: the channel map: a preset's name, the path of a map file
    from this file's folder, or the map itself.
    """

    name: Annotated[str, Field(strict=True, min_length=1)]
    axle: Text = ""
    setup: Setup = Setup()
    state: RigState = RigState()
    alignment: Alignment | None = None
    sensor_resolution: SensorResolution = SensorResolution()
    channels: Text | MapFile = "doe_kc"
    checks: CheckOptions = CheckOptions()
    records: Annotated[dict[str, tuple[Text, ...]], Field(min_length=1)]

    @field_validator("records", mode="before")
    @classmethod
    def _files(cls, value: Any) -> Any:
        if isinstance(value, dict):
            return {case: _file_list(files) for case, files in value.items()}
        return value

    @model_validator(mode="after")
    def _known_cases(self) -> Manifest:
        for case, files in self.records.items():
            _check_case(case, files)
        return self


def _file_list(files: Any) -> Any:
    """One file may stand without its list."""
    return (files,) if isinstance(files, str) else files


def _check_case(case: str, files: tuple[str, ...]) -> None:
    if case not in LOAD_CASES:
        raise ValueError(
            f"records.{case}: is no load case, expected one of {', '.join(LOAD_CASES)};"
            f"{nearest(case, LOAD_CASES)} Rename the key"
        )
    if not files or not all(f.strip() for f in files):
        raise ValueError(
            f"records.{case}: names no file, expected the main run first; add it or drop the key"
        )
    if len(set(files)) < len(files):
        raise ValueError(
            f"records.{case}: lists the same file twice, expected different runs; "
            "a copy would pass for perfect repeatability"
        )


def load_manifest(path: Path) -> Manifest:
    """Read and check a `test.toml`.

    Raises InputError with one sentence naming file, key, expectation and remedy.
    """
    data = _parse(path)
    refuse_unknown(path, data, Manifest)
    try:
        return Manifest.model_validate(data)
    except ValidationError as error:
        raise InputError(sentence(path, error)) from None


def manifest_channels(path: Path, manifest: Manifest) -> ChannelMap:
    """The channel map of a test. path: of its `test.toml`. InputError for a map that is wrong."""
    if isinstance(manifest.channels, str):
        return named_map(manifest.channels, path.parent, str(path))
    return channel_map(manifest.channels, path.parent, str(path))


def _parse(path: Path) -> dict[str, Any]:
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):
            raise InputError(f"{path}: is a pipe or a device; expected a test.toml on a disk, name that.")
        return tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; expected the rig's test.toml, check the path.") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder; expected a test.toml, name the file inside it.") from None
    except (OSError, ValueError, RecursionError) as error:
        what = " ".join(str(error).split())
        raise InputError(f"{path}: is not readable TOML ({what}); expected UTF-8 TOML, mend it.") from None
