// Drawing on the map: points by clicks, which snap and can be dragged, taken back and finished.

const SNAP_PX = 10, GRAB_PX = 12;

export class Drawing {
  // `tell` takes the finished corners; `changed` is called when there is something new to draw
  constructor(changed, tell) {
    this.changed = changed;
    this.tell = tell;
    this.points = [];
    this.mode = null;
  }

  // `mode` is null or {kind: "point" | "line" | "area" | "lasso", snap: [[lon, lat], ...], id};
  // with `points` it begins with these, and each change of them is told at once (kind "bent")
  begin(mode) {
    if (mode?.id === this.mode?.id) return;
    this.mode = mode;
    this.points = this.bends ? mode.points : [];
    this.changed();
  }

  // Whether a line that is there is bent, rather than a new one drawn.
  get bends() {
    return this.mode?.kind === "bent";
  }

  get least() {
    return { point: 1, line: 2, bent: 2 }[this.mode?.kind] ?? 3;
  }

  get ready() {
    return this.points.length >= this.least;
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
    this.points = [...this.points, this.snapped(here, viewport)];
    this.changed();
    if (this.mode.kind === "point") this.finish();
  }

  move(k, here, viewport) {
    this.points = this.points.with(k, this.snapped(here, viewport));
    this.changed();
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
    if (this.bends && this.ready) this.tell(this.mode, this.points);
  }

  trail(here) {
    this.points = [...this.points, here];
    this.changed();
  }

  undo() {
    this.points = this.points.slice(0, -1);
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
    const done = this.points;
    this.points = [];
    this.changed();
    this.tell(this.mode, done);
  }

  // Return the drawing so far as layers in pydeck's JSON.
  layers(colour) {
    if (!this.points.length) return [];
    const area = ["area", "lasso"].includes(this.mode.kind) && this.points.length > 2;
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
