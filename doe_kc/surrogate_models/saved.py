"""A surrogate in a file of its own: variables with bounds, outputs with units, the chosen models, their
quality."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import write_whole
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.codec import UnreadableModel, decode, encode
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.variables import Tie

TAG = "doe-kc surrogate 3"
"""Format and its version, the first entry of the header."""


@dataclass(frozen=True)
class Input:
    """A variable: lower, upper, start absolute in `unit`. logarithmic: equal steps are equal ratios."""

    path: str
    unit: str
    lower: float
    upper: float
    start: float
    logarithmic: bool

    def places(self, values: FloatArray) -> FloatArray:
        """u in [0, 1] of absolute values between the bounds; nan for what has no logarithm."""
        if not self.logarithmic:
            return np.asarray((values - self.lower) / (self.upper - self.lower))
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(np.log(values / self.lower) / np.log(self.upper / self.lower))


@dataclass(frozen=True)
class Output:
    """A characteristic. model: id of its surrogate. q2, rmse: left out, rmse in `unit`; nan where unknown."""

    id: str
    label: str
    unit: str
    model: str
    q2: float
    rmse: float


@dataclass(frozen=True)
class SavedSurrogate:
    """inputs: (d,), outputs: (m,). model: over the unit cube, variances calibrated. designs: it was fitted
    to. ties, fixed: parameters of those designs besides, to variables and at values."""

    study: str
    designs: int
    inputs: tuple[Input, ...]
    outputs: tuple[Output, ...]
    model: Fitted
    ties: tuple[Tie, ...] = ()
    fixed: Mapping[str, float] = field(default_factory=dict)

    def places(self, values: FloatArray) -> FloatArray:
        """(p, d) points of the unit cube of absolute values (p, d)."""
        columns = [known.places(column) for known, column in zip(self.inputs, values.T, strict=True)]
        return np.column_stack(columns).reshape(values.shape)

    @property
    def dependent_paths(self) -> tuple[str, ...]:
        """Of every tied and fixed parameter."""
        return (*(tie.follower for tie in self.ties), *self.fixed)

    def dependent(self, values: FloatArray) -> dict[str, FloatArray]:
        """Path -> (p,) of every tied and fixed parameter, of absolute values (p, d)."""
        own = dict(zip((known.path for known in self.inputs), values.T, strict=True))
        tied = {tie.follower: np.array([tie.value(float(x)) for x in own[tie.leader]]) for tie in self.ties}
        return tied | {path: np.full(len(values), value) for path, value in self.fixed.items()}

    def predict(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(p, m) means and standard deviations, in the outputs' units, of absolute values (p, d)."""
        points = self.places(values)
        return self.model.predict(points), np.sqrt(self.model.variance(points))


def save_surrogate(path: Path, saved: SavedSurrogate) -> Path:
    """One compressed file of arrays (NumPy's .npz) with a JSON header; RunError as `write_whole`."""
    document, arrays = encode(saved.model)
    header = {
        "format": TAG,
        "study": saved.study,
        "designs": saved.designs,
        "inputs": [asdict(known) for known in saved.inputs],
        "outputs": [asdict(known) for known in saved.outputs],
        "ties": [asdict(tie) for tie in saved.ties],
        "fixed": dict(saved.fixed),
        "model": document,
    }
    buffer = io.BytesIO()
    text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez_compressed(buffer, header=text, **arrays)  # type: ignore[arg-type]
    return write_whole(path, lambda p: p.write_bytes(buffer.getvalue()))


def load_surrogate(path: Path) -> SavedSurrogate:
    """InputError for a file that is missing, damaged, or no surrogate."""
    content = read_bytes(path, "surrogate")
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        header = json.loads(arrays.pop("header").tobytes())
        if header["format"] != TAG:
            raise InputError(
                f"{path}: is a {header['format']!r}, expected {TAG!r}; write it again with doe-kc surrogates."
            )
        inputs = tuple(Input(**known) for known in header["inputs"])
        outputs = tuple(Output(**known) for known in header["outputs"])
        ties = tuple(Tie(**known) for known in header["ties"])
        fixed = {str(path): float(value) for path, value in header["fixed"].items()}
        model = decode(header["model"], arrays)
        return SavedSurrogate(header["study"], int(header["designs"]), inputs, outputs, model, ties, fixed)
    except InputError:
        raise
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        OSError,
        EOFError,
        zipfile.BadZipFile,
        UnreadableModel,
    ):
        raise InputError(
            f"{path}: is no surrogate; expected the file surrogate.npz that doe-kc surrogates writes."
        ) from None
