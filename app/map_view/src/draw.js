// Drawing on the map: points by clicks, which snap and can be dragged, taken back and finished.

const SNAP_PX = 10, GRAB_PX = 12;
const WRONG = [200, 40, 30];

export class Drawing {
  // `tell` takes the finished corners; `changed` is called when there is something new to draw
  constructor(changed, tell) {
    this.changed = changed;
    this.tell = tell;
    this.points = [];
    this.past = []; // of a plot's corners, what was before each change
    this.mode = null;
  }

  // `mode` is null or {kind: "point" | "line" | "area" | "lasso", snap: [[lon, lat], ...], id};
  // with `points` it begins with these, and each change of them is told at once (kinds "bent" and "outline")
  begin(mode) {
    if (mode?.id === this.mode?.id) return;
    this.mode = mode;
    this.points = this.kept = this.bends || this.outlines ? mode.points : [];
    this.past = [];
    this.changed();
  }

  // Whether a plot is drawn by its corners.
  get outlines() {
    return this.mode?.kind === "outline";
  }

  // Whether a line that is there is bent, rather than a new one drawn.
  get bends() {
    return this.mode?.kind === "bent";
  }

  get least() {
    return { point: 1, line: 2, bent: 2 }[this.mode?.kind] ?? 3;
  }

  get ready() {
    return this.points.length >= this.least && !this.crosses;
  }

  // Whether the edges of a plot's outline meet where they should not: it is none then.
  get crosses() {
    return this.outlines && crossing(this.points);
  }

  snapped(here, viewport) {
    const at = viewport.project(here);
    const near = (p) => {
      const [x, y] = viewport.project(p);
      return Math.hypot(x - at[0], y - at[1]);
    };
    const [best] = (this.mode.snap ?? [])
      .map((p) => [near(p), p]).filter(([far]) => far <= SNAP_PX).sort((a, b) => a[0] - b[0]);
    return best ? best[1] : here;
  }

  // Return which corner a press takes hold of, or -1.
  grabbed(here, viewport) {
    const at = viewport.project(here);
    return this.points.findIndex((p) => {
      const [x, y] = viewport.project(p);
      return Math.hypot(x - at[0], y - at[1]) <= GRAB_PX;
    });
  }

  click(here, viewport) {
    if (this.bends) {
      this.points = this.points.toSpliced(this.place(here, viewport), 0, here);
      this.changed();
      this.told();
      return;
    }
    if (this.outlines) {
      const corner = this.grabbed(here, viewport);
      if (corner < 0) this.add(here, this.onEdge(here, viewport));
      else if (corner === 0) this.finish(); // as many are used to close an outline
      return;
    }
    this.points = [...this.points, this.snapped(here, viewport)];
    this.changed();
    if (this.mode.kind === "point") this.finish();
  }

  move(k, here, viewport) {
    this.points = this.points.with(k, rounded(this.snapped(here, viewport)));
    this.changed();
  }

  // Set a corner of a plot, the last one or another.
  add(here, k = this.points.length) {
    this.points = this.points.toSpliced(k, 0, rounded(here));
    this.changed();
    this.told();
  }

  // Return which corner one becomes that is set on an edge, or just the last.
  onEdge(here, viewport) {
    const at = viewport.project(here), corners = this.points.map((p) => viewport.project(p));
    const k = corners.findIndex((a, i) => i + 1 < corners.length && offEdge(at, a, corners[i + 1]) <= SNAP_PX);
    return k < 0 ? this.points.length : k + 1;
  }

  // Let go of a corner that was dragged: one that lies on the next or on the one before is gone.
  dropped(k, viewport) {
    if (this.outlines) {
      const n = this.points.length, [x, y] = viewport.project(this.points[k]);
      const meets = [k + 1, k + n - 1].some((j) => {
        const [u, v] = viewport.project(this.points[j % n]);
        return n > 1 && Math.hypot(x - u, y - v) <= SNAP_PX;
      });
      if (meets) this.points = this.points.toSpliced(k, 1);
      this.changed();
    }
    this.told();
  }

  // Return where in a line a new corner comes: in its nearest step, or on at an end.
  place(here, viewport) {
    const at = viewport.project(here), corners = this.points.map((p) => viewport.project(p));
    let best = [Infinity, 0];
    for (let k = 0; k + 1 < corners.length; k += 1) {
      const [a, b] = [corners[k], corners[k + 1]];
      const [x, y] = [b[0] - a[0], b[1] - a[1]];
      const share = ((at[0] - a[0]) * x + (at[1] - a[1]) * y) / Math.max(x * x + y * y, 1e-9);
      const near = Math.min(Math.max(share, 0), 1);
      const off = Math.hypot(at[0] - a[0] - near * x, at[1] - a[1] - near * y);
      const brink = share < 0 && k === 0 ? 0 : share > 1 && k + 2 === corners.length ? k + 2 : k + 1;
      if (off < best[0]) best = [off, brink];
    }
    return best[1];
  }

