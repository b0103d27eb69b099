"""docs/campaigns.md says what the program does."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from doe_kc.campaign.store_file import STORE_SCHEMA
from doe_kc.sampling import SAMPLERS
from doe_kc.sampling.options import SamplingOptions

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "campaigns.md").read_text(encoding="utf-8")


def test_every_sampler_is_on_the_page() -> None:
    section = PAGE.split("## Which sampler?")[1].split("##")[0]
    assert set(re.findall(r"^\| `(\w+)`", section, re.MULTILINE)) == set(SAMPLERS)


def test_every_column_is_on_the_page() -> None:
    columns = set(re.findall(r"^    (\w+) [A-Z]+", STORE_SCHEMA, re.MULTILINE))
    section = PAGE.split("## What is kept")[1].split("##")[0]
    rows = re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
    assert columns == {name for row in rows for name in re.findall(r"`(\w+)`", row) if name != "evaluations"}


def test_the_options_on_the_page_are_taken() -> None:
    plain, constrained = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    options = SamplingOptions.model_validate(tomllib.loads(plain)["sampling"])
    assert options == SamplingOptions(n=200, table="designs.csv")
    (constraint,) = SamplingOptions.model_validate(tomllib.loads(constrained)["sampling"]).constraint
    assert str(constraint.build()) == "2 <= +1 ROB.z -1 RIB.z <= 5"


def test_the_python_on_the_page_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")
    monkeypatch.chdir(ROOT)
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(code, "campaigns.md", "exec"), {})
    assert re.fullmatch(r"-\d\.\d+ deg/m 2 runs\n", capsys.readouterr().out)
