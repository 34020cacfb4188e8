"""Where studies leave their tables and reports."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from fieldmon.errors import FileProblem

if TYPE_CHECKING:
    from pathlib import Path


def must_be_folder(output: Path) -> None:
    """Refuse a folder that is not there, before anything is simulated for it."""
    if not output.is_dir():
        raise FileProblem(f"The folder {output} must exist, but it does not. Make it first.")


def write_all(folder: Path, texts: dict[str, str]) -> None:
    """Write texts into files of a folder, and say so."""
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415

    for name, text in texts.items():
        write_whole(folder / name, text.encode())
        typer.echo(f"Written: {folder / name}")
