"""The list of commands costs no import of one; a command brings only what it needs."""

from __future__ import annotations

import subprocess
import sys

import pytest

from doe_kc import __version__

HEAVY = {"casadi", "matplotlib", "numpy", "openpyxl", "pandas", "scipy", "sklearn", "smt"}
LOADED = """
import sys
sys.argv = ["doe-kc", *sys.argv[1:]]
from doe_kc.cli import main
try:
    main()
except SystemExit as end:
    print(end.code, *sorted({name.partition(".")[0] for name in sys.modules}), file=sys.stderr)
"""


def run(*arguments: str) -> tuple[str, str, set[str]]:
    """Standard output, exit code and the packages that were imported."""
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *arguments], capture_output=True, text=True, check=True, timeout=60
    )
    code, *names = done.stderr.splitlines()[-1].split()
    return done.stdout, code, set(names)


@pytest.mark.parametrize(("arguments", "code"), [(["--help"], "0"), (["--version"], "0"), (["chek"], "2")])
def test_no_command_is_imported_for_a_list(arguments: list[str], code: str) -> None:
    out, ended, names = run(*arguments)
    assert ended == code and not names & HEAVY
    if arguments == ["--help"]:
        assert "Tune the variables to the measured car" in out and "discover" in out
    if arguments == ["--version"]:
        assert out == f"doe-kc {__version__}\n"


def test_a_check_needs_no_tables_and_no_pictures(tmp_path_factory: pytest.TempPathFactory) -> None:
    from tests.cli.runner import write_study

    study = write_study(tmp_path_factory.mktemp("s"), records={"brake": ["brake.csv"]})
    out, code, names = run("check", str(study))
    assert code == "0" and "all sound" in out
    assert not names & {"matplotlib", "openpyxl", "pandas", "sklearn", "smt"}


def test_a_search_for_effects_begins_without_what_writes_its_results() -> None:
    out, code, names = run("discover", "--help")
    assert code == "0" and "missing effect" in out
    assert not names & {"matplotlib", "openpyxl"}, "40 MB beside the derivatives"
