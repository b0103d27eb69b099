"""Exit codes and nearest names."""

from __future__ import annotations

import pickle

import pytest

from doe_kc.ground.errors import DoeKcError, InputError, RunError, nearest


def test_exit_codes() -> None:
    assert (InputError("x").exit_code, RunError("x").exit_code) == (2, 1)
    assert issubclass(InputError, DoeKcError) and issubclass(RunError, DoeKcError)
    assert not issubclass(InputError, RunError)


@pytest.mark.parametrize("error", [InputError, RunError])
def test_errors_pass_between_processes(error: type[DoeKcError]) -> None:
    again = pickle.loads(pickle.dumps(error("a: sentence.")))
    assert type(again) is error and str(again) == "a: sentence."


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("LLF.q", "LLF.x"),
        ("springrate", "spring.rate"),
        ("LLF.x", "LLF.x"),
        ("TYRE", "tyre"),
        ("zzzzzz", None),
        ("", None),
    ],
)
def test_nearest(name: str, expected: str | None) -> None:
    known = ["LLF.x", "spring.rate", "tyre"]
    assert nearest(name, known) == ("" if expected is None else f' Did you mean "{expected}"?')
    assert nearest(name, iter(known)) == nearest(name, known)
    assert nearest(name, []) == ""
