"""Type files that are refused, and in which words."""

from __future__ import annotations

from pathlib import Path

import pytest

from doe_kc.axle_types import read_axle_type
from doe_kc.axle_types.read import FOLDER
from doe_kc.ground.errors import InputError

TEXT = (FOLDER / "five_link_rear.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('inner = "subframe"', 'inner = "subfrane"', "bushings.ufi.*'subfrane'.*subframe"),
        ('at = "UFI"', 'at = "UFX"', r"bushings.ufi.*'UFX'.*not in \[points\]"),
        ('TLI = "Toe link inner"\n', "", r"bushings.tli.*'TLI'"),
        (
            'TLI = "Toe link inner"\n',
            'TLI = "Toe link inner"\nXXX = "Nothing"\n',
            "'XXX' is used by no element",
        ),
        ('WLC = "Wheel centre"\n', "", "no WLC, the wheel centre"),
        ('carrier = "knuckle"', 'carrier = "hub_carrier"', "carrier = 'hub_carrier' is no body"),
        ('toe_link = "side"\n', 'toe_link = "side"\nspare = "side"\n', "'spare' is connected with nothing"),
        ("[balls.tlo]", "[balls.tyre]", "'tyre' is taken by every axle"),
        ("[balls.tlo]", "[balls.ufo]", "TOML|twice|overwrite"),
        ("[balls.tlo]", "[balls.TLO]", "two elements or points are named 'TLO'"),
        ("[springs.spring]", "[spring.spring]", "springs is missing"),
    ],
)
def test_a_wrong_type_file_is_refused_in_words(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in TEXT
    (tmp_path / "own.toml").write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=f"(?s){message}") as error:
        read_axle_type("own.toml", tmp_path, source="axle.toml")
    assert "own.toml" in str(error.value)
