"""The floors of the package, and one meaning for each name."""

from __future__ import annotations

import ast
from collections import defaultdict
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import doe_kc

ROOT = Path(doe_kc.__file__).parent
FLOORS = [
    "ground",
    "load_cases",
    "curves",
    "axle",
    "axle_types",
    "effects",
    "axle_file",
    "adams",
    "characteristics",
    "solver",
    "measurement",
    "targets",
    "variables",
    "sampling",
    "true_solver",
    "campaign",
    "parameter_influence",
    "surrogate_models",
    "production_scatter",
    "correlation",
    "discovery",
    "identification",
    "study",
    "examples",
    "reports",
    "workflow",
    "live",
    "api",
    "cli",
]
"""A module imports from its own floor and those before it."""
LINES_MOST = 300
TABLE = ROOT / "discovery" / "thresholds.py"
"""One table on purpose: every threshold of discovery, with its reason."""


@cache
def trees() -> dict[Path, ast.Module]:
    """Of every module."""
    return {path: ast.parse(path.read_text("utf-8")) for path in sorted(ROOT.rglob("*.py"))}


def _floor(path: Path) -> str:
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def _imports(tree: ast.Module) -> set[str]:
    """Dotted names of what a module imports from the package, inside functions too."""
    out: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "doe_kc":
            out |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            out |= {alias.name for alias in node.names if alias.name.startswith("doe_kc.")}
    return out


def test_every_module_imports_downwards_only() -> None:
    upwards = [
        f"{path.relative_to(ROOT)} imports {name}"
        for path, tree in trees().items()
        if _floor(path) in FLOORS
        for name in _imports(tree)
        if (floor := name.split(".")[1]) in FLOORS and FLOORS.index(floor) > FLOORS.index(_floor(path))
    ]
    assert not upwards


@pytest.mark.parametrize("folder", ["reports", "benchmarks"])
def test_scripts_beside_the_package_import_what_it_has(folder: str) -> None:
    """No other test and no type checker runs most of them."""
    wanted = {
        n
        for path in (ROOT.parent / folder).rglob("*.py")
        for n in _imports(ast.parse(path.read_text("utf-8")))
    }
    assert wanted and not {name for name in wanted if not _there(name)}


def _there(name: str) -> bool:
    """Whether a dotted name is a module, or something that one defines."""
    module, _, last = name.rpartition(".")
    try:
        return hasattr(import_module(module), last) or find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def test_no_correlation_method_imports_from_another() -> None:
    """What two of them need is in `correlation/modelled`, or in an underscored module beside them."""
    folder = ROOT / "correlation" / "methods"

    def method(parts: tuple[str, ...]) -> str:
        return parts[0].removesuffix(".py")

    across = [
        f"{path.relative_to(ROOT)} imports {name}"
        for path, tree in trees().items()
        if path.is_relative_to(folder) and path != folder / "__init__.py"
        for name in _imports(tree)
        if name.startswith("doe_kc.correlation.methods.")
        and (other := method(tuple(name.split(".")[3:]))) != method(path.relative_to(folder).parts)
        and ((folder / f"{other}.py").exists() or (folder / other).is_dir())
        and not other.startswith("_")
    ]
    assert not across


def test_every_folder_has_its_floor() -> None:
    assert {_floor(p) for p in trees()} - {"__init__", "__main__"} == set(FLOORS) & {
        _floor(p) for p in trees()
    }


def test_no_module_imports_itself_by_way_of_others() -> None:
    names = {".".join(("doe_kc", *p.relative_to(ROOT).with_suffix("").parts)): p for p in trees()}
    names = {n.removesuffix(".__init__"): p for n, p in names.items()}
    graph = {
        name: {part for i in _imports(trees()[path]) for part in (i, i.rpartition(".")[0]) if part in names}
        - {name}
        for name, path in names.items()
    }
    graph = {n: {t for t in targets if not n.startswith(f"{t}.")} for n, targets in graph.items()}
    while graph:  # take away, floor by floor, what nothing imports any more
        leaves = {n for n, targets in graph.items() if not targets & graph.keys()}
        assert leaves, f"modules that import each other: {sorted(graph)}"
        graph = {n: targets for n, targets in graph.items() if n not in leaves}


def test_no_module_is_longer_than_a_reader_takes_in() -> None:
    lengths = {path: len(path.read_text("utf-8").splitlines()) for path in trees() if path != TABLE}
    assert {str(path): lines for path, lines in lengths.items() if lines > LINES_MOST} == {}


def test_a_class_name_means_one_class() -> None:
    places = defaultdict(list)
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                places[node.name].append(str(path.relative_to(ROOT)))
    assert not {name: found for name, found in places.items() if len(found) > 1}


def test_a_constant_name_means_one_value() -> None:
    places = defaultdict(list)
    for path, tree in trees().items():
        for node in tree.body:
            names = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            for name in names:
                if isinstance(name, ast.Name) and name.id.isupper() and len(name.id) > 1:
                    places[name.id].append(str(path.relative_to(ROOT)))
    assert not {name: found for name, found in places.items() if len(found) > 1}


def test_no_parameter_is_named_after_a_participle() -> None:
    participles = {"found", "made", "given", "judged", "told", "tried", "whole", "stands"}
    named = [
        f"{path.relative_to(ROOT)}: {node.name}({argument.arg})"
        for path, tree in trees().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)
        if argument.arg in participles
    ]
    assert not named


def test_no_variable_is_named_found() -> None:
    """A name says what is held: the field's noun."""
    places = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path, tree in trees().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and node.id == "found"
    ]
    assert not places
