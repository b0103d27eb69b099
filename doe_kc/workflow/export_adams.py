"""A tuned axle back into the ADAMS/Car files that it came from: copies with only the changed numbers changed.

Numbers are set one pass after the other, each pass reading its own result back, until the import of the
copies is the axle: what one number moves along with another (a spring's length with a hardpoint) follows.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from doe_kc.adams.bushing_orientation import direction_rule
from doe_kc.adams.conversion import Conversion
from doe_kc.adams.import_axle import AdamsSource
from doe_kc.adams.teim_orbit import read_teim_orbit
from doe_kc.adams.write_back import FileChanges, rewrite_comment
from doe_kc.axle.model import Axle
from doe_kc.axle_types.read import DEFAULT_TYPE
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import make_folder, write_whole
from doe_kc.workflow.adams_correction import ExportRemarks, correct_copies
from doe_kc.workflow.adams_difference import folded, unwritten_sentences
from doe_kc.workflow.import_adams import import_adams

PASSES = 8
"""Corrections until the import of the copies is the axle."""


@dataclass(frozen=True)
class AdamsExport:
    """files: written, in the folder. changed: copies that differ, with the number of lines that do. added:
    property files of a new name. unwritten: sentences, what had no place. axle: import of the files."""

    files: tuple[Path, ...]
    changed: Mapping[Path, int]
    added: tuple[Path, ...]
    unwritten: tuple[str, ...]
    axle: Axle


def export_adams(axle: Axle, source: AdamsSource, out: Path) -> AdamsExport:
    """Write copies of the files of `source` into `out` with what `axle` has else.

    InputError as `import_adams`, for an axle of another type, and where `out` holds files already or is
    where the originals are.
    """
    base = import_adams(source)
    own, original = axle.topology.structure.type, base.conversion.structure
    if own != (DEFAULT_TYPE if original is None else original.type):
        raise InputError(
            f"{source.paths[0]}: is a {base.conversion.names.type}, the axle to export is a "
            f"{own}; name the files it was imported from."
        )
    copies, moved = _copy(base.conversion, source, out)
    wanted = folded(axle)
    remarks = ExportRemarks()
    result = base
    for _ in range(PASSES):
        result = import_adams(moved)
        if not correct_copies(wanted, result, remarks):
            break
    result = import_adams(moved)
    turned = tuple(_set_comments(base.conversion, result.conversion))
    files = tuple(sorted(p for p in out.rglob("*") if p.is_file()))
    return AdamsExport(
        files,
        {copy: count for old, copy in copies.items() if (count := _lines_changed(old, copy))},
        tuple(path for path in files if path not in copies.values()),
        (*turned, *remarks.sentences, *unwritten_sentences(axle, wanted, result)),
        result.axle,
    )


def _copy(c: Conversion, source: AdamsSource, out: Path) -> tuple[dict[Path, Path], AdamsSource]:
    """Copies of all files below their common folder, and the source that names the copies."""
    originals = list(dict.fromkeys(path.resolve() for path in c.files))
    root = Path(os.path.commonpath([path.parent for path in originals]))
    target = out.resolve()
    if target == root or target in root.parents or root in target.parents:
        raise InputError(f"--out {out}: is where the original files are; name another folder.")
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise InputError(
            f"--out {out}: is not an empty folder; name another, so that nothing old is among it."
        )
    make_folder(out)
    copies = {path: out / path.relative_to(root) for path in originals}
    for path, copy in copies.items():
        content = read_bytes(path, "file")
        write_whole(copy, lambda p, content=content: p.write_bytes(content))  # type: ignore[misc]
    named = [copies[path.resolve()] for path in source.paths if path.resolve() in copies]
    if not named:
        assembly = c.database.assembly
        named = [copies[(assembly.path if assembly else s.path).resolve()] for s in c.database.subsystems]
    return copies, replace(source, paths=tuple(dict.fromkeys([*named, out])), type=c.names.type)


def _lines_changed(old: Path, new: Path) -> int:
    before, lines = (read_bytes(path, "file").splitlines() for path in (old, new))
    blocks = difflib.SequenceMatcher(None, before, lines, autojunk=False).get_matching_blocks()
    return len(lines) - sum(block.size for block in blocks)


def _set_comments(base: Conversion, c: Conversion) -> Iterator[str]:
    """Orientation comments of bushings that lie between points, brought to where these are; sentences."""
    for name, names in c.names.bushings.items():
        place, before, after = c.elements.get(name), direction_rule(base, names), direction_rule(c, names)
        if place is None or before is None or after is None or np.allclose(before, after, atol=1e-12):
            continue
        z = c.frame.signs * c.axes[name][:, 2]
        if "ORIENTATION_ZP1" in place.element.block.entries:
            continue
        changes = FileChanges(read_teim_orbit(place.subsystem.path, "subsystem file (.sub)"))
        block = next(b for b in changes.file.blocks if b.line == place.element.block.line)
        if rewrite_comment(changes, block, after if z @ after > 0 else -after):
            changes.write()
            angle = float(np.degrees(np.arccos(min(1.0, float(before @ after)))))
            yield (
                f"bushing {name}: ADAMS turns it by {angle:.2g} deg with the points it lies between, the "
                "axle does "
                "not; its comment says where it lies now"
            )
