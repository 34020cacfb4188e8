"""The `fieldmon` command, put together from its commands. Heavy imports wait for one."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from fieldmon.cli import problems, study
from fieldmon.cli.app import open_app
from fieldmon.cli.backup import backup
from fieldmon.cli.change import change
from fieldmon.cli.compare import compare
from fieldmon.cli.correct import correct
from fieldmon.cli.decide import decide
from fieldmon.cli.drive import drive
from fieldmon.cli.export import export
from fieldmon.cli.garbage_collection import cycles_seldom_looked_for
from fieldmon.cli.help_text import Commands
from fieldmon.cli.init import init
from fieldmon.cli.labels import labels
from fieldmon.cli.log import log
from fieldmon.cli.merge import merge
from fieldmon.cli.plan import plan
from fieldmon.cli.plots import plots
from fieldmon.cli.record import record
from fieldmon.cli.report import report
from fieldmon.cli.salvage import salvage
from fieldmon.cli.share import share
from fieldmon.cli.simulate import simulate
from fieldmon.cli.stand_in import stand_in
from fieldmon.cli.status import status
from fieldmon.cli.treat import treat
from fieldmon.cli.undo import undo

app = Commands(
    name="fieldmon",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    help="Which plants to inspect for pests today, and in which order.\n\n"
    "Start with [bold]fieldmon app[/bold] to see everything on a map, or plan a day at once:\n\n"
    "    fieldmon plots estate.zip\n\n"
    "    fieldmon plan estate.zip --feature Gate --records mites.csv -o route.geojson\n\n"
    "    fieldmon simulate estate.zip --feature Gate --records mites.csv",
)
_PANELS: dict[str, dict[str, Any]] = {
    "Begin": {"app": open_app, "plots": plots, "plan": plan, "init": init},
    "Every day": {
        "share": share,
        "record": record,
        "status": status,
        "report": report,
        "undo": undo,
    },
    "Spray or not": {"decide": decide, "treat": treat, "labels": labels},
    "Keep a season": {
        "change": change,
        "correct": correct,
        "log": log,
        "export": export,
        "merge": merge,
        "backup": backup,
        "salvage": salvage,
    },
    "Try it out": {
        "simulate": simulate,
        "compare": compare,
        "drive": drive,
        "stand-in": stand_in,
    },
}
for _panel, _commands in _PANELS.items():
    for _name, _command in _commands.items():
        app.command(_name, rich_help_panel=_panel)(_command)
app.add_typer(study.app, name="study", rich_help_panel="Try it out")


def _say_version(asked: bool) -> None:  # noqa: FBT001 - typer's own
    if asked:
        import fieldmon

        typer.echo(f"fieldmon {fieldmon.__version__}")
        raise typer.Exit


@app.callback()
def _fieldmon(
    *,
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_say_version, is_eager=True, help="Say which fieldmon this is."
        ),
    ] = False,
) -> None: ...


def main() -> None:
    """Run the command; a problem is a sentence and exit code 2, never a traceback."""
    with cycles_seldom_looked_for():
        problems.run(app)


if __name__ == "__main__":
    main()
