"""`fieldmon study ...`: published experiments, made again, and studies of one's own."""

from __future__ import annotations

from fieldmon.cli.help_text import Commands
from fieldmon.cli.study_beliefs import beliefs
from fieldmon.cli.study_calibrate import calibrate
from fieldmon.cli.study_no_prior import no_prior
from fieldmon.cli.study_prior import prior
from fieldmon.cli.study_replanning import replanning
from fieldmon.cli.study_routes import routes
from fieldmon.cli.study_run import study_run
from fieldmon.cli.study_samplers import samplers
from fieldmon.cli.study_spread import spread
from fieldmon.cli.study_treatments import treatments
from fieldmon.cli.study_verdicts import verdicts
from fieldmon.cli.study_weather import weather

app = Commands(
    no_args_is_help=True, help="Repeat published experiments, and run studies of your own."
)
app.command("prior")(prior)
app.command("calibrate")(calibrate)
app.command("samplers")(samplers)
app.command("beliefs")(beliefs)
app.command("routes")(routes)
app.command("replanning")(replanning)
app.command("weather")(weather)
app.command("spread")(spread)
app.command("run")(study_run)
app.command("no-prior")(no_prior)
app.command("verdicts")(verdicts)
app.command("treatments")(treatments)


@app.callback()
def study() -> None:
    """Make published experiments again, or run a study of one's own plots."""
