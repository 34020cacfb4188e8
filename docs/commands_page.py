"""The page of all commands, written from the commands themselves when these pages are built."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from fieldmon.cli.main import app as commands

if TYPE_CHECKING:
    from collections.abc import Iterator

    from sphinx.application import Sphinx

_HEAD = """# Commands

What `fieldmon --help` and `fieldmon COMMAND --help` say, on one page.
"""


def write(sphinx: Sphinx) -> None:
    """Write the page beside those of the library."""
    page = Path(sphinx.srcdir) / "generated" / "commands.md"
    page.parent.mkdir(exist_ok=True)
    text = "\n".join([_HEAD, *_sections(typer.main.get_command(commands), "fieldmon")])
    # written only where it changed, or all pages would be built anew each time
    if not page.exists() or page.read_text(encoding="utf-8") != text:
        page.write_text(text, encoding="utf-8")


def _sections(command: Any, name: str) -> Iterator[str]:  # noqa: ANN401 - typer's own class
    """Yield a section for each command below one."""
    inner = getattr(command, "commands", None)
    if inner:
        for own in inner:
            yield from _sections(inner[own], f"{name} {own}")
        return
    yield f"## {name}\n"
    yield from _paragraphs(command.help or "")
    for param in command.params:
        if param.name != "help":
            yield _param(param)


def _paragraphs(said: str) -> Iterator[str]:
    """Yield a command's own words, its examples as code."""
    for part in said.split("\n\n"):
        examples = re.findall(r"^Example: (.*)$", part, re.MULTILINE)
        rest = re.sub(r"^Example: .*$\n?", "", part, flags=re.MULTILINE).strip()
        if rest:
            yield _flat(rest) + "\n"
        if examples:
            yield "```sh\n" + "\n".join(examples) + "\n```\n"


def _param(param: Any) -> str:  # noqa: ANN401 - as above
    """Return a definition of an option or argument."""
    named = [*param.opts, *param.secondary_opts] if param.param_type_name == "option" else []
    label = ", ".join(f"`{one}`" for one in named) or f"`{param.name.upper()}`"
    default = param.default
    shown = isinstance(default, (int, float, str)) and not isinstance(default, bool)
    usual = f" Default: `{getattr(default, 'value', default)}`." if shown and default != "" else ""
    return f"{label}\n: {_flat(getattr(param, 'help', None) or '')}{usual}\n"


def _flat(said: str) -> str:
    """Return words on one line, options among them as code."""
    words = " ".join(said.split()).replace("<", "\\<")
    return re.sub(r"(?<![\w`-])(--[a-z][a-z-]*)", r"`\1`", words)
