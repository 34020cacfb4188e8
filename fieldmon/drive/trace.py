"""A driven day in time: where the robot was at which second, what it found, what was believed."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import counted, worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.drive.bag import colour_says, east_north_yaw, read_bag
from fieldmon.drive.day import place_m, way_m
from fieldmon.drive.day_tables import STOP_COLUMNS
from fieldmon.drive.recording import Noted, Recording
from fieldmon.errors import FileProblem
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from fieldmon.drive.errand import Float
    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

#: a place that lies so near to the line between its neighbours in time says nothing new
_OFF_M, _OFF_RAD = 0.02, 0.03
#: a find in a bag is at a plant of this plot if it is so near to it
_SAME_PLANT_M = 0.5


class TracedStop(NamedTuple):
    """A plant that was inspected.

    Parameters
    ----------
    done_s
        Seconds since the day began, when it was left.
    plant
        Its number in the grid.
    found
        Whether it was found infested; None: it could not be inspected.
    """

    done_s: float
    plant: int
    found: bool | None


@dataclass(frozen=True, eq=False)
class Trace:
    """A driven day in time.

    Parameters
    ----------
    poses
        ``(k, 4)``: seconds since the day began, longitude, latitude (degrees WGS84), heading
        (degrees clockwise from north). Between two of them the robot moves evenly.
    stops
        The plants inspected, in order.
    unseen
        Numbers of the poses to which nobody knows the way from the one before; ascending.
    """

    poses: Float
    stops: tuple[TracedStop, ...]
    unseen: tuple[int, ...] = ()

    def __repr__(self) -> str:
        found = sum(one.found is True for one in self.stops)
        return f"<Trace: {counted(len(self.stops), 'stop')}, {found} found, {self.end_s:.0f} s>"

    @property
    def end_s(self) -> float:
        """Seconds since the day began, at its end."""
        last = float(self.poses[-1, 0]) if len(self.poses) else 0.0
        return max([last, *(one.done_s for one in self.stops[-1:])])


def trace_of(recording: Recording) -> Trace:
    """Return what was noted of a day as a trace.

    Examples
    --------
    >>> import fieldmon as fm
    >>> from fieldmon.drive.charged_robot import ChargedRobot
    >>> from fieldmon.drive.day import drive_day
    >>> from fieldmon.drive.recording import Recording
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> robot = fm.Robot(hours=1)
    >>> noted = Recording(plot.aisles, robot)
    >>> with fm.Monitor(plot, robot=robot).day() as day:
    ...     who = robot, ChargedRobot(lambda stop: False)
    ...     driven = drive_day(day, plot.aisles, who, noted.note)
    >>> len(trace_of(noted).stops) == len(driven.stops)
    True
    """
    frame = recording.aisles.grid.frame
    poses = thinned(recording.track.poses)
    # a bearing turns clockwise from north, an angle of the frame the other way from its rows
    heading = (frame.bearing_deg - np.degrees(poses[:, 3])) % 360.0
    traced = np.column_stack([poses[:, 0], frame.lonlat(poses[:, 1:3]), heading])
    return Trace(traced, tuple(TracedStop(s.at_s, s.plant, s.found) for s in recording.stops))


def thinned(poses: Float) -> Float:
    """Return poses ``(k, 4)`` (seconds, metres, metres, radians) without those that say nothing.

    What is left out lies within 2 cm and 0.03 radians of an even move between those that are kept.
    """
    if len(poses) < 3:
        return poses
    poses = poses.copy()
    poses[:, 3] = np.unwrap(poses[:, 3])
    kept, first = [0], 0
    allowed = np.array([_OFF_M / 2, _OFF_M / 2, _OFF_RAD / 2])
    pace = (poses[1, 1:] - poses[0, 1:]) / max(poses[1, 0] - poses[0, 0], 1e-9)
    for k in range(2, len(poses)):
        even = poses[first, 1:] + pace * (poses[k, 0] - poses[first, 0])
        if (np.abs(poses[k, 1:] - even) > allowed).any():
            first = k - 1
            kept.append(first)
            pace = (poses[k, 1:] - poses[first, 1:]) / max(poses[k, 0] - poses[first, 0], 1e-9)
    return poses[[*kept, len(poses) - 1]]


def trace_of_stops(table: bytes, aisles: Aisles, robot: Robot) -> Trace:
    """Return the trace of a day of which its stops are known, `fieldmon drive`'s ``.stops.csv``.

    The ways between them are those that the robot would drive, at even speed.

    Raises
    ------
    FileProblem
        If it is no such table, or of another plot.
    """
    # cells of the program's own: no byte of them is outside ASCII
    lines = list(csv.DictReader(table.decode("ascii", "replace").splitlines()))
    if not lines or ",".join(lines[0]) != STOP_COLUMNS:
        raise FileProblem(
            worded(
                "A table of stops must begin with the columns that `fieldmon drive` writes "
                "({columns}) and have a line a stop. Take the file that ends in .stops.csv.",
                columns=STOP_COLUMNS,
            )
        )
    recording, at, since_s = Recording(aisles, robot), GATE, 0.0
    for number, line in enumerate(lines, 2):
        plant, done_s, found = _stop_of(line, number, aisles)
        way = way_m(aisles, at, plant)
        drive_s = float(np.hypot(*np.diff(way, axis=0).T).sum()) / robot.speed_m_s
        there_s = min(since_s + drive_s, done_s)
        recording.take(Noted(done_s, plant, found, way), there_s)
        at, since_s = plant, done_s
    return trace_of(recording)


def _stop_of(line: dict[str, str], number: int, aisles: Aisles) -> tuple[int, float, bool | None]:
    try:
        plant, done_s = int(line["plant"]), float(line["done_s"])
        names = int(line["row"]), int(line["number"])
        found = {"": None, "0": False, "1": True}[line["found"]]
    except (KeyError, TypeError, ValueError) as error:
        raise FileProblem(
            worded(
                "Line {number} of the table of stops cannot be read.",
                number=number,
            )
        ) from error
    if 0 <= plant < len(aisles.grid):
        numbered = plant_numbers(aisles.grid, np.array([plant]))
        if (int(numbered.line[0]), int(numbered.number[0])) == names and np.isfinite(done_s):
            return plant, done_s, found
    raise FileProblem(
        worded(
            "Plant {plant} of line {number} is not row {names}, plant {names_2} of this "
            "plot. Open the plot or season that was driven.",
            plant=plant,
            number=number,
            names=names[0],
            names_2=names[1],
        )
    )


def trace_of_bag(bag: bytes, aisles: Aisles, robot: Robot) -> Trace:
    """Return the trace of a bag of ``fieldmon drive --bag``; its first message is second 0.

    Raises
    ------
    FileProblem
        If it cannot be read, or is of another plot.
    SettingError
        If the library that reads bags is not installed.
    """
    recording = Recording(aisles, robot)
    with working_folder() as folder:
        path = Path(folder) / "day.mcap"
        path.write_bytes(bag)
        for topic, at_s, message in read_bag(path, ("/tf", "/finds")):
            if topic == "/tf":
                move = message.transforms[0].transform
                here = np.array([[move.translation.x, move.translation.y]])
                x, y = _in_frame(aisles, here)[0].tolist()
                turn = 2 * np.arctan2(move.rotation.z, move.rotation.w)
                yaw = float(turn) - east_north_yaw(aisles.grid.frame)
                recording.track.add(at_s, x, y, yaw)
            elif topic == "/finds":
                recording.stops.append(_find_of(message.markers[0], at_s, aisles))
    if not len(recording.track.poses) or not recording.stops:
        raise FileProblem(
            worded("The bag holds no way or no finds. Take one of `fieldmon drive --bag`.")
        )
    return trace_of(recording)


def _find_of(marker: object, at_s: float, aisles: Aisles) -> Noted:
    plant, point = int(marker.id), marker.points[0]  # type: ignore[attr-defined]
    here = _in_frame(aisles, np.array([[point.x, point.y]]))[0]
    far = not 0 <= plant < len(aisles.grid)
    if far or np.hypot(*(aisles.grid.xy_m[plant] - here)) > _SAME_PLANT_M:
        raise FileProblem(
            worded(
                "Plant {plant} of the bag stands elsewhere on this plot. Open the plot or "
                "season that was driven.",
                plant=plant,
            )
        )
    found = colour_says(marker.colors[0])  # type: ignore[attr-defined]
    return Noted(at_s, plant, found, place_m(aisles, plant)[None])


def _in_frame(aisles: Aisles, east_north_m: Float) -> Float:
    """Return metres east and north of the plot's centre as metres of its frame."""
    frame = aisles.grid.frame
    return frame.xy_m(frame.turned(90.0).lonlat(east_north_m))


def believed_on_the_way(
    trace: Trace, morning: Belief, detects: float, most: int = 60
) -> list[tuple[float, Float]]:
    """Return what is believed while a day is driven: seconds, and chances ``(n,)``.

    Parameters
    ----------
    trace
        The day.
    morning
        What was believed before it.
    detects
        Chance that an inspection finds what is there.
    most
        At so many moments at most: at finds first, then evenly over the stops.
    """
    settings = BeliefSettings()
    told = [one for one in trace.stops if one.found is not None]
    finds = [k for k, one in enumerate(told, 1) if one.found][: most // 2]
    evenly = np.linspace(1, len(told), min(len(told), most - len(finds))).round().astype(int)
    plants = np.array([one.plant for one in told], np.int32)
    found = np.array([one.found for one in told], np.bool_)
    return [
        (told[k - 1].done_s, settings.evening(morning, plants[:k], found[:k], detects).chance)
        for k in sorted({*finds, *evenly.tolist()})
    ]
