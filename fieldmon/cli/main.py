"""The `fieldmon` command, put together from its commands. Heavy imports wait for one."""

from __future__ import annotations

from fieldmon.cli import problems, study
from fieldmon.cli.app import open_app
from fieldmon.cli.backup import backup
from fieldmon.cli.change import change
from fieldmon.cli.compare import compare
from fieldmon.cli.correct import correct
from fieldmon.cli.cycles import cycles_seldom_looked_for
from fieldmon.cli.decide import decide
from fieldmon.cli.drive import drive
from fieldmon.cli.export import export
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
    "    fieldmon plan estate.zip --feature Gate --observations mites.csv -o route.geojson\n\n"
    "    fieldmon simulate estate.zip --feature Gate --observations mites.csv",
)
app.add_typer(study.app, name="study")
app.command()(record)
app.command()(status)
app.command()(report)
app.command()(undo)
app.command()(decide)
app.command()(treat)
app.command()(labels)
app.command()(log)
app.command()(export)
app.command()(change)
app.command()(correct)
app.command()(merge)
app.command()(backup)
app.command()(salvage)
app.command("app")(open_app)
app.command()(plots)
app.command()(plan)
app.command()(init)
app.command()(simulate)
app.command()(compare)
app.command()(drive)
app.command("stand-in")(stand_in)


def main() -> None:
    """Run the command; a problem is a sentence and exit code 2, never a traceback."""
    with cycles_seldom_looked_for():
        problems.run(app)


if __name__ == "__main__":
    main()
