"""Every example of the Python API runs as it is written."""

from __future__ import annotations

import ast
import doctest
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import doe_kc as kc
from tests.api.cases import chain_once, discovery_once

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted((ROOT / "examples" / "python").glob("*.py"))
CALLED = [name for name in kc.__all__ if inspect.isfunction(getattr(kc, name)) or name == "Surrogate"]


@pytest.fixture(autouse=True)
def _here(example_root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(example_root)
    monkeypatch.setattr("doe_kc.api.discovery.discover_study", discovery_once)
    monkeypatch.setattr("doe_kc.workflow.chain.follow_chain", chain_once)


@pytest.mark.parametrize("name", CALLED)
def test_the_example_of_every_docstring(name: str) -> None:
    documented = getattr(kc, name)
    (test,) = doctest.DocTestFinder(recurse=False).find(documented, name, globs={"kc": kc})
    assert len(test.examples) > 0
    lines: list[str] = []
    outcome = doctest.DocTestRunner(verbose=False).run(test, out=lines.append)
    assert outcome.failed == 0, "".join(lines)


def test_the_page_of_the_api(capsys: pytest.CaptureFixture[str], example_root: Path) -> None:
    text = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) > 5
    for block in blocks:
        exec(compile(f"import doe_kc as kc\n{block}", "api.md", "exec"), {})
    assert capsys.readouterr().out.strip()
    assert (example_root / "answer" / "axle.toml").is_file()


def test_the_page_names_everything_public() -> None:
    text = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    for name in {*kc.__all__} - {"__version__"}:
        assert f"`{name}" in text or f"`kc.{name}" in text, name


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda s: s.stem)
def test_the_scripts_run(
    script: Path, example_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    folder = example_root / "examples" / "front_axle"
    monkeypatch.setattr(sys, "argv", [str(script), str(folder), "--out", str(tmp_path)])
    monkeypatch.setenv("DOE_KC_DESIGNS", "24")
    tree = ast.parse(script.read_text(encoding="utf-8"))
    exec(compile(tree, str(script), "exec"), {"__name__": "__main__", "__file__": str(script)})
    assert capsys.readouterr().out.strip()
    pictures = sorted(tmp_path.rglob("*.png"))
    assert pictures and all(p.stat().st_size > 5000 for p in pictures)


def test_there_are_three_scripts() -> None:
    assert len(SCRIPTS) == 3


def test_the_import_loads_no_library() -> None:
    code = "import sys, doe_kc; print(sorted({m.split('.')[0] for m in sys.modules}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(ast.literal_eval(done.stdout))
    assert not loaded & {"numpy", "pandas", "scipy", "matplotlib", "casadi", "sklearn", "pydantic"}


def test_every_public_name_is_typed_and_there() -> None:
    tree = ast.parse(Path(str(kc.__file__)).read_text(encoding="utf-8"))
    (block,) = [node for node in tree.body if isinstance(node, ast.If)]
    typed = {alias.name: node.module for node in block.body if isinstance(node, ast.ImportFrom)
             for alias in node.names}  # fmt: skip
    assert set(typed) == {*kc.__all__} - {"__version__"} == set(kc._HOMES)
    assert typed == kc._HOMES
    assert set(kc.__all__) <= set(dir(kc))
    with pytest.raises(AttributeError, match="no attribute 'correlat'"):
        kc.correlat  # noqa: B018


def test_no_public_name_is_that_of_a_module() -> None:
    """Which would take its place once it is imported."""
    modules = {path.stem for path in Path(str(kc.__file__)).parent.iterdir()}
    assert not modules & {*kc.__all__}
    assert [kc.report.__module__, kc.surrogates.__module__] == ["doe_kc.api.report", "doe_kc.api.surrogates"]
