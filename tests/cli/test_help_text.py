"""Help as it stands in a window."""

import re
import shlex

import pytest
import typer

from fieldmon.cli.help_text import Commands, flowing
from fieldmon.cli.main import app


def test_lines_of_a_paragraph_are_joined_and_examples_stand_alone():
    text = "Plan a\nday.\n\nIt is\nwritten.\n\nExample: a b\nExample: c\nd\n\ne"
    assert flowing(text) == "Plan a day.\n\nIt is written.\n\nExample: a b\nExample: c d\n\ne"


def test_what_is_said_of_a_command_goes_before_its_docstring():
    commands = Commands()

    @commands.command(help="Shown\nas it is.")
    def one():
        """Hidden."""

    assert typer.main.get_command(commands).help == "Shown\nas it is."


def every_help():
    top = typer.main.get_command(app)
    for name, command in top.commands.items():
        yield name, command.help
        yield from (
            (f"{name} {inner}", one.help) for inner, one in getattr(command, "commands", {}).items()
        )


@pytest.mark.parametrize(("name", "said"), [*every_help()])
def test_no_command_breaks_its_help_where_its_source_ends_a_line(name, said):
    assert said
    for paragraph in said.split("\n\n"):
        assert not re.search(r"\n(?!Example: )", paragraph), name


@pytest.mark.parametrize(("name", "said"), [*every_help()])
def test_an_example_in_a_help_is_a_whole_command_and_nothing_else(name, said):
    for example in re.findall(r"^Example: (.*)$", said, re.MULTILINE):
        program, *words = shlex.split(example)
        assert program == "fieldmon", name
        command = typer.main.get_command(app)
        while hasattr(command, "commands"):
            command = command.commands[words.pop(0)]
        command.make_context(name, words)
