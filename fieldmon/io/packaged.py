"""Texts that come with the program: templates, and tables of published figures."""

from __future__ import annotations

from importlib.resources import files


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
