"""Where, when and who: what is chosen counts on every page."""

from shapely import MultiPolygon, box

from app.actions import choosing
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.planning.members import TeamMember
from fieldmon.plot.field import Field
from fieldmon.plot.robot import Robot
from tests.app.chosen import in_season
from tests.app.driving import go, headline, map_of, metric, plants, plot_name
from tests.monitoring.seasons import BEGINS, a_season


def test_another_plot_is_another_map(app):
    before, n = map_of(app), len(plants(app))
    assert plot_name(app) == "Gate"
    app.selectbox(key="feature sample/paran_estate.zip").set_value(1).run()
    assert not app.exception
    assert plot_name(app) != "Gate"
    assert len(plants(app)) != n
    assert map_of(app)["place"] != before["place"], "the browser flies there"


def test_plots_whose_names_are_cut_alike_are_called_by_number_and_area():
    area = MultiPolygon([box(35.15, 30.36, 35.151, 30.361)])
    long = [Field(f"lleida_apricot_orchards ({k})", area) for k in (1, 2)]
    said = [label.split(" · ") for label in choosing._labels(tuple(long), UnitsInLanguage())]
    assert [(number, name.strip("\u2068\u2069")) for number, _, name in said] == [
        ("1", long[0].name), ("2", long[1].name)
    ]  # fmt: skip
    assert {size for _, size, _ in said} == {"1.07\u00a0ha"}
    assert choosing._labels((Field("Gate", area), Field("Pond", area)), UnitsInLanguage()) == [
        "Gate",
        "Pond",
    ]


def test_shorter_hours_give_a_shorter_route_on_every_page(app):
    stops = int(metric(app, "Plants to inspect").split(" / ")[0])
    app.slider(key="hours Robot").set_value(3.0).run()
    assert int(metric(app, "Plants to inspect").split(" / ")[0]) < stops / 2
    go(app, "field")
    assert app.slider(key="hours Robot").value == 3.0


def test_a_scout_is_planned_for_too(app):
    app.segmented_control(key="who").set_value("Scout on foot").run()
    assert not app.exception
    assert app.slider(key="hours Scout on foot").value == 12.0, "as long as the robot's day"


def test_hours_stay_what_they_are_whoever_inspects(app):
    app.slider(key="hours Robot").set_value(2.0).run()
    app.segmented_control(key="who").set_value("Scout on foot").run()
    assert app.slider(key="hours Scout on foot").value == 2.0
    app.slider(key="hours Scout on foot").set_value(3.0).run()
    app.segmented_control(key="who").set_value("Robot").run()
    assert not app.exception
    assert app.slider(key="hours Robot").value == 3.0


def test_lengths_and_dates_are_written_as_the_person_wants(app):
    app.selectbox(key="length").set_value("ft").run()
    app.selectbox(key="date_like").set_value("11/16/2026").run()
    assert "on Mon Nov 16, " in headline(app)
    assert next(one for one in app.date_input).proto.format == "MM/DD/YYYY"
    assert metric(app, "Drive").endswith(" mi")
    go(app, "plot")
    app.selectbox(key="area").set_value("dunam").run()
    assert metric(app, "Area").endswith("dunam")
    assert metric(app, "Rows / plants apart") == "13.1 ft / 9.8 ft"


def test_a_season_that_is_gone_is_waited_for_and_nothing_stands_in_its_place(season_app, season):
    path = season().path
    away = path.rename(path.with_suffix(".away"))
    for _ in range(2):
        season_app.run()
        assert not season_app.exception
        assert season_app.selectbox(key="season").value == "Gate 2026"
        (said,) = season_app.error
        assert said.value == texts.SEASON_GONE.format(name="\u2068Gate 2026\u2069")
        assert not season_app.metric
    away.rename(path)
    season_app.run()
    assert not season_app.error
    assert season_app.metric


def test_the_line_of_a_phone_has_the_hours_of_the_one_of_a_team_whose_day_is_shown(tmp_path):
    team = tuple(TeamMember(name, Robot(hours=h)) for name, h in (("Ann", 3.0), ("Dan", 2.0)))
    season = a_season(tmp_path / "s.gpkg", team=team)
    assert choosing._where_and_when(in_season(season, BEGINS)).endswith(" 3\u00a0h")


def test_who_waits_with_a_phone_is_told_so_outside_of_the_box_that_folds(season_app, monkeypatch):
    monkeypatch.setattr(choosing.browser, "is_phone", lambda: True)
    monkeypatch.setattr(choosing.season_held, "wait", lambda _: choosing.st.caption("waiting"))
    season_app.run()
    assert "waiting" in [one.value for one in season_app.caption]
    folded = [one for box in season_app.get("popover") for one in box.caption]
    assert "waiting" not in [one.value for one in folded]