  // Tell how the line runs now; it stays to be bent on.
  told() {
    if (this.outlines && this.points !== this.kept) this.past.push(this.kept);
    this.kept = this.points;
    if ((this.bends && this.ready) || this.outlines) this.tell(this.mode, this.points);
  }

  trail(here) {
    this.points = [...this.points, here];
    this.changed();
  }

  get canUndo() {
    return this.points.length + this.past.length > 0;
  }

  undo() {
    this.points = this.past.pop() ?? this.points.slice(0, -1);
    this.kept = this.points;
    this.changed();
    this.told();
  }

  drop() {
    this.points = this.bends ? this.mode.points : [];
    this.changed();
    this.told();
  }

  finish() {
    if (!this.ready || this.bends) return;
    if (this.outlines) {
      // it stays until the server has taken it: it may be none
      this.tell({ ...this.mode, id: `${this.mode.id} done` }, this.points);
      return;
    }
    const done = this.points;
    this.points = [];
    this.changed();
    this.tell(this.mode, done);
  }

  // Return the numbers of a plot's corners, outside of them, and the lengths of its edges, also while one is dragged.
  labels() {
    const corners = this.points, n = corners.length, sum = (k) => corners.reduce((all, p) => all + p[k], 0);
    const numbers = corners.map((p, k) => (
      { p, t: `${k + 1}`, k: "leg", tight: true, gap: 9, away: [2 * p[0] - sum(0) / n, 2 * p[1] - sum(1) / n] }));
    const edges = corners.slice(0, n > 2 ? n : Math.max(n - 1, 0)).map((p, k) => {
      const q = corners[(k + 1) % n];
      return { p: [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2], t: lengthOf(metresBetween(p, q), this.mode.lengths), k: "edge" };
    });
    return [...numbers, ...edges];
  }

  // Return the drawing so far as layers in pydeck's JSON.
  layers(usual) {
    if (!this.points.length) return [];
    const colour = this.crosses ? WRONG : usual;
    const area = ["area", "lasso", "outline"].includes(this.mode.kind) && this.points.length > 2;
    const path = area ? [...this.points, this.points[0]] : this.points;
    // a casing lets it be seen on plants of its own colour
    const around = colour.reduce((sum, one) => sum + one, 0) > 382 ? [0, 0, 0] : [255, 255, 255];
    const lines = [["drawing-casing", around, 7], ["drawing", colour, 3]].map(([id, getColor, getWidth]) => (
      { "@@type": "PathLayer", id, data: [{ p: path }], getPath: "@@=p", getColor, getWidth, widthUnits: "pixels" }));
    if (this.mode.kind === "lasso") return lines;
    return [...lines, {
      "@@type": "ScatterplotLayer", id: "corners", data: this.points.map((p) => ({ p })), getPosition: "@@=p",
      getFillColor: [255, 255, 255], getLineColor: colour, stroked: true, getRadius: 6, radiusUnits: "pixels",
      getLineWidth: 2, lineWidthUnits: "pixels",
    }];
  }
}

// Return whether two edges of a closed line cross that are not next to each other.
function crossing(corners) {
  const n = corners.length, edge = (k) => [corners[k], corners[(k + 1) % n]];
  const side = ([a, b], [c, d], [e, f]) => Math.sign((c - a) * (f - b) - (d - b) * (e - a));
  const cross = ([a, b], [c, d]) => side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
  return corners.some((_, k) => corners.some((__, j) => j > k + 1 && j - k < n - 1 && cross(edge(k), edge(j))));
}

// Return a place to the centimetre, as the server keeps it.
function rounded(here) {
  return here.map((deg) => Math.round(deg * 1e7) / 1e7);
}

// Write a length as the server does: `ways` are [from how many metres on, a unit's metres, a number's form, text].
function lengthOf(metres, ways) {
  const [, one, form, text] = ways.findLast(([from]) => metres >= from);
  const [, mark, decimals] = /^0(?:(.)(0+))?$/.exec(form);
  return text.replace("{n}", (metres / one).toFixed(decimals?.length ?? 0).replace(".", mark ?? "."));
}

// Return how far two near places are from each other on WGS 84, by the length of a degree between them.
function metresBetween([a, b], [c, d]) {
  const at = ((b + d) * Math.PI) / 360, east = 111412.84 * Math.cos(at) - 93.5 * Math.cos(3 * at) + 0.118 * Math.cos(5 * at);
  return Math.hypot((c - a) * east, (d - b) * (111132.954 - 559.822 * Math.cos(2 * at) + 1.175 * Math.cos(4 * at)));
}

// Return how far a place is from an edge, in pixels; beyond its ends, and near them, it is not on it.
function offEdge([x, y], [ax, ay], [bx, by]) {
  const [u, v] = [bx - ax, by - ay], long = Math.hypot(u, v);
  const along = ((x - ax) * u + (y - ay) * v) / Math.max(long, 1e-9);
  if (along < GRAB_PX || along > long - GRAB_PX) return Infinity;
  return Math.abs((x - ax) * v - (y - ay) * u) / long;
}
