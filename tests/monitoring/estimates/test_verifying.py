"""What is held to what when a season's file is verified, and how much of it at once."""

from fieldmon.monitoring.estimates import verifying
from tests.monitoring.seasons import some_results


def test_what_stands_otherwise_in_the_file_than_in_its_log_is_said(season, monkeypatch):
    season.record(some_results(season), "x")
    assert verifying.check_against_log(season) == ()
    with season.store.writing() as db:
        db.execute("UPDATE batches SET who = 'Eve'")
    (said,) = verifying.check_against_log(season)
    assert said.startswith("The batch 1 of the file is not what entry")
    assert season.verify() == (said,)
    assert verifying.is_short(season)
    monkeypatch.setattr(verifying, "SHORT", len(season.plot.grid) - 1)
    assert not verifying.is_short(season)
