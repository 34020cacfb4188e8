"""A command's options as fields of dataclasses."""

from dataclasses import dataclass, field
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from fieldmon.cli.option_groups import with_options

Metres = Annotated[float, typer.Option(help="How far.")]


@dataclass(frozen=True)
class Inner:
    far: Metres = 2.0
    wide: Annotated[bool, typer.Option("--wide", help="On both sides.")] = False


@dataclass(frozen=True)
class Outer:
    file: Annotated[str, typer.Argument(help="Where.")]
    first: Annotated[int, typer.Option(help="Before.")] = 1
    inner: Inner = field(default_factory=Inner)
    last: Annotated[list[str] | None, typer.Option(help="After; repeat.")] = None


@pytest.fixture
def told():
    """Return what tells a command something, and the command line of it."""
    heard = []
    app = typer.Typer()

    @app.command()
    @with_options
    def go(context: typer.Context, options: Outer) -> None:
        """Go there."""
        heard.append((options, sorted(context.params)))

    def tell(*words):
        done = CliRunner().invoke(app, list(words))
        return done, heard.pop() if heard else None

    return tell


def test_what_is_told_comes_in_as_the_dataclass_with_those_within_it(told):
    words = ["here", "--far", "3.5", "--wide", "--last", "a", "--last", "b"]
    _, (options, _) = told(*words)
    assert options == Outer("here", 1, Inner(3.5, wide=True), ["a", "b"])


def test_what_is_not_told_is_as_the_dataclasses_have_it(told):
    _, (options, names) = told("here")
    assert options == Outer("here")
    assert names == ["far", "file", "first", "last", "wide"]


def test_help_shows_the_options_in_the_order_of_the_fields_and_what_the_command_says(told):
    done, _ = told("--help")
    places = [done.output.index(f"--{name}") for name in ("first", "far", "wide", "last")]
    assert places == sorted(places)
    assert "Go there." in done.output
    assert "2.0" in done.output


def test_an_argument_that_is_missing_is_asked_for(told):
    done, heard = told("--far", "1")
    assert (done.exit_code, heard) == (2, None)
