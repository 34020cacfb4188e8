"""Charts of seasons. No Streamlit in here."""

from __future__ import annotations

import math
from functools import partial, wraps
from typing import TYPE_CHECKING, Literal, ParamSpec, TypeVar

import altair as alt
import numpy as np
import pandas as pd

from ..words import language, texts

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.forecast import Forecast
    from fieldmon.monitoring import DayFigures
    from fieldmon.pests.development import Development
    from fieldmon.simulation.metrics import SeasonMetrics

    Floats = NDArray[np.float64]
    #: names a day on an axis, without its year
    DayName = Callable[[date], str]
    #: where a line of text begins or ends
    Side = Literal["left", "right"]
    #: the number of a line's colour, and of its dashes, by its name
    Styles = dict[str, tuple[int, int]]

P = ParamSpec("P")
C = TypeVar("C", bound="alt.Chart | alt.LayerChart")

# Okabe & Ito's colours for the colour-blind
# the last one grey, not black, which the dark page swallows
_COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F"]
# each way of choosing plants has its own colour on every page
_OWN = ("adaptive", "dynamic", "naive", "bouncy", "decide", "snake", "neighbor")
# more lines than colours: the next ones are dashed
_DASHES = [[1, 0], [6, 3], [2, 2]]
_LEGEND = alt.Legend(orient="top", title=None, columns=2, labelLimit=300, symbolType="stroke",
                     symbolSize=300, symbolStrokeWidth=3, symbolOpacity=1)  # fmt: skip
_GREY = "#7F7F7F"
# as far beside its line the words above an axis begin
_ASIDE_PX = 30
# beside the last day its name has room: at the edge it was cut
_EDGE_PX = 10
# as many letters of dates fit side by side in the narrow panel: six of "25 Nov"
_LETTERS = 36
# and as many rows
_MOST_ROWS = 14


def _in_language(make: Callable[P, C]) -> Callable[P, C]:
    """Return charts whose numbers are written as in the language, their axes where it begins.

    What an axis counts stands above it, level: turned and beside it, it was cut where it is long.
    """

    @wraps(make)
    def made(*args: P.args, **settings: P.kwargs) -> C:
        # set in place: each of Altair's own ways builds the chart and its layers anew
        chart = make(*args, **settings)
        chart.padding = {"left": _EDGE_PX, "right": _EDGE_PX}
        chart.config = alt.Config(
            background="transparent",
            axisLeft=_level("left", -_ASIDE_PX),
            axisRight=_level("right", _ASIDE_PX),
        )
        # whether Vega-Lite knows all that is in a chart of ours hangs on no data: its tests say it,
        # nobody who looks at a page waits for it
        object.__setattr__(chart, "to_dict", partial(chart.to_dict, validate=False))
        if language.current() == language.ENGLISH:
            return chart
        fraction, thousands = language.separators()
        number = {"decimal": fraction, "thousands": thousands, "grouping": [3],
                  "currency": ["", ""]}  # fmt: skip
        chart.config.locale = alt.Locale(number=number)
        chart.config.axisY = alt.AxisConfig(orient=_sides()[0])
        return chart

    return made


def _level(align: Side, x_px: int) -> alt.AxisConfig:
    """Return how the words above an axis stand."""
    return alt.AxisConfig(
        titleAlign=align, titleX=x_px, titleAngle=0, titleBaseline="bottom", titleY=-8
    )


def _month_and_day(on: date) -> str:
    return f"{on:%m-%d}"


