"""`fieldmon compare`: is a further robot worth it?"""

import csv

import pytest

from fieldmon.cli.compare import robot_numbers
from fieldmon.errors import SettingError
from tests.cli.estate import MITES, ZIP

SHORT = ("--days", "3", "--seeds", "2", "--hours", "0.4")


def test_robots_are_a_range_or_a_list():
    assert robot_numbers("1-5") == [1, 2, 3, 4, 5]
    assert robot_numbers("4,1,2,2") == [1, 2, 4]
    assert robot_numbers("3") == [3]
    for wrong in ("", "0-2", "5-1", "1-", "two", "1-50"):
        with pytest.raises(SettingError, match="--robots must be as 1-5 or 1,2,4"):
            robot_numbers(wrong)


def test_ones_own_plot_is_answered_in_a_sentence_and_gone_on_with(run, tmp_path):
    asked = ("compare", ZIP, "--feature", "Nursery", "--records", MITES, *SHORT)
    code, out, err, files = run(*asked, "--robots", "1-2", "--date", "2026-11-02", "--sections")
    assert code == 0, err
    assert "(adaptive, together, contact every 30 min): A second robot would save " in out
    assert "(adaptive, sections): A second robot would save " in out
    assert {file.name for file in files} == {"robots.csv", "robots.md", "robots.html"}
    first = (tmp_path / "robots.csv").read_text()
    with (tmp_path / "robots.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["robots"], row["seed"]) for row in rows][:3] == [
        ("1", "1"),
        ("2", "1"),
        ("2", "1"),
    ]
    assert len(rows) == 6
    # asked again, nothing is simulated anew: the table is as it was
    code, again, err, _ = run(*asked, "--robots", "1-2", "--date", "2026-11-02", "--sections")
    assert (code, (tmp_path / "robots.csv").read_text()) == (0, first)
    assert again == out


def test_square_plots_of_several_sizes_and_spreads(run):
    code, out, err, _ = run(
        *(
            "compare",
            "--hectares",
            "0.1",
            "--hectares",
            "0.2",
            "--spread",
            "0.1",
            "--spread",
            "0.8",
        ),
        *("--to", "one", "--sampler", "naive", "--robots", "1-2", *SHORT),
    )
    assert code == 0, err
    assert out.count("(naive, sections): A second robot would save") == 4
    assert "0.2 ha spread 80% to one" in out
    assert err.startswith("Numbers of robots compared: 1, 2\n")
    assert "study run" not in err


def test_a_plot_and_hectares_are_too_much_and_a_folder_must_be_one(run):
    code, _, err, _ = run("compare", ZIP, "--hectares", "1")
    assert (code, "but not both" in err) == (2, True)
    code, _, err, _ = run("compare", "--hectares", "0.1", "-o", __file__)
    assert (code, "must be a folder" in err) == (2, True)
    code, _, err, _ = run("compare", "--hectares", "0.1", "--to", "nobody", *SHORT)
    assert (code, "Spread goes to" in err) == (2, True)


def test_who_expects_samplers_to_be_compared_is_told_which_command_does(run):
    asked = ("compare", "--hectares", "0.1", "--robots", "1", *SHORT)
    code, _, err, _ = run(*asked, "--sampler", "naive", "--sampler", "bouncy")
    assert code == 0
    told = "with each sampler by itself: naive, bouncy. Samplers are compared by fieldmon study run"
    assert told in err


def test_teams_may_come_every_so_many_days(run, tmp_path):
    asked = ("compare", "--hectares", "0.1", "--robots", "1-2", *SHORT)
    code, out, err, _ = run(*asked, "--visit-every", "2")
    assert code == 0, err
    assert "spread 10% to each, a visit every 2 days (adaptive" in out
    table = (tmp_path / "robots.md").read_text()
    assert table.count(" in 2 visits |") == 2
    # its table goes on with seasons of a visit a day, and mixes none
    run(*asked)
    assert "visit" not in (tmp_path / "robots.md").read_text()
    with (tmp_path / "robots.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 8
