"""A copy of the season that is brought: shown before it is merged, merged once, with a way back."""

import shutil
from contextlib import closing
from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from app.actions import merging
from app.words import language, texts
from app.words.signs import marked_as_english
from app.words.texts import isolated
from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.io.options import Upload
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.file.connections import connect
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.season.copies_to_merge import merge_ahead
from tests.app.chosen import in_season
from tests.app.driving import apart, boxed, go, metric, opened, texts_of
from tests.monitoring.changes.test_outside_changes import outside

DAY = date(2026, 11, 16)
ENGLISH_MARK = marked_as_english("").removeprefix("\u2066\u2069")


def record(kept, plants, result, who=""):
    found = np.full(len(plants), result)
    return kept.record(Inspections.of(plants, found, np.datetime64(DAY)), "taps", who)


def copied(kept, folder, name="copy.gpkg"):
    return Season(shutil.copy(kept.path, folder / name))


def bring(app, copy):
    """Bring a file where findings are recorded."""
    go(app, "record")
    boxed(app.file_uploader, "findings_file").upload(copy.name, copy.read_bytes()).run()
    return app


def offered(app):
    return [one.key for one in app.button if one.key == "merge"]


def content(path):
    with closing(connect(path)) as db:
        return list(db.iterdump())


@pytest.fixture
def apart_by_now(season, tmp_path):
    """Return a season and a copy of it in which Ben worked, sprayed, and took something back."""
    kept = season()
    record(kept, [3, 4], CLEAN, "Ann")
    copy = copied(kept, tmp_path)
    record(kept, [10], CLEAN, "Ann")
    copy.undo(inspection=2)
    record(copy, [10, 11], FOUND, "Ben")
    copy.treat(DAY, 0.5, application=Application("Acarol", operator="Dan"))
    return kept, copy


def test_what_a_copy_holds_is_shown_before_and_after_it_is_merged_and_comes_with_a_way_back(
    season_app, season, apart_by_now
):
    kept, copy = apart_by_now
    before = content(kept.path)
    assert metric(go(season_app, "season"), "Found") == "0"
    bring(season_app, copy.path)
    shown = texts_of(season_app)
    assert f"**{isolated('copy.gpkg')} is a copy of this season.**" in shown
    brought = (
        f"- 2 inspections of 2 plants, 2 found (Mon 16 Nov)\n- inspected by {isolated('Ben')} (2)\n"
        "- 1 treatment: Acarol on Mon 16 Nov by Dan\n"
        "- 1 inspection that counts here was taken back or corrected there\n"
        "- 3 entries of its log"
    )
    assert brought in shown
    differs = "- Row 1, plant 11 on Mon 16 Nov: recorded as clean, now found."
    assert differs in shown
    assert content(kept.path) == before
    season_app.button(key="merge").click().run()
    assert f"{isolated('copy.gpkg')} was merged. What it brought" in season_app.warning[0].value
    said = texts_of(season_app)
    assert f"**{isolated('copy.gpkg')} was merged.** It brought:\n\n{brought}" in said
    assert differs in said
    assert "each recording that came can be taken back" in said
    assert not offered(season_app)
    season_app.button(key="merged_close").click().run()
    assert "was merged" not in texts_of(season_app)
    assert season().verify() == ()
    # the map and all figures are of the season as it is now
    assert metric(go(season_app, "season"), "Found") == "2"
    go(season_app, "record")
    of_ben = next(one for one in season().batches() if one.who == "Ben")
    season_app.button(key=f"undo {of_ben.number}").click().run()
    season_app.button(key=f"undo_yes {of_ben.number}").click().run()
    assert metric(go(season_app, "season"), "Found") == "0"


def test_of_two_sessions_that_merge_one_copy_the_second_changes_nothing(
    season_app, season, apart_by_now
):
    _, copy = apart_by_now
    other = opened("Gate 2026")
    for app in (season_app, other):
        bring(app, copy.path)
    season_app.button(key="merge").click().run()
    log = season().log()
    other.button(key="merge").click().run()
    assert "held nothing that this season lacks, any more" in other.success[0].value
    assert season().log() == log
    bring(other, copy.path)
    assert "holds nothing that this one lacks" in texts_of(other)
    assert not offered(other)


