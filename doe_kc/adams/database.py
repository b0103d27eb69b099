"""Which files of an ADAMS/Car database belong to an axle: assembly, subsystems, property files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from doe_kc.adams.subsystem import (
    AdamsParameter,
    AdamsSubsystem,
    parameters_of,
    subsystem_of,
    subsystem_role,
)
from doe_kc.adams.teim_orbit import TeimOrbitFile, is_binary, read_teim_orbit
from doe_kc.ground.errors import InputError

AXLE_ROLES = ("suspension", "steering", "antirollbar", "anti_roll_bar", "wheel")
"""Roles of subsystems that an axle is made of."""
DATABASE_SUFFIX = ".cdb"
MOST_FILES = 5000
"""Of a folder that is looked through."""
NAME_LENGTH = 255
"""bytes of a file's name; what file systems take at most."""


@dataclass(frozen=True)
class AdamsDatabase:
    """What was found for one axle.

    subsystems: of the axle's roles. assembly: the `.asy`, None where subsystems were named. parameters: of
    the assembly. roots: folders in which files are looked for, the nearest first. left_out: sentences.
    """

    subsystems: tuple[AdamsSubsystem, ...]
    assembly: TeimOrbitFile | None
    parameters: tuple[AdamsParameter, ...]
    roots: tuple[Path, ...]
    left_out: list[str] = field(default_factory=list)

    def property_path(self, name: str, where: str) -> Path:
        """The file that a `PROPERTY_FILE` names; InputError when it is missing or there are two."""
        return resolved(name, self.roots, where)


def read_database(paths: Sequence[Path], axle_end: str) -> AdamsDatabase:
    """Database from subsystems, an assembly, or a folder.

    axle_end: `front` or `rear`: subsystems of the other end are left out. A folder beside files is where
    their property files may be. InputError for what is missing or could be two things.
    """
    for path in paths:
        if not _there(path):
            raise InputError(f"{path}: there is no such file or folder; check the path.")
    folders = [path for path in paths if path.is_dir()]
    files = [path for path in paths if not path.is_dir()]
    if not files:
        files = _chosen(folders)
    roots = tuple(dict.fromkeys([*(r for f in files for r in _roots_of(f)), *folders]))
    assembly, subs, left_out = None, list[Path](), list[str]()
    for path in files:
        if path.suffix.lower() == ".asy":
            if assembly is not None:
                raise InputError(f"{path}: is a second assembly beside {assembly.path}; name one.")
            assembly, more = _assembly(path, roots, left_out)
            subs += more
        elif path.suffix.lower() == ".sub":
            subs.append(path)
        else:
            raise InputError(
                f"{path}: is no subsystem (.sub), assembly (.asy) or folder; name one of these, its property "
                "files are found by it."
            )
    subsystems = _of_axle(list(dict.fromkeys(subs)), axle_end, left_out)
    parameters = () if assembly is None else tuple(parameters_of(assembly))
    for subsystem in subsystems:
        _note_template(subsystem, roots, left_out)
    return AdamsDatabase(tuple(subsystems), assembly, parameters, roots, left_out)


def _chosen(folders: list[Path]) -> list[Path]:
    """The only assembly of a folder, else its only set of subsystems."""
    if len(folders) != 1:
        raise InputError(
            f"{', '.join(map(str, folders)) or 'import'}: expected one folder, or files; "
            "name the assembly (.asy) or the subsystems (.sub)."
        )
    found_files = list(_walk(folders[0]))
    assemblies = [p for p in found_files if p.suffix.lower() == ".asy"]
    if len(assemblies) == 1:
        return assemblies
    subs = [p for p in found_files if p.suffix.lower() == ".sub"]
    if assemblies or not subs:
        names = ", ".join(str(p) for p in assemblies[:6]) or "none"
        raise InputError(
            f"{folders[0]}: holds {len(assemblies)} assemblies ({names}) and {len(subs)} subsystems; "
            "name the one that is meant."
        )
    return subs


def _walk(folder: Path) -> Iterable[Path]:
    for count, path in enumerate(sorted(folder.rglob("*"))):
        if count >= MOST_FILES:
            raise InputError(
                f"{folder}: holds more than {MOST_FILES} files; name the assembly (.asy) itself."
            )
        if path.is_file():
            yield path


def _roots_of(path: Path) -> list[Path]:
    """Folders of a file's own database: the file's, and the one above its table."""
    parent = path.parent if path.parent.name else path.resolve().parent
    above = [p for p in parent.parents if p.suffix.lower() == DATABASE_SUFFIX][:1]
    table = [parent.parent] if parent.suffix.lower() == ".tbl" else []
    return [path.parent, *table, *above]


