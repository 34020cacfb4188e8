"""What is said of a season's day that is driven."""

from datetime import date

from fieldmon.drive.season_day import SeasonDay
from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS


def test_a_robot_that_goes_on_for_another_is_told_where_it_is_taken_to_stand(run, season):
    on = date.fromisoformat(BEGINS)
    day = SeasonDay(Season(season), on, "fieldmon/A", name="A")
    stop = day.ask()
    day.tell(found=False)
    words = ("--date", BEGINS, "--robot", "vda5050", "--broker", "127.0.0.1:1")
    told = f"fieldmon/A was driven on {BEGINS} before. fieldmon/B is taken to stand at plant "
    _, _, err, _ = run("drive", season, *words, "--serial", "B")
    assert f"{told}{stop.plant}, where that ended." in err
    _, _, err, _ = run("drive", season, *words, "--serial", "A")
    assert "was driven" not in err
