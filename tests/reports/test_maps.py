"""The plot on paper: where everything lies, and what a drawing of it holds."""

import io
from types import SimpleNamespace

import numpy as np
import pytest
from fpdf import FPDF
from PIL import Image

from app.show.maps import colours as of_app
from fieldmon.compute.units import Units
from fieldmon.infestation.hotspots import hot_spots
from fieldmon.plot.layout import rectangle
from fieldmon.reports import colours, maps
from fieldmon.reports.drawing import Areas, Bitmap, Discs, Lettering, Segments, Strokes
from fieldmon.reports.maps import PlotMap
from tests.io.writers.handed import crooked, usual

SIZE = (186.0, 100.0)


def a_map(grid, chance=0.02, found=(), route=None, **more):
    state = np.full(len(grid), -1, np.int8)
    state[: len(grid) // 2] = 0
    state[list(found)] = 1
    gate = np.array([grid.xy_m[:, 0].min() - 3, grid.xy_m[:, 1].min() - 3])
    gate = gate if route is None else route.aisles.gate_m
    return PlotMap(grid, np.broadcast_to(chance, len(grid)), state, hot_spots(grid, state), gate,
                   Units(), route, **more)  # fmt: skip


def parts(drawing, kind):
    return [part for part in drawing.parts if isinstance(part, kind)]


def places(part):
    """Return all places of a part."""
    if isinstance(part, Segments):
        return part.ends.reshape(-1, 2)
    if isinstance(part, Lettering):
        return np.array([[part.x, part.y]])
    lists = {Strokes: "lines", Areas: "rings"}
    if type(part) in lists:
        return np.concatenate(getattr(part, lists[type(part)]))
    return part.places if isinstance(part, Discs) else np.empty((0, 2))


@pytest.mark.parametrize("size", [SIZE, (186.0, 200.0), (60.0, 40.0)])
@pytest.mark.parametrize("day", [usual, crooked])
def test_everything_lies_on_the_paper(day, size):
    route = day().route
    grid = route.aisles.grid
    drawing = a_map(grid, np.linspace(0, 1, len(grid)), [3, 4, 5, 9], route).draw(size)
    for part in drawing.parts:
        at = places(part)
        assert (at >= -1e-6).all(), part
        assert (at <= np.array(size) + 1e-6).all(), part


def test_each_plant_lies_in_a_line_of_the_colour_of_its_class():
    grid = rectangle(4, 5)
    chance = np.linspace(0.0, 0.9, len(grid))
    drawn = {part.colour: part for part in parts(a_map(grid, chance).draw(SIZE), Segments)}
    rank = colours.ranks(chance)
    assert set(drawn) == {colours.CHANCE[k] for k in np.unique(rank)}
    for k in np.unique(rank):
        # plants stand alone on so small a plot: a line each
        assert len(drawn[colours.CHANCE[k]].ends) == np.count_nonzero(rank == k)


def test_plants_of_one_class_run_together_where_dots_would_blur():
    grid = rectangle(4, 400)
    (line,) = parts(a_map(grid).draw(SIZE), Segments)
    assert len(line.ends) == 4
    lengths = np.hypot(*(line.ends[:, 2:] - line.ends[:, :2]).T)
    per_m = lengths[0] / (400 * grid.plant_spacing_m)
    assert lengths == pytest.approx(400 * grid.plant_spacing_m * per_m)


def test_of_very_many_plants_there_is_a_picture_in_the_classes_colours(monkeypatch):
    monkeypatch.setattr(maps, "MOST_LINES", 10)
    grid = rectangle(6, 20)
    chance = np.where(np.arange(len(grid)) < 60, 0.001, 0.7)
    drawing = a_map(grid, chance).draw(SIZE)
    (picture,) = parts(drawing, Bitmap)
    assert parts(drawing, Segments) == []
    image = np.asarray(Image.open(io.BytesIO(picture.png)))
    assert image.shape == (1000, 1860, 4)
    seen = {tuple(one) for one in image[image[..., 3] > 0][:, :3].tolist()}
    assert seen == {colours.CHANCE[0], colours.CHANCE[-1]}
    halves = [(image[..., :3] == colours.CHANCE[k]).all(axis=-1).sum() for k in (0, -1)]
    assert halves[0] == pytest.approx(halves[1], rel=0.05)


def test_the_picture_and_the_lines_lie_on_one_another(monkeypatch):
    grid = rectangle(6, 20)
    chance = np.where(np.arange(len(grid)) == 47, 0.7, 0.001)
    lines = {one.colour: one.ends for one in parts(a_map(grid, chance).draw(SIZE), Segments)}
    middle = lines[colours.CHANCE[-1]].reshape(2, 2).mean(axis=0)
    monkeypatch.setattr(maps, "MOST_LINES", 10)
    (picture,) = parts(a_map(grid, chance).draw(SIZE), Bitmap)
    image = np.asarray(Image.open(io.BytesIO(picture.png)))
    row, column = np.nonzero((image[..., :3] == colours.CHANCE[-1]).all(axis=-1))
    assert (column.mean() / 10, row.mean() / 10) == pytest.approx(tuple(middle), abs=0.3)


def test_north_is_up_unless_the_plot_is_much_larger_turned():
    tall = rectangle(3, 200)
    for grid, size in ((tall, (186.0, 60.0)), (rectangle(12, 12), SIZE)):
        frame, drawing = grid.frame, a_map(grid).draw(size)
        (arrow,) = [one for one in parts(drawing, Areas) if one.fill == colours.INK]
        ring = arrow.rings[0]
        up = ring[0] - ring[2]
        assert up[1] <= 1e-6, "north is never below"
        along = parts(drawing, Segments)[0].ends[0]
        way = along[2:] - along[:2]
        angle = np.degrees(np.arctan2(way[0], -way[1])) - np.degrees(np.arctan2(up[0], -up[1]))
        assert (angle - frame.bearing_deg) % 360 == pytest.approx(0, abs=0.5) or (
            angle - frame.bearing_deg
        ) % 360 == pytest.approx(360, abs=0.5)


def test_the_scale_bar_is_as_long_as_it_says():
    grid = rectangle(10, 30)
    drawing = a_map(grid).draw(SIZE)
    line = parts(drawing, Segments)[0].ends
    (bar,) = [one for one in parts(drawing, Strokes) if one.colour == colours.INK]
    (text,) = [one.text for one in parts(drawing, Lettering) if one.text.endswith(" m")]
    length_mm = np.ptp(bar.lines[0][:, 0])
    rows = np.unique(np.round(line[:, [1, 3]].mean(axis=1), 6))
    columns = np.unique(np.round(line[:, [0, 2]].mean(axis=1), 6))
    between = max((np.diff(axis).min() for axis in (rows, columns) if len(axis) == 10), default=0)
    assert length_mm / float(text.split()[0]) == pytest.approx(
        between / grid.row_spacing_m, rel=0.01
    )


def test_the_route_has_its_stops_and_arrows_along_it():
    route = usual().route
    drawing = a_map(route.aisles.grid, route=route).draw(SIZE)
    stops = [one for one in parts(drawing, Discs) if one.edge == colours.ROUTE]
    assert len(stops[0].places) == len(route)
    arrows = [one.rings[0] for one in parts(drawing, Areas) if one.fill == colours.ROUTE]
    lines = [one for one in parts(drawing, Strokes) if one.colour == colours.ROUTE]
    assert len(arrows) >= 2
    line = lines[0].lines[0]
    for tip in arrows:
        ahead = tip[0] - tip[1:].mean(axis=0)
        start = tip.mean(axis=0)
        step = np.diff(line, axis=0)
        lengths = np.hypot(*step.T)
        share = np.einsum("ij,ij->i", start - line[:-1], step) / np.maximum(lengths, 1e-9) ** 2
        near = line[:-1] + np.clip(share, 0, 1)[:, None] * step
        off = np.hypot(*(near - start).T)
        on = off < 0.4
        assert on.any(), "an arrow lies on the way"
        assert (step[on] @ ahead > 0).any(), "and points along it"


def test_finds_hot_spots_and_their_numbers_are_drawn():
    grid = rectangle(9, 20)
    found = [20, 21, 22, 40, 41]
    made = a_map(grid, found=found)
    assert len(made.spots) == 1
    drawing = made.draw(SIZE)
    (finds,) = [one for one in parts(drawing, Discs) if one.fill == colours.FOUND]
    assert len(finds.places) == len(found)
    assert "1" in [one.text for one in parts(drawing, Lettering) if one.bold]


def test_of_many_hot_spots_no_number_hides_another():
    grid = rectangle(60, 60)
    row, place = np.divmod(np.arange(len(grid)), 60)
    made = a_map(grid, found=np.flatnonzero((row % 6 < 2) & (place % 6 < 2)))
    assert len(made.spots) == 50
    drawing = made.draw((60.0, 60.0))
    discs = [one for one in parts(drawing, Discs) if one.fill == colours.INK]
    at, radius = (
        np.concatenate([one.places for one in discs]),
        np.array([one.radius for one in discs]),
    )
    apart = np.hypot(*(at[:, None] - at).T) - radius[:, None] - radius
    assert apart[~np.eye(len(at), dtype=bool)].min() >= 0.0
    numbers = [one.text for one in parts(drawing, Lettering) if one.bold and one.text.isdigit()]
    # the surest has its number
    assert numbers[0] == "1"
    assert 10 < len(numbers) == len(discs) < len(made.spots)


def test_rows_are_numbered_as_far_as_there_is_room():
    few, many = (a_map(rectangle(n, 9)).draw((60.0, 60.0)).words() for n in (5, 300))
    assert {"1", "2", "3", "4", "5"} <= set(few)
    numbers = [int(word) for word in many if word.isdigit()]
    assert numbers[0] == 1
    assert 3 <= len(numbers) <= 25


def test_by_state_a_plant_never_inspected_is_not_clean():
    grid = rectangle(4, 5)
    drawing = a_map(grid, found=[19], by_state=True).draw(SIZE)
    count = {one.colour: len(one.ends) for one in parts(drawing, Segments)}
    assert count == dict(zip(colours.STATES, (9, 10, 1), strict=True))


def test_plants_that_could_not_be_inspected_are_drawn_in_the_colour_of_the_app():
    assert colours.NOT_INSPECTED == of_app.NOT_INSPECTED
    grid = rectangle(2, 10)
    passed = np.isin(np.arange(20), [12, 15])
    for by_state in (False, True):
        drawing = a_map(grid, by_state=by_state, passed=passed).draw(SIZE)
        (signs,) = [one for one in parts(drawing, Discs) if one.fill == colours.NOT_INSPECTED]
        assert len(signs.places) == 2
        none = a_map(grid, by_state=by_state, passed=passed & False).draw(SIZE)
        assert not [one for one in parts(none, Discs) if one.fill == colours.NOT_INSPECTED]
    said = maps.legend(186.0, passed=True)
    assert "could not inspect, or gone" in said.words()
    assert max(places(part)[:, 1].max() for part in said.parts) <= maps.legend_mm(passed=True)


@pytest.mark.parametrize(("route", "by_state"), [(True, False), (False, False), (False, True)])
def test_the_legend_fits_the_page_and_names_its_signs(route, by_state):
    drawing = maps.legend(186.0, route=route, by_state=by_state)
    assert all(places(part)[:, 0].max() <= 186.0 for part in drawing.parts)
    said = drawing.words()
    assert ("route, arrows show the way" in said) is route
    assert ("never inspected" in said) is by_state
    assert ("50 %+" in said) is not by_state
    assert {"found infested", "hot spot", "gate"} <= set(said)
    of_zones = maps.legend(186.0, by_state=by_state, zones=True)
    assert all(places(part)[:, 0].max() <= 186.0 for part in of_zones.parts)
    assert set(said) - {"route, arrows show the way"} == (
        set(of_zones.words()) - {"zones to treat"} | {"hot spot"}
    )


@pytest.mark.parametrize("recorded", [False, True])
@pytest.mark.parametrize("zones", [False, True])
def test_the_legend_has_room_for_the_wider_letters_of_a_browser(zones, recorded):
    pdf = FPDF()
    drawing = maps.legend(186.0, route=not zones, zones=zones, recorded=recorded)
    starts = sorted(places(part)[:, 0].min() for part in drawing.parts)
    for part in parts(drawing, Lettering):
        pdf.set_font("helvetica", size=part.size_pt)
        wide = 1.1 * pdf.get_string_width(part.text)  # system-ui may be a tenth wider
        if part.anchor == "start":
            after = min([one for one in starts if one > part.x], default=186.0)
            assert part.x + wide <= after, part.text


def test_a_day_without_a_stop_has_a_map_without_a_way():
    grid = rectangle(4, 5)
    nowhere = SimpleNamespace(line_m=np.empty((0, 2)), aisles=SimpleNamespace(gate_m=np.zeros(2)))
    drawing = a_map(grid, route=nowhere).draw(SIZE)
    assert [one for one in parts(drawing, Strokes) if one.colour == colours.ROUTE] == []


def test_a_map_is_worth_no_more_paper_than_the_plot_fills():
    wide, tall = (a_map(rectangle(*shape)).heights(75.0, 190.0) for shape in ((3, 200), (200, 3)))
    assert wide[0] == wide[1] or wide[1] < 190.0
    assert tall[1] == pytest.approx(190.0)
    for grid in (rectangle(3, 200), rectangle(12, 12)):
        made = a_map(grid)
        high = made.heights(0.0, 190.0)[1]
        (ground,) = [one for one in parts(made.draw((186.0, high)), Areas)
                     if one.fill == colours.GROUND]  # fmt: skip
        span = np.ptp(np.concatenate(ground.rings), axis=0)
        room = np.array([186.0 - 10.0, high - 13.0])
        assert (span / room).max() > 0.9
