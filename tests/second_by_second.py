"""Where each of a team stands, second by second: an oracle that knows nothing of the planner."""

from itertools import combinations

import numpy as np
import shapely

from fieldmon.plot.obstacles import row_lines

# what sampling and the corners of a line may hide
CORNER_M = 1.0


def clock_of(routes, starts_s, step_s):
    """Return the moments of a team's day, every so many seconds."""
    ends = (route.end_s + at for route, at in zip(routes, starts_s, strict=True))
    return np.arange(0.0, max(ends, default=0.0), step_s)


def moments(route, begins):
    """Return when ``(k,)`` one comes to and leaves each corner of its line, and where they are."""
    times, places = [], []
    for v, (at_s, place) in enumerate(zip(route.line_s, route.line_m, strict=True)):
        leaves = route.leave_s[route.line_stop == v]
        for moment in (at_s, *leaves):
            times.append(moment + begins)
            places.append(place)
    return times, np.array(places)


def stands(route, begins, clock):
    """Return where one stands ``(2, t)`` at every moment, and whether it is out then ``(t,)``."""
    times, places = moments(route, begins)
    xy = np.array([np.interp(clock, times, places[:, k]) for k in range(2)])
    return xy, (clock >= begins) & (clock <= begins + route.end_s)


def in_aisles(routes, starts_s, step_s=2.0):
    """Return in which aisle each is at every step of the day, -1 for none, ``(m, t)``.

    By where it stands: between two lane ends, at the height of their lane.
    """
    clock = clock_of(routes, starts_s, step_s)
    found = np.full((len(routes), len(clock)), -1)
    for m, (route, begins) in enumerate(zip(routes, starts_s, strict=True)):
        if not len(route):
            continue
        grid = route.aisles.grid
        times, places = moments(route, begins)
        x, y = (np.interp(clock, times, places[:, k]) for k in range(2))
        leg = np.clip(np.searchsorted(times, clock, "right"), 1, len(times) - 1)
        ends_y = places[:, 1][np.stack((leg - 1, leg))]
        # all begin at the gate, and may wait there, though it may lie between two ends of a lane
        there = (clock > begins) & (clock <= begins + route.end_s)
        there &= np.hypot(x - places[0, 0], y - places[0, 1]) > 0.01
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


def nobody_head_on(routes, starts_s, passing_m, step_s=1.0):
    """Tell whether no two drive towards each other in a headland without the room they need.

    By moments after each other: both are in no aisle, each moves against the other and they come
    nearer, to less than half the room; and there row and edge are nearer to each other than all
    of it.
    """
    routes, starts_s = zip(
        *((route, at) for route, at in zip(routes, starts_s, strict=True) if len(route)),
        strict=True,
    ) if any(len(route) for route in routes) else ((), ())  # fmt: skip
    clock = clock_of(routes, starts_s, step_s)
    aisle = in_aisles(routes, starts_s, step_s)
    where = [stands(route, at, clock) for route, at in zip(routes, starts_s, strict=True)]
    for one, other in combinations(range(len(routes)), 2):
        (a, out_a), (b, out_b) = where[one], where[other]
        free = out_a & out_b & (aisle[one] < 0) & (aisle[other] < 0)
        towards = (np.diff(a) * np.diff(b)).sum(axis=0) < -1e-6
        apart_m = np.hypot(*(a - b))
        towards &= np.diff(apart_m) < 0.0
        near = apart_m < passing_m / 2 - CORNER_M
        step = free[:-1] & free[1:] & near[:-1] & near[1:] & towards
        # the last centimetres of a lane, up to where one waits, are no headland yet
        met = np.flatnonzero(step[:-1] & step[1:])
        grid = routes[one].aisles.grid
        # each approach where they come nearest
        for run in np.split(met, np.flatnonzero(np.diff(met) > 1) + 1) if len(met) else []:
            here = shapely.Point(a[:, run[-1] + 2])
            row_m = shapely.distance(row_lines(grid), here).min()
            edge_m = shapely.distance(shapely.boundary(grid.drivable_m), here)
            if row_m + edge_m < passing_m - CORNER_M:
                return False
    return True