def resolved(name: str, roots: Sequence[Path], where: str) -> Path:
    """The file that a database path such as `<OWN>/bushings.tbl/a.bus` or `mdids://OWN/…` names.

    The alias is looked for as a folder of that name among the roots, then left away. Case does not count.
    InputError, `where` before it, when there is none.
    """
    plain = name.replace("\\", "/").strip()
    alias = ""
    if plain.lower().startswith("mdids://"):
        alias, _, plain = plain[8:].partition("/")
    elif plain.startswith("<"):
        alias, _, plain = plain[1:].partition(">")
    parts = [part for part in PurePosixPath(plain).parts if part not in ("/", "", ".")]
    too_long = any(len(part.encode()) > NAME_LENGTH for part in parts)
    if not parts or ".." in parts or "\0" in plain or too_long:
        raise InputError(f"{where}: names the file {name!r}, which is no path of a database; correct it.")
    own = [root for root in roots if root.resolve().stem.lower() == alias.lower()]
    for root in (*own, *roots):
        for tail in (parts, parts[-1:]):
            path = _without_case(root, tail)
            if path is not None:
                return path
    raise InputError(
        f"{where}: its file {name} is missing; looked in {', '.join(str(r) for r in roots)}. "
        "Add the folder of its database as a further path."
    )


def _there(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # a name that no file system takes
        return False


def _without_case(folder: Path, parts: Sequence[str]) -> Path | None:
    """A file below a folder, whatever the case of its name."""
    for part in parts:
        exact = folder / part
        if exact.exists():
            folder = exact
            continue
        try:
            match = next((p for p in sorted(folder.iterdir()) if p.name.lower() == part.lower()), None)
        except OSError:
            match = None
        if match is None:
            return None
        folder = match
    return folder if not folder.is_dir() else None


def _assembly(path: Path, roots: Sequence[Path], left_out: list[str]) -> tuple[TeimOrbitFile, list[Path]]:
    file = read_teim_orbit(path, "assembly file (.asy)")
    kind = file.cell(file.one("MDI_HEADER"), "FILE_TYPE")
    if kind.text.lower() != "asy":
        raise InputError(f"{path}: line {kind.line}: FILE_TYPE is {kind.text!r}, expected 'asy'.")
    subs = []
    for block in file.all_of("SUBSYSTEM"):
        usage = file.cell(block, "USAGE")
        where = f"{path}: line {usage.line}: [SUBSYSTEM]"
        try:
            sub = resolved(usage.text, roots, where)
        except InputError:
            if not usage.text.lower().endswith(".sub"):
                raise
            left_out.append(f"{path.name}: its subsystem {usage.text} is not there")
            continue
        if sub.suffix.lower() != ".sub":
            circle = ", itself" if sub.resolve() == path.resolve() else ""
            raise InputError(
                f"{where}: names {usage.text}{circle}; expected a subsystem (.sub), not another kind of file."
            )
        subs.append(sub)
    if not file.has("SUBSYSTEM"):
        raise InputError(f"{path}: has no block [SUBSYSTEM]; expected those of an axle. Is the file cut off?")
    if not subs:
        raise InputError(
            f"{path}: none of its subsystems is there ({'; '.join(left_out)}); "
            "add the folder of their database as a further path."
        )
    return file, subs


def _of_axle(paths: list[Path], axle_end: str, left_out: list[str]) -> list[AdamsSubsystem]:
    """Those of the axle's roles at its end; InputError for two of one role, or no suspension."""
    chosen: dict[str, TeimOrbitFile] = {}
    roles = []
    for path in paths:
        file = read_teim_orbit(path, "subsystem file (.sub)")
        own = subsystem_role(file)
        roles.append(f"{path.name} ({own.role}, {own.minor_role})")
        if own.role not in AXLE_ROLES or own.minor_role not in (axle_end, "any"):
            left_out.append(
                f"{path.name}: subsystem {own.role}, {own.minor_role}, is of another part of the car"
            )
        elif own.role in chosen:
            raise InputError(
                f"{path}: is a second subsystem {own.role} of the {axle_end} axle beside "
                f"{chosen[own.role].path}; name the files that belong together."
            )
        else:
            chosen[own.role] = file
    if "suspension" not in chosen:
        raise InputError(
            f"{paths[0] if paths else 'import'}: there is no suspension of the {axle_end} axle among "
            f"{', '.join(roles) or 'nothing'}; name its subsystem, or give --type for the other end."
        )
    return [subsystem_of(chosen[role]) for role in AXLE_ROLES if role in chosen]


def _note_template(subsystem: AdamsSubsystem, roots: Sequence[Path], left_out: list[str]) -> None:
    """What a template would say is not read; told whether it is there and binary."""
    try:
        path = resolved(subsystem.template, roots, str(subsystem.path))
        words = "binary, not read" if is_binary(path) else "there, not read"
    except InputError:
        words = "not there"
    left_out.append(
        f"{subsystem.path.name}: template {subsystem.template} is {words}; topology is that of the axle type"
    )
