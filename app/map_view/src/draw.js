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

  // `mode` is null or {kind: "point" | "line" | "area" | "lasso", snap: [[lon, lat], ...], id}
  begin(mode) {
    if (mode?.id === this.mode?.id) return;
    this.mode = mode;
    this.points = [];
    this.changed();
  }

  get least() {
    return { point: 1, line: 2 }[this.mode?.kind] ?? 3;
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
    this.points = [...this.points, this.snapped(here, viewport)];
    this.changed();
    if (this.mode.kind === "point") this.finish();
  }

  move(k, here, viewport) {
    this.points = this.points.with(k, this.snapped(here, viewport));
    this.changed();
  }

  trail(here) {
    this.points = [...this.points, here];
    this.changed();
  }

  undo() {
    this.points = this.points.slice(0, -1);
    this.changed();
  }

  drop() {
    this.points = [];
    this.changed();
  }

  finish() {
    if (!this.ready) return;
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
    const line = { "@@type": "PathLayer", id: "drawing", data: [{ p: path }], getPath: "@@=p",
                   getColor: colour, getWidth: 2, widthUnits: "pixels" };
    if (this.mode.kind === "lasso") return [line];
    return [line, {
      "@@type": "ScatterplotLayer", id: "corners", data: this.points.map((p) => ({ p })), getPosition: "@@=p",
      getFillColor: [255, 255, 255], getLineColor: colour, stroked: true, getRadius: 6, radiusUnits: "pixels",
      getLineWidth: 2, lineWidthUnits: "pixels",
    }];
  }
}
