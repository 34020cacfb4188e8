"""Where each of a team stands, second by second: an oracle that knows nothing of the planner."""

from itertools import combinations

import numpy as np


def in_aisles(routes, starts_s, step_s=2.0):
    """Return in which aisle each is at every step of the day, -1 for none, ``(m, t)``.

    By where it stands: between two lane ends, at the height of their lane.
    """
    until = max((route.end_s + at for route, at in zip(routes, starts_s, strict=True)), default=0.0)
    clock = np.arange(0.0, until, step_s)
    found = np.full((len(routes), len(clock)), -1)
    for m, (route, begins) in enumerate(zip(routes, starts_s, strict=True)):
        if not len(route):
            continue
        grid = route.aisles.grid
        times, places = [], []
        for v, (at_s, place) in enumerate(zip(route.line_s, route.line_m, strict=True)):
            leaves = route.leave_s[route.line_stop == v]
            for moment in (at_s, *leaves):
                times.append(moment + begins)
                places.append(place)
        x = np.interp(clock, times, np.array(places)[:, 0])
        leg = np.clip(np.searchsorted(times, clock, "right"), 1, len(times) - 1)
        ends_y = np.array(places)[:, 1][np.stack((leg - 1, leg))]
        # all begin at the gate, which may lie between two ends of a lane
        there = (clock > begins) & (clock <= begins + route.end_s)
        for row in range(grid.n_rows):
            low, high = grid.lane_x_m[row]
            # a way to a lane's end from a gate close beside the lane is not a way in it
            along = (np.abs(ends_y - grid.lane_y_m[row]) < 0.01).all(axis=0)
            inside = along & (x > low + 0.1) & (x < high - 0.1)
            found[m, there & inside] = grid.corridor[row]
    return found


def nobody_together(routes, starts_s):
    """Tell whether no two are in one aisle at any step."""
    return not any(
        ((one == other) & (one >= 0)).any()
        for one, other in combinations(in_aisles(routes, starts_s), 2)
    )
