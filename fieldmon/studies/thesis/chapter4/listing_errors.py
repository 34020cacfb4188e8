"""The slips of the thesis's listings, each with a name and a switch."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace


@dataclass(frozen=True)
class ListingErrors:
    """Where the listings of appendix A do something else than the prose says.

    True is as published. Every field can be switched off alone, so that its effect can be shown.

    Parameters
    ----------
    night_other_face
        In listing A.5 (snake), and wherever its rule is used, an infested face on an odd side
        infects the other face of its vine only at the two ends of the row: ``pos+1`` where
        ``pos+P`` was meant. Off: everywhere.
    night_row_index
        In A.6 (neighbor) and A.7 (random snake) the row index of the night sticks at 1, or at 2 on
        nights when the last vine of side 1 spreads: insects stay on their side, leave its end for
        the next side, and a run is aborted when the last face of the field spreads. Off: rows are
        what they are.
    phantom_infections
        The counter of new infections also counts faces that were infested before, or that the
        first slip left clean; percentages of "all insects so far" use that counter. Off: it counts
        what was infested.
    travel_once
        Driving is charged for one vine whatever N. Off: for N vines.
    row_change_by_counter
        Snake strategies pay 25 s when a counter, not the robot, reaches the end of a row; with
        N > 1 it seldom does. Off: 23 s for the other side of an aisle, 25 s for the next.
    one_way_rows
        Every side is walked from its first vine, so that the robot leaps back over the whole row
        between sides. Off: up one side and down the next (snake), or one aisle and the next
        (neighbor).
    reentry_by_index
        At the end of the field the robot turns to the least visited of the last N faces by number
        (random snake: one face back or forth). Off: to the nearest face never visited.
    unequal_viewpoints
        Snake strategies look from three viewpoints (23.74 s), neighbor strategies from one
        (4.34 s). Off: both from three.
    draw_every_stop
        Random strategies draw N at every stop, as the prose says: no slip, but some printed cells
        look like the other reading. Off: once for each pass along a row.
    draw_one_to_five
        Random strategies draw N from 1 to 5, the prose says 1 to 4. Off: 1 to 4.
    """

    night_other_face: bool = True
    night_row_index: bool = True
    phantom_infections: bool = True
    travel_once: bool = True
    row_change_by_counter: bool = True
    one_way_rows: bool = True
    reentry_by_index: bool = True
    unequal_viewpoints: bool = True
    draw_every_stop: bool = True
    draw_one_to_five: bool = True

    def without(self, *names: str) -> ListingErrors:
        """Return these slips with the named ones put right."""
        return replace(self, **dict.fromkeys(names, False))


NAMES = tuple(field.name for field in fields(ListingErrors))
AS_PUBLISHED = ListingErrors()
NIGHT_CORRECTED = AS_PUBLISHED.without("night_other_face", "night_row_index")
ALL_PUT_RIGHT = AS_PUBLISHED.without(*(name for name in NAMES if name != "draw_every_stop"))