def test_other_seasons_newer_files_and_those_that_qgis_changed_are_refused_and_nothing_written(
    season_app, season, season_named, tmp_path
):
    kept = season()
    twin = Season.create(tmp_path / "twin.gpkg", kept.plot, kept.records, kept.settings)
    record(kept, [3, 4], CLEAN)
    changed = copied(kept, tmp_path, "changed.gpkg").path
    outside(changed, "UPDATE inspections SET result = 'found' WHERE fid = 1")
    newer = copied(kept, tmp_path, "newer.gpkg").path
    with closing(connect(newer)) as db:
        db.execute("UPDATE fieldmon SET value = '99' WHERE key = 'version'")
    before = content(kept.path)
    for file, why in (
        (twin.path, "they are two seasons"),
        (season_named.path, "one is of the plot Gate and the other of own"),
        (newer, "newer.gpkg was made by a newer fieldmon (format 99"),
        (changed, "another program changed it"),
    ):
        bring(season_app, file)
        (said,) = [one.value for one in season_app.info if why in apart(one.value)]
        assert str(tmp_path) not in said
        assert (texts.MERGE_OR_CORRECT in said) == (file == changed)
        assert not offered(season_app)
        assert content(kept.path) == before


def test_no_number_of_before_a_merge_takes_another_recording_back(season_app, season, tmp_path):
    kept = season()
    copy = copied(kept, tmp_path)
    record(copy, [5, 6], FOUND, "Ben")  # first
    record(kept, [3], CLEAN)
    go(season_app, "record")
    (shown,) = [one.key for one in season_app.button if one.label == "Undo"]
    kept.merge(copy)
    assert shown == f"undo {kept.batches()[-1].number}"  # which is Ben's by now
    season_app.button(key=shown).click().run()
    assert sorted(season().inspections.plant.tolist()) == [5, 6]


@pytest.mark.usefixtures("season_app")
def test_all_that_merging_has_to_say_is_said_in_another_language(season, tmp_path, speaking):
    kept = season()
    record(kept, [3, 4, 5], CLEAN, "Ann")
    kept.treat(DAY, 0.5, application=Application("Oil", waiting_days=3))
    copy = copied(kept, tmp_path)
    for one, hours, days in ((kept, 3.0, 7), (copy, 4.0, 14)):
        settings = one.settings
        one.change(replace(settings, robot=settings.robot.with_hours(hours)), settings)
        one.keep_labels([ProductLabel("Acarol", waiting_days=days)])
        one.treat(DAY, 0.5, application=Application("Acarol"))
    for one, hour in ((kept, 4), (copy, 5)):
        one.correct_time(2, f"{hour:02}:00", one.path.stem)
    copy.undo(inspection=1)
    copy.undo(next(b.number for b in copy.batches() if b.source == "Oil"))
    record(copy, [3], FOUND)
    scouts.let_in(kept, "Ann", (1, 3))
    scouts.let_in(copy, "Ben", (2, 4))
    ahead = merge_ahead(kept, Upload("copy.gpkg", copy.path.read_bytes()))
    choices = in_season(kept, DAY)
    english = "\n".join([*merging._brought(choices, ahead.merged), *merging._to_look_at(ahead)])
    for told in ("Both copies corrected", "The setting robot", "The table of labels", "codes of",
                 "labels added different", "but was undone there", "has rows 1 to 3"):  # fmt: skip
        assert told in english
    for code in ("he", "ar", "es"):
        speaking(code)
        to_look_at = map(language.in_words, merging._to_look_at(ahead))
        said = "\n".join([*merging._brought(choices, ahead.merged), *to_look_at])
        assert ENGLISH_MARK not in said
        assert isolated("Ben") in said
