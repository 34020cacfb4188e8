"""Where each of a team stands, second by second: an oracle that knows nothing of the planner."""

from itertools import combinations

import numpy as np


def in_aisles(routes, starts_s, step_s=2.0):
    """Return in which aisle each is at every step of the day, -1 for none, ``(m, t)``.

    By where it stands: between two lane ends, at the height of their lane. At the gate, which may
    lie on a lane's line, all stand at once: they are in no aisle yet.
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
        x, y = (np.interp(clock, times, np.array(places)[:, k]) for k in range(2))
        there = (clock >= begins) & (clock <= begins + route.end_s)
        there &= np.hypot(x - places[0][0], y - places[0][1]) > 0.1
        for row in range(grid.n_rows):
            low, high = grid.lane_x_m[row]
            inside = (np.abs(y - grid.lane_y_m[row]) < 0.01) & (x > low + 0.1) & (x < high - 0.1)
            found[m, there & inside] = grid.corridor[row]
    return found


def nobody_together(routes, starts_s):
    """Tell whether no two are in one aisle at any step."""
    return not any(
        ((one == other) & (one >= 0)).any()
        for one, other in combinations(in_aisles(routes, starts_s), 2)
    )
