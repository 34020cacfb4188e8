"""Where studies leave their tables and reports."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

from fieldmon.errors import FileProblem

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator
    from pathlib import Path


# what studies write into their folder
_WRITTEN = (".csv", ".html", ".md")


def can_be_folder(output: Path) -> None:
    """Refuse a folder that cannot be made or written to, before anything is simulated for it."""
    if output.suffix.lower() in _WRITTEN and not output.exists():
        raise FileProblem(
            f"-o must be the folder into which files are written, but {output} is the "
            "name of a file. Name a folder."
        )
    there = next(place for place in (output, *output.absolute().parents) if place.exists())
    if not there.is_dir():
        raise FileProblem(f"{output} must be a folder, but {there} is a file. Choose another one.")
    if not os.access(there, os.W_OK | os.X_OK):
        raise FileProblem(f"{there} must be a folder that you may write to, but you may not.")


def tell_not_read(folder: Path, public: Collection[str]) -> None:
    """Say which tables of a folder of maps are not read; `public` are the public maps that are."""
    from fieldmon.studies.plant_maps import not_read

    if said := not_read(folder, public):
        typer.echo(said, err=True)


@contextmanager
def going_on(kept: Path) -> Iterator[None]:
    """Say, where a person stops a study, that its table or folder keeps what is done."""
    try:
        yield
    except KeyboardInterrupt:
        typer.echo(
            f"What is done is kept in {kept}; the same command goes on from there.", err=True
        )
        raise


def write_all(folder: Path, texts: dict[str, str]) -> None:
    """Write texts into files of a folder, which is made where it is not there; say so."""
    from fieldmon.io.atomic_write import write_whole

    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        write_whole(folder / name, text.encode())
        typer.echo(f"Written: {folder / name}")
