"""Help as it stands in a window."""

import re
import shlex
from functools import cache

import pytest
import typer

from fieldmon.cli import help_text
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


@cache
def whole():
    return typer.main.get_command(app)


def every_help():
    top = whole()
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
        command = whole()
        while hasattr(command, "commands"):
            command = command.commands[words.pop(0)]
        command.make_context(name, words)


@pytest.mark.parametrize("words", [["plan", "none.zip"], ["study", "prior", "--nope"]])
def test_a_command_is_put_together_without_the_others(run, words, monkeypatch):
    made, make = [], typer.main.get_command_from_info
    help_text._put_together.cache_clear()
    monkeypatch.setattr(
        "typer.main.get_command_from_info",
        lambda **told: made.append(told["command_info"].name) or make(**told),
    )
    assert run(*words)[0] == 2
    assert made == [words[-2]]


@pytest.mark.parametrize(
    ("words", "meant"), [(["paln"], "'plan'"), (["study", "prio"], "'prior', 'no-prior'")]
)
def test_what_is_mistyped_is_answered_by_all_there_are(run, words, meant):
    assert f"Did you mean {meant}?" in run(*words)[2]
