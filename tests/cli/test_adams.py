"""`doe-kc import adams` and `doe-kc export`, and the walk of docs/adams.md as it is typed."""

from __future__ import annotations

import csv
import json
import re
import shlex
import shutil
from pathlib import Path

import pytest

from doe_kc.axle_file import read_axle
from tests.adams.cases import MCPHERSON_DATABASE
from tests.cli.runner import fails, succeeds
from tests.reference import EXAMPLE, nominal

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "adams.md").read_text(encoding="utf-8")
RACK = ("--set", "steering.rack_mm_per_rev=52")


def test_the_walk_of_the_page_leads_to_a_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "examples").mkdir()
    shutil.copytree(EXAMPLE, tmp_path / "examples" / "front_axle")
    shutil.copytree(EXAMPLE.parent / "adams", tmp_path / "examples" / "adams")
    monkeypatch.chdir(tmp_path)
    study = next(b for b in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL) if "axle =" in b)
    first, second, third, *_ = re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    for line in first.splitlines():
        if line.startswith("doe-kc check"):
            Path("imported/study.toml").write_text(study + 'pictures = "none"\n')
        succeeds(*shlex.split(line)[1:])
    assert Path("imported/out/compare/report.html").is_file()
    by_hand = read_axle(Path("imported/axle.toml"))
    names = Path("imported/name_map.toml")
    names.write_text(
        names.read_text()
        .replace('ratio_unit = ""', 'ratio_unit = "rad/mm"')
        .replace('"steering.rack_mm_per_rev" = 52.0\n', "")
    )
    succeeds(*shlex.split(second)[1:])
    again = read_axle(Path("imported/axle.toml"))
    assert again.rack_mm_per_rev == pytest.approx(by_hand.rack_mm_per_rev, rel=1e-12)
    shutil.copy("imported/axle.toml", "imported/out/axle.toml")  # what `run` would write, untuned
    export, diff = third.splitlines()
    outcome = succeeds(*shlex.split(export)[1:])
    assert "nothing differs" in outcome.out and diff.startswith("diff -r")


def test_import_says_what_it_did_and_export_what_it_changed(tmp_path: Path) -> None:
    outcome = succeeds("import", "adams", MCPHERSON_DATABASE, "--out", tmp_path / "in", *RACK)
    assert "type: mcpherson_front" in outcome.out
    assert "inferred: front.sub and rack.sub are joined at tierod_inner" in outcome.out
    assert "left out: damper.dpr" in outcome.out
    axle = tmp_path / "in" / "axle.toml"
    assert read_axle(axle).values == pytest.approx(dict(nominal().values), rel=1e-11, abs=1e-11)
    text = axle.read_text().replace("LLF = [-2.0,", "LLF = [-1.5,")
    axle.write_text(text + "\n[effects.strut_friction]\n")
    outcome = succeeds("export", "adams", axle, "--from", MCPHERSON_DATABASE, "--out", tmp_path / "out")
    assert re.search(r"front.sub: 2 lines changed", outcome.out)
    assert "not written: effect strut_friction" in outcome.out
    assert "15 files" in outcome.err or "14 files" in outcome.err


def test_kc_tables_are_written_with_units_and_signs(tmp_path: Path) -> None:
    succeeds("export", "kc", EXAMPLE / "axle.toml", "--out", tmp_path)
    with (tmp_path / "compliance.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {row["unit"] for row in rows} == {"deg/N", "deg/Nm", "mm/N", "Nm/deg"}
    assert all(row["positive"] for row in rows)
    document = json.loads((tmp_path / "vehicle_tables.json").read_text())
    assert document["schema"] == "doe_kc.vehicle_tables/1"
    assert len(document["kinematics"]["vertical"]["toe_deg"]) == 2 * 65


def test_wrong_calls_are_told_in_one_sentence(tmp_path: Path) -> None:
    axle = EXAMPLE / "axle.toml"
    fails(2, r"name by --from PATH", "export", "adams", axle, "--out", tmp_path / "o")
    fails(2, r"--from and --map are for adams", "export", "kc", axle, "--from", axle, "--out", tmp_path / "o")
    fails(2, r"expected PATH=VALUE", "import", "adams", MCPHERSON_DATABASE, "--out", tmp_path, "--set", "x")
    fails(2, r"expected PATH=VALUE", "import", "adams", MCPHERSON_DATABASE, "--out", tmp_path, "--set", "a=b")
    fails(
        2,
        r"could be|--type|no name map",
        "import",
        "adams",
        MCPHERSON_DATABASE,
        "--out",
        tmp_path,
        "--type",
        "twist",
    )
    fails(
        2, r"there is no suspension of the rear axle",
        "import", "adams", MCPHERSON_DATABASE, "--out", tmp_path, "--type", "five_link_rear",
    )  # fmt: skip
    assert not any(tmp_path.iterdir())


def test_a_name_map_in_the_folder_counts_and_stays(tmp_path: Path) -> None:
    succeeds("import", "adams", MCPHERSON_DATABASE, "--out", tmp_path, *RACK)
    names = tmp_path / "name_map.toml"
    names.write_text(names.read_text() + "# mine\n")
    outcome = succeeds("import", "adams", MCPHERSON_DATABASE, "--out", tmp_path)
    assert "type: mcpherson_front" in outcome.out and names.read_text().endswith("# mine\n")
    succeeds("import", "adams", MCPHERSON_DATABASE, "--out", tmp_path, "--set", "tyre.rate=240")
    assert '"tyre.rate" = 240.0' in names.read_text()
    assert read_axle(tmp_path / "axle.toml").values["tyre.rate@L"] == 240.0


def test_the_same_command_works_once_the_map_says_what_was_missing(tmp_path: Path) -> None:
    command = ("import", "adams", MCPHERSON_DATABASE, "--out", tmp_path)
    fails(2, r"unit of REDUCTION_RATIO.*Say it in .*name_map.toml and repeat", *command)
    names = tmp_path / "name_map.toml"
    names.write_text(names.read_text().replace('ratio_unit = ""', 'ratio_unit = "rad/mm"'))
    succeeds(*command)
    assert read_axle(tmp_path / "axle.toml").rack_mm_per_rev == pytest.approx(52.0, rel=1e-12)
