"""A planned day is driven by a simulated robot."""

import json
from dataclasses import replace
from datetime import date
from types import SimpleNamespace

from app.actions import driving
from app.words import texts
from tests.app.driving import fetched, go, map_of, press, texts_of, until


def test_a_planned_day_is_driven_and_handed_to_the_map_and_nothing_is_recorded(season_app, season):
    kept = season()
    kept.change(replace(kept.settings, robot=kept.settings.robot.with_hours(1.0)), kept.settings)
    before = season().revision
    app = go(season_app, "drive")
    assert not app.exception
    assert map_of(app)["drive"] is None
    (share,) = (one for one in app.number_input if one.key.startswith("drive_share"))
    evening = season().evening(date(2026, 11, 16)).mean()
    assert share.value == round(100 * float(evening), 1) != 2.0, "what Compare begins with"
    assert texts.DRIVE_BELIEVES.format(day="Mon 16 Nov") in texts_of(app)
    press(app, texts.DRIVE_RUN)
    until(lambda: map_of(app.run())["drive"] is not None, every_s=0.5)
    assert b'"stops":[[' in fetched(map_of(app)["drive"])
    stops = json.loads(fetched(map_of(app)["drive"]))["stops"]
    found = sum(one[2] is True for one in stops)
    assert f"Driven: {len(stops)} stops, {found} found, " in texts_of(app)
    assert any(one.value == texts.DRIVE_MADE_UP for one in app.caption)
    assert season().revision == before


def test_of_a_day_that_was_stopped_it_is_said_that_it_is_thrown_away(monkeypatch):
    said = []
    monkeypatch.setattr(driving, "st", SimpleNamespace(info=said.append))
    driving._progress(SimpleNamespace(
        running=False, problem=None, thrown_away=True, day=None, said="",
    ), at_work=False)  # fmt: skip
    assert said == [texts.DRIVE_STOPPED]
