"""Texts and tables that come with the program: templates, stylesheet, published figures."""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files

#: where the pests are that come with fieldmon
PESTS = "fieldmon/pests"


def packaged_text(path: str) -> str:
    """Return a text file of the program.

    Parameters
    ----------
    path
        From where the packages stand, as ``"fieldmon/io/templates/page.css"``: the same in a
        checkout and in an installed wheel.
    """
    package, _, name = path.rpartition("/")
    return files(package.replace("/", ".")).joinpath(name).read_text(encoding="utf-8")


def packaged_table(path: str) -> list[dict[str, str]]:
    """Return the rows of a CSV table of the program by the names of its columns.

    Lines that begin with ``#`` say where the figures come from and are no rows.
    """
    lines = packaged_text(path).splitlines()
    return list(csv.DictReader((line for line in lines if not line.startswith("#")), strict=True))


def packaged_names(folder: str, ending: str) -> list[str]:
    """Return the names of the program's files in a folder that end so, sorted.

    Parameters
    ----------
    folder, ending
        As ``"fieldmon/pests"`` and ``".toml"``.
    """
    inside = files(folder.replace("/", ".")).iterdir()
    return sorted(one.name for one in inside if one.name.endswith(ending))


@cache
def pest_names() -> tuple[str, ...]:
    """Return the names of the pests that come with fieldmon, the thesis's first."""
    names = [name.removesuffix(".toml") for name in packaged_names(PESTS, ".toml")]
    return tuple(sorted(names, key=lambda name: (name != "thesis", name != "spider-mite", name)))
