"""`fieldmon correct`: what another program changed is somebody's correction."""

import sqlite3
from contextlib import closing

import numpy as np

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS


def test_until_somebody_takes_it_every_command_refuses_what_another_program_changed(run, season):
    Season(season).record(Inspections.of(np.arange(3), np.zeros(3, int), BEGINS), "taps")
    with closing(sqlite3.connect(season)) as db:
        db.execute("UPDATE inspections SET result = 'found' WHERE fid = 2")
        db.commit()
    for command in ("status", "plan", "undo", "report"):
        code, _, err, made = run(command, season)
        assert (code, made) == (2, set())
        assert "row 2 of the layer inspections" in err
        assert "fieldmon correct" in err
    code, _, err, _ = run("correct", season, "--who", " ")
    assert (code, "--who must name" in err) == (2, True)
    code, out, _, _ = run("correct", season, "--who", "Ann")
    assert (code, out) == (0, "1 correction taken, by Ann.\n")
    code, out, _, _ = run("status", season, "--batches")
    assert code == 0
    assert "1 correction by Ann" in out
    assert "Nothing was changed" in run("correct", season, "--who", "Ann")[1]


def test_the_time_alone_of_an_inspection_is_corrected(run, season):
    kept = Season(season)
    told = Inspections.of(np.arange(2), np.array([0, 1]), BEGINS, second=[22_000, 80_000])
    kept.record(told, "taps")
    for words in (["--inspection", "2"], ["--time", "07:00"]):
        assert "must both be given" in run("correct", season, "--who", "Ann", *words)[2]
    words = ["correct", season, "--who", "Ann", "--time", "07:00", "--inspection"]
    assert "an inspection 9 that still counts" in run(*words, "9")[2]
    code, out, _, _ = run(*words, "2")
    assert (code, out.endswith("is now time 07:00:00\n")) == (0, True)
    held = Season(season).history.inspections
    assert held.second.tolist() == [22_000, 7 * 3600]
    assert held.result.tolist() == [0, 1]
    assert Season(season).verify() == ()
    run("undo", season)
    assert Season(season).history.inspections.second.tolist() == [22_000, 80_000]
