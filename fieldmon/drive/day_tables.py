"""What a driven day comes to, as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import counted

if TYPE_CHECKING:
    from datetime import date
    from pathlib import Path

    from fieldmon.drive.day import DrivenDay

DAY_COLUMNS = (
    "date,robot,stops,found,touched,stuck,charged_s,driven_s,worst_cross_track_m,"
    "skipped,stops_before"
)
# less is not worth a word
_SEEN_M = 0.005
STOP_COLUMNS = "stop,plant,row,number,found,done_s,charged_s,driven_s,cross_track_m,touched,stuck"


def day_table(driven: DrivenDay, on: date, robot: str, before: int = 0) -> bytes:
    """Return a driven day as a table of one line (CSV).

    `before` are its inspections before it was begun again: no other figure knows of them.
    """
    figures = (
        f"{on},{robot},{len(driven.stops)},{driven.found},{len(driven.touched)},"
        f"{len(driven.stuck)},{driven.charged_s:.1f},{driven.driven_s:.1f},{driven.strayed_m:.3f},"
        f"{driven.skipped},{before}"
    )
    return f"{DAY_COLUMNS}\n{figures}\n".encode()


def stop_table(driven: DrivenDay) -> bytes:
    """Return the stops of a driven day, a line each (CSV); ``touched`` names plants."""
    lines = [STOP_COLUMNS]
    for k, one in enumerate(driven.stops, 1):
        stop, visit = one.stop, one.visit
        found = "" if visit.found is None else int(visit.found)
        done_s = visit.done_at_s(stop)
        touched = " ".join(str(plant) for plant in sorted(visit.touched))
        lines.append(
            f"{k},{stop.plant},{stop.row},{stop.number},{found},{done_s:.1f},{one.charged_s:.1f},"
            f"{one.driven_s:.1f},{visit.strayed_m:.3f},{touched},{int(bool(visit.stuck))}"
        )
    return "\n".join([*lines, ""]).encode()


def stops_path(path: Path) -> Path:
    """Return where the stops are written beside the table of the day."""
    return path.with_name(f"{path.stem}.stops{path.suffix}")


def in_words(driven: DrivenDay) -> str:
    """Return what a driven day comes to, in a sentence or two."""
    inspected = counted(len(driven.stops) - driven.skipped, "plant")
    skipped = f", {driven.skipped} could not be inspected" if driven.skipped else ""
    said = (
        f"{inspected} inspected, {driven.found} found infested{skipped}; charged "
        f"{driven.charged_s / 3600:.2f} h, driven {driven.driven_s / 3600:.2f} h "
        f"({100 * (driven.driven_s / driven.charged_s - 1) if driven.charged_s else 0:+.1f} %)."
    )
    if driven.strayed_m:
        said += (
            f" {counted(len(driven.touched), 'plant')} touched; at worst "
            f"{100 * driven.strayed_m:.0f} cm off the way."
        )
    if driven.over_m > _SEEN_M:
        said += (
            f" Its outline reached {100 * driven.over_m:.0f} cm over the plot's boundary, or into "
            "a hole or a no-go area."
        )
    if driven.late_s:
        came = "It came home" if driven.home_charged_s else "Its day ended"
        said += f" {came} {driven.late_s / 60:.0f} min after its hours."
    return "\n".join([said, *driven.stuck])


def is_driven_table(path: Path) -> bool:
    """Tell whether a file is a table of a driven day or of its stops, which nobody fills in."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        head = file.readline(1000).decode(errors="replace").strip()
    return head in {DAY_COLUMNS, STOP_COLUMNS}