def _days(labels: Sequence[str], title: str) -> alt.X:
    """Return the axis of days by their names, in this order, with as many as have room.

    Layers do not agree which names to leave out: so few never overlap. The days are told: of a
    table alone, those on which nothing was done came last.
    """
    few = max(_LETTERS // max(map(len, labels), default=1), 1)
    some = list(labels[:: math.ceil(len(labels) / few)])
    days = alt.Scale(domain=list(labels))
    return alt.X("day:O", title=title, scale=days, axis=alt.Axis(labelAngle=0, values=some))


def _sides() -> tuple[Side, Side]:
    """Return on which side a line begins and ends."""
    return ("right", "left") if language.is_right_to_left() else ("left", "right")


@_in_language
def detection(
    seasons: dict[str, SeasonMetrics], day: int, axes: tuple[str, str], samplers: Sequence[str] = ()
) -> alt.LayerChart:
    """Return detection per day, a line for each sampler, with a rule at the day shown."""
    table = pd.concat(
        pd.DataFrame({"strategy": name, "day": range(1, len(f.found) + 1), "mean": f.detection_pct,
                      "visit": f.visit})
        for name, f in seasons.items()
    )  # fmt: skip
    lines = _lines(table, _styles(list(seasons), samplers), axes)
    rule = (
        alt.Chart(pd.DataFrame({"day": [day]}))
        .mark_rule(strokeDash=[4, 4], color=_GREY)
        .encode(x="day:Q")
    )
    return alt.LayerChart(layer=[lines, rule]).properties(height=280)


@_in_language
def curves(table: pd.DataFrame, axes: tuple[str, str]) -> alt.Chart | alt.LayerChart:
    """Return a line for each column of a table whose index counts days."""
    long = (
        table.rename_axis("day").reset_index().melt("day", var_name="strategy", value_name="mean")
    )
    return _lines(long, _styles(list(table.columns)), axes).properties(height=320)


def _lines(
    table: pd.DataFrame, styles: Styles, axes: tuple[str, str]
) -> alt.Chart | alt.LayerChart:
    """Return the mean by day, a line for each strategy, told apart by colour and by dashes.

    Where the table tells visits, only their days have a dot.
    """
    tooltip = [
        alt.Tooltip("strategy", title=texts.COLUMN_STRATEGY),
        alt.Tooltip("day", title=axes[0]),
        alt.Tooltip("mean:Q", title=axes[1], format=".1f"),
    ]
    apart = "visit" in table and not table["visit"].all()
    base = alt.Chart(table).encode(
        x=alt.X("day:Q", title=axes[0], axis=alt.Axis(tickMinStep=1)),
        y=alt.Y("mean:Q", title=axes[1], scale=alt.Scale(domain=[0, 100])),
        color=alt.Color("strategy:N", scale=_scale(styles), legend=_LEGEND),
        tooltip=tooltip,
    )
    line: alt.Chart = base.mark_line(point=not apart, strokeWidth=2.5).encode(
        strokeDash=alt.StrokeDash("strategy:N", scale=_dashes(styles), legend=_LEGEND)
    )
    if not apart:
        return line
    dots = base.mark_point(filled=True, opacity=1, size=60).transform_filter(alt.datum.visit)
    return alt.LayerChart(layer=[line, dots])


def _styles(names: Sequence[str], samplers: Sequence[str] = ()) -> Styles:
    """Return the colour and the dashes of each line, by its name; no two are alike.

    The first line of a sampler has its own colour; the others have those that are free.
    """
    every = [(k, dash) for dash in range(len(_DASHES)) for k in range(len(_COLOURS))]
    first = {sampler: name for name, sampler in zip(names[::-1], samplers[::-1], strict=False)}
    own = {first[one]: (k, 0) for k, one in enumerate(_OWN) if one in first}
    free = iter([one for one in every if one not in own.values()])
    return {name: own.get(name) or next(free, (0, 0)) for name in names}


def _scale(styles: Styles) -> alt.Scale:
    return alt.Scale(domain=list(styles), range=[_COLOURS[k] for k, _ in styles.values()])


def _dashes(styles: Styles) -> alt.Scale:
    return alt.Scale(domain=list(styles), range=[_DASHES[k] for _, k in styles.values()])


@_in_language
def found(figures: SeasonMetrics, axes: tuple[str, str]) -> alt.Chart:
    """Return the plants found on each day."""
    days = [str(day) for day in range(1, len(figures.found) + 1)]
    table = pd.DataFrame({"day": days, "found": figures.found})
    bars: alt.Chart = (
        alt.Chart(table)
        .mark_bar(color=_COLOURS[0])
        .encode(
            x=_days(days, axes[0]),
            y=alt.Y("found:Q", title=axes[1]),
            tooltip=[alt.Tooltip("day", title=axes[0]), alt.Tooltip("found", title=axes[1])],
        )
    )
    return bars.properties(height=200)


def load() -> None:
    """Make a chart: what makes all charts is then loaded before anybody asks for one."""
    level = np.zeros(2)
    bands({"": (level, level, level)}, ("", "")).to_dict()


@_in_language
def bands(
    curves: Mapping[str, tuple[Floats, Floats, Floats]], axes: tuple[str, str],
    samplers: Sequence[str] = (), visit_every: int = 1,
) -> alt.LayerChart:  # fmt: skip
    """Return a line with its interval for each strategy.

    `curves` holds mean, low and high ``(d,)`` each, `samplers` the sampler of each.
    """
    styles = _styles(list(curves), samplers)
    table = pd.concat(
        pd.DataFrame({"strategy": name, "day": range(1, len(mean) + 1), "mean": mean, "low": low,
                      "high": high, "visit": np.arange(len(mean)) % visit_every == 0})
        for name, (mean, low, high) in curves.items()
    )  # fmt: skip
    band = (
        alt.Chart(table)
        .mark_area(opacity=0.18)
        .encode(
            x="day:Q", y=alt.Y("low:Q", title=axes[1]), y2="high:Q",
            color=alt.Color("strategy:N", scale=_scale(styles), legend=_LEGEND),
        )
    )  # fmt: skip
    return alt.LayerChart(layer=[band, _lines(table, styles, axes)]).properties(height=320)


@_in_language
def season_days(
    days: list[DayFigures], axes: tuple[str, str, str], named: DayName = _month_and_day
) -> alt.LayerChart:
    """Return plants inspected and found on each day of a season; a day without work is a gap."""
    table = _work_by_day(days, named)
    x = _days(list(table["day"]), axes[0])
    tip = [alt.Tooltip("day", title=axes[0]), alt.Tooltip("inspected:Q", title=axes[1]),
           alt.Tooltip("found:Q", title=axes[2])]  # fmt: skip
    bars = (
        alt.Chart(table)
        .mark_bar(color=_COLOURS[5])
        .encode(
            x=x,
            y=_counts("inspected", axes[1], _sides()[0], table),
            tooltip=tip,
        )
    )
    found_ = (
        alt.Chart(table)
        .mark_line(color=_COLOURS[1], point={"color": _COLOURS[1], "size": 60}, strokeWidth=2.5,
                   invalid="break-paths-filter-domains")
        .encode(
            x=x, tooltip=tip,
            y=_counts("found", axes[2], _sides()[1], table),
        )
    )  # fmt: skip
    both: alt.LayerChart = alt.LayerChart(layer=[bars, found_]).resolve_scale(y="independent")
    return both.properties(height=220)


def _counts(name: str, title: str, side: Side, table: pd.DataFrame) -> alt.Y:
    """Return the axis of what is counted: whole numbers from 0, also where all are 0."""
    most = table[name].max()
    scale = alt.Scale(domain=[0, 1 if pd.isna(most) else max(int(most), 1)], nice=True)
    return alt.Y(f"{name}:Q", title=title, scale=scale,
                 axis=alt.Axis(orient=side, tickMinStep=1, format=",d"))  # fmt: skip


def _work_by_day(days: list[DayFigures], named: DayName) -> pd.DataFrame:
    """Return plants inspected and found by every day's name; of a day without work, nothing."""
    worked = {one.on: one for one in days if one.inspected_today}
    table = pd.DataFrame(
        [(named(on), one and one.inspected_today, one and one.found_today)
         for on in _dates(days) for one in [worked.get(on)]],
        columns=["day", "inspected", "found"],
    )  # fmt: skip
    return table.astype({"inspected": "Int64", "found": "Int64"})


def _as_dates(days: NDArray[np.datetime64]) -> list[date]:
    return [at.date() for at in pd.to_datetime(days)]


def _dates(days: list[DayFigures]) -> list[date]:
    """Return every date from the first of some days to the last."""
    return [at.date() for at in pd.date_range(days[0].on, days[-1].on)]


@_in_language
def still_out(
    days: list[DayFigures], axes: tuple[str, str], named: DayName = _month_and_day
) -> alt.LayerChart:
    """Return the expected number of infested plants by day, with its interval."""
    table = pd.DataFrame(
        {
            "day": [named(s.on) for s in days],
            "expected": [s.expected for s in days],
            "low": [s.low for s in days],
            "high": [s.high for s in days],
        }
    )
    base = _expected(table, [named(on) for on in _dates(days)], axes, ".1f")
    # an edge, since the pale bar alone is next to nothing on a dark page
    band = base.mark_bar(
        fillOpacity=0.3, color=_COLOURS[0], stroke=_COLOURS[0], strokeWidth=1, width=10
    ).encode(y="low:Q", y2="high:Q")
    line = base.mark_line(point=True, color=_COLOURS[0]).encode(
        y=alt.Y("expected:Q", title=axes[1])
    )
    return alt.LayerChart(layer=[band, line]).properties(height=220)


def _expected(table: pd.DataFrame, days: list[str], axes: tuple[str, str], shown: str) -> alt.Chart:
    """Return a chart by days of how many are expected, which says them and their interval."""
    return alt.Chart(table).encode(
        x=_days(days, axes[0]),
        tooltip=[
            alt.Tooltip("day", title=axes[0]),
            alt.Tooltip("expected:Q", title=axes[1], format=shown),
            alt.Tooltip("low", title=texts.LEAST), alt.Tooltip("high", title=texts.MOST),
        ],
    )  # fmt: skip


@_in_language
def development(
    there: Development,
    marks: list[tuple[str, float]],
    axes: tuple[str, str],
    named: DayName = _month_and_day,
) -> alt.LayerChart:
    """Return degree-days by day against marks: names of stages and generations, and how many.

    Days whose weather was filled in are dashed; a rule stands at the day that is asked about.
    """
    table = pd.DataFrame(
        {
            "day": [named(day) for day in _as_dates(there.days)],
            "gathered": there.degree_days,
            "guessed": there.guessed,
        }
    )
    days = _days(list(table["day"]), axes[0])
    base = alt.Chart(table).encode(
        x=days,
        y=alt.Y("gathered:Q", title=axes[1]),
        tooltip=[alt.Tooltip("day", title=axes[0]),
                 alt.Tooltip("gathered:Q", title=axes[1], format=".0f")],
    )  # fmt: skip
    lines, (rules, words) = _full_and_dashed(base, table), _marks(marks)
    today = pd.DataFrame({"day": [named(there.on)]})
    now = alt.Chart(today).mark_rule(color=_GREY).encode(x=days)
    return alt.LayerChart(layer=[*lines, rules, words, now]).properties(height=260)


def _full_and_dashed(base: alt.Chart, table: pd.DataFrame) -> list[alt.Chart]:
    """Return the line of days that were measured, and the dashes of those that were guessed."""
    # the dashes begin where the line ends
    before = table["guessed"].shift(-1, fill_value=False)
    parts = [(table[~table["guessed"]], [1, 0]), (table[table["guessed"] | before], [4, 4])]
    return [
        base.properties(data=part).mark_line(
            color=_COLOURS[0], strokeWidth=2.5, strokeDash=dashes, point={"size": 12}
        )
        for part, dashes in parts
        if len(part)
    ]


def _marks(marks: list[tuple[str, float]]) -> tuple[alt.Chart, alt.Chart]:
    """Return a rule across at the height of each mark, and its name on it."""
    marked = alt.Chart(pd.DataFrame(marks, columns=["name", "gathered"]))
    side = _sides()[0]
    rules = marked.mark_rule(color=_GREY, strokeDash=[2, 2]).encode(y="gathered:Q")
    words = marked.mark_text(align=side, dy=8, color=_GREY, fontSize=11).encode(
        y="gathered:Q", text="name:N", x=alt.value(0 if side == "left" else "width")
    )
    return rules, words


@_in_language
def ahead(
    day: str, forecast: Forecast, axes: tuple[str, str], named: DayName = _month_and_day
) -> alt.LayerChart:
    """Return the infested plants expected on the mornings after a day, with their interval."""
    dates = [named(at.date()) for at in pd.date_range(day, periods=len(forecast.expected))]
    table = pd.DataFrame(
        {"day": dates, "expected": forecast.expected, "low": forecast.low, "high": forecast.high}
    )
    base = _expected(table, dates, axes, ".0f")
    band = base.mark_area(opacity=0.25, color=_COLOURS[1]).encode(y="low:Q", y2="high:Q")
    line = base.mark_line(color=_COLOURS[1], strokeWidth=2.5).encode(
        y=alt.Y("expected:Q", title=axes[1])
    )
    return alt.LayerChart(layer=[band, line]).properties(height=220)


@_in_language
def row_ages(days_since: Floats, lines: NDArray[np.int64], axes: tuple[str, str],
             signs: Mapping[int, str] | None = None) -> alt.LayerChart:  # fmt: skip
    """Return the days since each row was inspected, ``(r,)``, one beside the other.

    `signs` is how rows are shown, by their numbers; None: as these. A row inspected today has a
    tick on the ground, a row never inspected a hollow bar.
    """
    table = _ages_of_rows(days_since, lines, signs or {})
    never = table["days"].isna()
    encoding = {
        # a place for each row there is, and none for a number that no row has
        "x": alt.X(
            "sign:O",
            title=axes[0],
            sort=None,
            scale=alt.Scale(domain=table["sign"].tolist()),
            axis=alt.Axis(values=_signs_with_room(table), labelAngle=0, labelOverlap=True),
        ),
        "y": alt.Y("high:Q", title=axes[1], axis=alt.Axis(tickMinStep=1, format="d")),
        "tooltip": [alt.Tooltip("sign", title=axes[0]), alt.Tooltip("said", title=axes[1])],
    }
    seen = alt.Chart(table[~never]).mark_bar(color=_COLOURS[2])
    today = alt.Chart(table[table["days"] == 0]).mark_tick(
        color=_COLOURS[2], thickness=4, orient="horizontal"
    )
    unseen = alt.Chart(table[never]).mark_bar(
        filled=False, stroke=_GREY, strokeWidth=1.5, strokeDash=[3, 2]
    )
    # a layer of nothing is a picture without a name to those who cannot see it
    drawn = [part.encode(**encoding) for part in (seen, today, unseen) if len(part.data)]
    return alt.LayerChart(layer=drawn).properties(height=180)


def _ages_of_rows(days_since: Floats, lines: NDArray[np.int64], signs: Mapping[int, str]
                  ) -> pd.DataFrame:  # fmt: skip
    """Return each row, its days and its sign; how high it is drawn, and what is said of it."""
    table = pd.DataFrame({"row": lines, "days": days_since})
    table = table.groupby("row", as_index=False).agg({"days": "min"})  # NaN only where all are
    table["sign"] = [signs.get(row, f"{row}") for row in table["row"].tolist()]
    most = 1.0 if table["days"].isna().all() else max(table["days"].max(), 1.0)
    table["high"] = table["days"].fillna(most)
    table["said"] = [
        texts.ROW_NEVER if math.isnan(d) else texts.ROW_TODAY if d == 0 else f"{d:g}"
        for d in table["days"]
    ]
    return table


def _signs_with_room(table: pd.DataFrame) -> list[str]:
    """Return the signs that are written: names, and of the numbers as many as have room."""
    every = next(k for k in (1, 2, 5, 10, 20, 50, 100, 10**9) if len(table) <= k * _MOST_ROWS)
    rows = list(zip(table["row"].tolist(), table["sign"].tolist(), strict=True))
    is_name = [sign != f"{row}" for row, sign in rows]
    return [
        sign for k, (_, sign) in enumerate(rows)
        if is_name[k]
        # and no number so near before a name that it would take its room
        or ((k == 0 or not (k + 1) % every) and not any(is_name[k + 1 : k + 1 + every // 2]))
    ]  # fmt: skip
