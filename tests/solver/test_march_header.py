"""The constants of the compiled marches are those of the interpreted one."""

from __future__ import annotations

import re

from doe_kc.solver import march, newton
from doe_kc.solver.program_library import MARCH_SOURCES


def test_every_constant_is_that_of_python_and_used() -> None:
    defined = dict(re.findall(r"#define (\w+) (\S+)", MARCH_SOURCES[0].read_text()))
    python = {name: v for m in (newton, march) for name, v in vars(m).items() if name in defined}
    assert {name: float(v) for name, v in defined.items()} == python
    assert not [name for name in defined if not re.search(rf"\b{name}\b", MARCH_SOURCES[1].read_text())]
