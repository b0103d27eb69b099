"""`doe-kc map`: a channel map for a folder of a rig's own files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from doe_kc.axle_file import read_axle
from doe_kc.cli._app import app
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_whole
from doe_kc.workflow.map_rig import manifest_text, proposal_lines, propose_map


@app.command("map")
def map(
    folder: Annotated[Path, typer.Argument(help="Folder of the rig's files.")],
    axle: Annotated[Path | None, typer.Option(help="Axle file, for signs that only a model tells.")] = None,
    out: Annotated[Path | None, typer.Option(help="File to write in place of test.toml there.")] = None,
) -> None:
    """Propose which rig channel is what, from names, units, ranges and physics; write it to be confirmed."""
    path = out or folder / "test.toml"
    if path.exists():
        raise InputError(f"{path}: is there already; name another file by --out, or move it away.")
    proposal = propose_map(folder, None if axle is None else read_axle(axle))
    for line in proposal_lines(proposal):
        typer.echo(line)
    for finding in proposal.findings:
        typer.echo(f"{finding.severity}: {finding.message}", err=True)
    write_whole(path, lambda p: p.write_text(manifest_text(proposal), encoding="utf-8"))
    typer.echo(f"{path}: {len(proposal.channels)} channels, {len(proposal.open)} open; confirm it", err=True)
