"""What is shown together was read at one moment, though many questions were asked of the file."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import closing

import pytest

from fieldmon.cli.status import status as status_command
from fieldmon.compute.units import Units
from fieldmon.monitoring import Season
from fieldmon.monitoring.file import connections
from fieldmon.monitoring.inspecting.certifier_tables import treatments_table
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.reports.advice import advice_report
from fieldmon.reports.certification import certification_report
from fieldmon.reports.day import DayFacts
from fieldmon.reports.season import season_report
from tests.monitoring.open_elsewhere import as_qgis
from tests.monitoring.seasons import BEGINS, a_season, three_results

SHOWN = {
    "status": lambda season: status_command(season.path, str(BEGINS), batches=True, rows=True),
    "season": lambda season: season_report(season, BEGINS, Units()),
    "day": lambda season: DayFacts.of_season(season, BEGINS),
    "certificate": lambda season: certification_report([season, season], Units()),
    "treatments": treatments_table,
}


@pytest.fixture(scope="module")
def worked(tmp_path_factory):
    season = a_season(tmp_path_factory.mktemp("moment") / "season.gpkg")
    season.plan(BEGINS)
    season.record(three_results(), "x")
    season.treat(BEGINS, 0.7, product="Oil")
    return season.path


@pytest.fixture
def moments(monkeypatch):
    """List the transactions that are begun."""
    begun, connect = [], connections.connect

    def listening(*of):
        db = connect(*of)
        db.set_trace_callback(lambda sql: begun.append(sql) if sql.startswith("BEGIN") else None)
        return db

    monkeypatch.setattr(connections, "connect", listening)
    return begun


@pytest.mark.parametrize("shown", SHOWN)
def test_the_file_is_read_at_one_moment(worked, moments, shown):
    season = Season(worked)
    opens = len(moments) if shown == "status" else 0  # a command opens the season itself
    moments.clear()
    SHOWN[shown](season)
    assert len(moments) == opens + 1


def test_the_map_of_advice_is_read_at_one_moment(worked, moments):
    season = Season(worked)
    advice = season.advice(BEGINS, AdviceSettings())
    moments.clear()
    advice_report(season, BEGINS, advice, Units())
    assert len(moments) == 1


def test_what_others_write_within_one_moment_is_seen_after_it(worked):
    season, other = Season(worked), Season(worked)
    with closing(as_qgis(worked)):  # who reads does not stop who writes then
        with season.store.one_moment():
            before = season.revision
            with ThreadPoolExecutor(1) as window:
                window.submit(other.record, three_results(2), "another window").result()
            with season.store.one_moment():  # a part of what is shown
                assert season.revision == before
        assert season.revision != before


def test_nothing_is_written_within_one_moment(worked):
    season = Season(worked)
    with season.store.one_moment():
        before = len(season.batches())
        with pytest.raises(RuntimeError, match="of one moment"):
            season.record(three_results(), "within")
    season.record(three_results(1), "after")
    assert len(season.batches()) == before + 1
