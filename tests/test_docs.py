"""The documents and the program say the same."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
import typer
from pydantic import BaseModel

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.cli import commands
from doe_kc.cli._app import app
from doe_kc.correlation.options import CorrelationOptions
from doe_kc.effects import EFFECTS
from doe_kc.parameter_influence.options import InfluenceOptions
from doe_kc.production_scatter.options import ToleranceOptions
from doe_kc.study import read_study
from doe_kc.targets import CharacteristicOptions
from doe_kc.variables import Change
from tests.axle_type_reference import nominal as nominal_of
from tests.reference import EXAMPLE, nominal

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
COMMAND = re.compile(r"\bdoe-kc ([a-z]+)((?: +(?:--[a-z]+|[^\s`|&]+))*)")


def table_rows(page: str) -> dict[str, str]:
    """First column, a word in backquotes, to the whole row."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return {m[1]: m[0] for m in re.finditer(r"^\| `([^`]+)` \|.*$", text, re.MULTILINE)}


def test_every_characteristic_is_on_its_page() -> None:
    rows = table_rows("characteristics.md")
    assert set(rows) == set(CHARACTERISTICS)
    for ident, entry in CHARACTERISTICS.items():
        cells = [c.strip() for c in rows[ident].strip("|").split("|")]
        assert cells[1:3] == [entry.label, entry.response], ident
        assert cells[4] == entry.unit, ident


def test_every_effect_is_on_its_page_with_its_keys() -> None:
    rows = table_rows("effects.md")
    assert set(rows) == set(EFFECTS)
    for ident, effect in EFFECTS.items():
        for key, option in effect.options.items():
            assert f"`{key} = " in rows[ident], (ident, key)
            if isinstance(option.default, float):
                assert f"`{key} = {option.default}`" in rows[ident], (ident, key)


def test_the_keys_on_the_page_are_taken() -> None:
    import tomllib

    for ident, row in table_rows("effects.md").items():
        options = tomllib.loads("\n".join(re.findall(r"`([\w]+ = [^`]+)`", row)))
        assert options or "=" not in row.split("|")[3], ident
        axle = nominal_of("five_link_rear") if EFFECTS[ident].part in ("balls", "damper") else nominal()
        EFFECTS[ident].apply(axle, options, "page")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    missing = []
    for link in LINK.findall(text):
        target, _, anchor = link.partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        file = (page.parent / target) if target else page
        if not file.exists():
            missing.append(link)
        elif anchor and file.suffix == ".md":
            heads = re.findall(r"^#+ (.+)$", file.read_text(encoding="utf-8"), re.MULTILINE)
            slugs = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in heads}
            assert anchor in slugs, link
    assert not missing


def known_commands() -> dict[str, set[str]]:
    """Command -> its options."""
    for name in commands.command_names():
        commands.register(app, [name])
    group = typer.main.get_command(app)
    found = group.commands  # type: ignore[attr-defined]
    return {name: {o for p in c.params for o in p.opts} | {"--help"} for name, c in found.items()}


def test_the_commands_named_exist_with_their_options() -> None:
    known = known_commands()
    assert set(known) == {
        *(
            "init",
            "types",
            "check",
            "map",
            "import",
            "export",
            "predict",
            "simulate",
            "reduce",
            "influence",
            "identify",
            "sample",
            "tolerance",
        ),
        *("surrogates", "correlate", "discover", "report", "run", "live"),
    }
    named = set()
    for page in PAGES:
        for command, rest in COMMAND.findall(page.read_text(encoding="utf-8")):
            assert command in known, f"{page.name}: doe-kc {command}"
            named.add(command)
            for option in re.findall(r"(?<!\S)--[a-z-]+", rest):
                assert option in known[command], f"{page.name}: doe-kc {command} {option}"
    assert "simulate" in named


def test_the_readme_names_every_command() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for command in known_commands():
        assert f"doe-kc {command}" in text or f"`{command}" in text, command


def test_the_readmes_shortest_study_is_one(tmp_path: Path) -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    studies = [b for b in re.findall(r"```toml\n(.*?)```", text, re.DOTALL) if "axle =" in b]
    assert studies
    for study in studies:
        (tmp_path / "axle.toml").write_bytes((EXAMPLE / "axle.toml").read_bytes())
        (tmp_path / "study.toml").write_text(study, encoding="utf-8")
        assert read_study(tmp_path).measured() == (tmp_path / "rig",)


def test_the_study_page_is_a_study(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "study.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    (tmp_path / "axle.toml").write_bytes((EXAMPLE / "axle.toml").read_bytes())
    (tmp_path / "study.toml").write_text(block, encoding="utf-8")
    study = read_study(tmp_path)
    assert study.space.dimension == 71 and study.correlation.budget == 100


@pytest.mark.parametrize(
    ("head", "options"),
    [
        ("[correlation]", CorrelationOptions),
        ("[[characteristics]] and [[curves]]", CharacteristicOptions),
        ("[variables]", Change),
    ],
)
def test_the_study_page_names_every_key(head: str, options: type[BaseModel]) -> None:
    text = (ROOT / "docs" / "study.md").read_text(encoding="utf-8")
    section = text.split(f"## {head}\n")[1].split("\n## ")[0]
    for key in options.model_fields:
        assert f"`{key}`" in section or key == "match", key


def test_the_tolerance_page_is_a_table_that_names_every_key() -> None:
    text = (ROOT / "docs" / "tolerance.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    options = ToleranceOptions.model_validate(tomllib.loads(block)["tolerance"])
    tables = (options, options.scatter[0], options.correlation[0], options.requirement[0])
    for key in (k for table in tables for k in type(table).model_fields):
        assert re.search(rf"\b{key}\b", text), key
    assert options.model_fields_set >= {"samples", "limits", "common"}
    defaults = ToleranceOptions()
    for key in ("samples", "parameters", "distribution", "limits", "common"):
        assert getattr(options, key) == getattr(defaults, key), key
    for key in ("morris", "sobol", "pawn"):
        assert f"| `{key}` |" in text and f"{getattr(InfluenceOptions(), key)} " in text, key


def test_the_readmes_python_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")
    monkeypatch.chdir(ROOT)
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        exec(compile(block, "README.md", "exec"), {})
        assert capsys.readouterr().out.strip()


def test_the_floors_on_the_page_are_those_of_the_package() -> None:
    from tests.test_architecture import FLOORS

    assert list(table_rows("architecture.md")) == FLOORS


@pytest.mark.parametrize("page", ["architecture.md", "discovery.md", "report_page.md", "campaigns.md"])
def test_files_that_a_page_names_are_there(page: str) -> None:
    text = (ROOT / "docs" / page).read_text("utf-8")
    named = set(re.findall(r"`((?:doe_kc|tests|reports|benchmarks)/[\w/.]+)`", text))
    assert named or page not in ("architecture.md", "discovery.md")
    assert not [n for n in sorted(named) if not (ROOT / n).exists()]


def test_the_python_of_the_report_page_runs() -> None:
    text = (ROOT / "docs" / "report_page.md").read_text("utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: dict[str, object] = {}
    exec(block, names)
    assert str(names["more"].html) == "<p>strut friction: evidence 12.3</p>"
    assert all(callable(names[n]) for n in ("correlation_sections", "write_page"))
