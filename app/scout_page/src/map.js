// A map on one canvas: plants by their chance, what is known, the way, and where one is.
// No tiles and no graphics card: it is there with the first picture of the page.

import { twinOf } from "./geo.js";

const CLASSES = [10, 50, 150, 400, 1001]; // of a chance, in thousandths, as in the app
const PAINT = {
  sun: { ground: "#ffffff", classes: ["#d5d9d0", "#f5d76e", "#f08c1e", "#c8500a", "#7d1f02"], edge: "#555", route: "#000",
    found: "#d55e00", clean: "#0067a5", ring: "#000", next: "#ffbe00", here: "#0a5bd6", spot: "#d55e00", asked: "#6a1b9a", ink: "#000" },
  dark: { ground: "#101214", classes: ["#3a423a", "#8a7420", "#b5650f", "#dd5a12", "#ff7a45"], edge: "#889", route: "#fff",
    found: "#ff8a3c", clean: "#56b4e9", ring: "#fff", next: "#ffd54a", here: "#7db4ff", spot: "#ff8a3c", asked: "#e0b0ff", ink: "#fff" },
};
const FINGER = 26;

/** The room of a plant, or of each of its faces, across. */
const roomOf = ({ plantSpacing, rowSpacing, face }) => (face ? Math.min(plantSpacing, rowSpacing) / 2 : plantSpacing);

// plants along the side of a square in which they are looked up
const SQUARE = 16;

/** `picked(plant, isSure)`: where the finger covers both faces of a plant, it is not sure which is meant. */
export class PlotMap {
  constructor(canvas, { picked }) {
    this.canvas = canvas;
    this.picked = picked;
    this.theme = "sun";
    this.scale = 1; // pixels of the screen per metre
    this.middle = [0, 0];
    this.shown = { ahead: [], way: [], asked: [], found: new Set(), clean: new Set(), skipped: new Set(), recorded: new Set(), next: -1, position: null };
    this.touches = new Map();
    this.#listen();
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  /** Show a plot and a day. */
  lay(plot, chance, hotSpots) {
    this.plot = { ...plot, ...plot.drawn, room: roomOf(plot), itself: plot };
    this.hotSpots = hotSpots;
    const n = plot.x.length;
    this.klass = new Uint8Array(n);
    for (let i = 0; i < n; i++) { let c = 0; while (chance[i] >= CLASSES[c]) c++; this.klass[i] = c; }
    this.squares = inSquares(this.plot, this.klass);
    if (!this.laid) { this.laid = true; this.fit(); }
    this.draw();
  }

  /** Show no plot. */
  clear() {
    if (!this.plot) return;
    Object.assign(this, { plot: null, laid: false });
    this.canvas.getContext("2d").clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  /** Show this with the next picture, or with the one after it where something else comes first. */
  show(changes, late = false) {
    Object.assign(this.shown, changes);
    if (late) requestAnimationFrame(() => setTimeout(() => this.draw()));
    else this.draw();
  }

  fit() {
    if (!this.plot) return;
    const { x, y } = this.plot;
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let i = 0; i < x.length; i++) {
      if (x[i] < x0) x0 = x[i]; if (x[i] > x1) x1 = x[i];
      if (y[i] < y0) y0 = y[i]; if (y[i] > y1) y1 = y[i];
    }
    this.middle = [(x0 + x1) / 2, (y0 + y1) / 2];
    this.scale = Math.min(this.width / (x1 - x0 + 20), this.height / (y1 - y0 + 20));
    this.draw();
  }

  /** Bring a plant into the middle, close enough to be told from its neighbours. */
  look(plant, late = false) {
    if (plant < 0 || !this.plot) return;
    this.middle = [this.plot.x[plant], this.plot.y[plant]];
    this.scale = Math.max(this.scale, 22 / this.plot.room);
    this.show({}, late);
  }

  zoom(by, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.#metres(px, py);
    this.scale = Math.min(Math.max(this.scale * by, 0.05), 200);
    const [x2, y2] = this.#metres(px, py);
    this.middle = [this.middle[0] + x - x2, this.middle[1] + y - y2];
    this.draw();
  }

  pan(dx, dy) {
    this.middle = [this.middle[0] - dx / this.scale, this.middle[1] + dy / this.scale];
    this.draw();
  }

  draw() {
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => { this.asked = 0; this.#paint(); });
  }

  #resize() {
    const box = this.canvas.getBoundingClientRect(), dense = Math.min(devicePixelRatio || 1, 2);
    const wasHidden = !this.width;
    [this.width, this.height, this.dense] = [box.width, box.height, dense];
    this.canvas.width = Math.round(box.width * dense);
    this.canvas.height = Math.round(box.height * dense);
    if (wasHidden && this.plot && this.width) this.fit();
    if (this.plot && this.width) this.#paint();
  }

  #metres(px, py) {
    return [this.middle[0] + (px - this.width / 2) / this.scale, this.middle[1] - (py - this.height / 2) / this.scale];
  }

  #pixels(x, y) {
    return [this.width / 2 + (x - this.middle[0]) * this.scale, this.height / 2 - (y - this.middle[1]) * this.scale];
  }

  #paint() {
    if (!this.plot || !this.width) return;
    const ink = this.canvas.getContext("2d", { alpha: false }), paint = PAINT[this.theme];
    this.#plants(ink, paint);
    ink.setTransform(this.dense, 0, 0, this.dense, 0, 0);
    this.#outlines(ink, paint);
    this.#way(ink, paint);
    this.#known(ink, paint);
    this.#asked(ink, paint);
    this.#next(ink, paint);
    this.#here(ink, paint);
    this.canvas.dataset.drawn = (Number(this.canvas.dataset.drawn) || 0) + 1;
  }

  /** Squares straight into the pixels: a hundred thousand of them in a few milliseconds. */
  #plants(ink, paint) {
    const { x, y } = this.plot, { width, height } = this.canvas, dense = this.dense;
    const image = ink.createImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    pixels.fill(packed(paint.ground));
    const colours = paint.classes.map(packed);
    const by = this.scale * dense, side = Math.max(1, Math.round(Math.min(this.plot.room * 0.6 * by, 14 * dense)));
    const x0 = width / 2 - this.middle[0] * by, y0 = height / 2 + this.middle[1] * by, half = side >> 1;
    const paintOne = (i, colour) => {
      const left = Math.round(x0 + x[i] * by) - half, top = Math.round(y0 - y[i] * by) - half;
      if (left < 0 || top < 0 || left + side > width || top + side > height) return;
      for (let row = top; row < top + side; row++) pixels.fill(colour, row * width + left, row * width + left + side);
    };
    // the likeliest last: they must not vanish under others where plants are smaller than pixels
    const [west, north] = this.#metres(0, 0), [east, south] = this.#metres(this.width, this.height);
    for (let klass = 0; klass < CLASSES.length; klass++) this.squares.each(klass, [west, south, east, north], (i) => paintOne(i, colours[klass]));
    ink.putImageData(image, 0, 0);
  }

  #outlines(ink, paint) {
    ink.lineWidth = 1.5;
    ink.strokeStyle = paint.edge;
    for (const ring of this.plot.boundary) this.#line(ink, ring);
    ink.strokeStyle = paint.spot;
    ink.lineWidth = 3;
    ink.setLineDash([8, 5]);
    for (const ring of this.hotSpots) this.#line(ink, ring);
    ink.setLineDash([]);
  }

  #line(ink, points) {
    ink.beginPath();
    points.forEach((at, k) => ink[k ? "lineTo" : "moveTo"](...this.#pixels(...at)));
    ink.stroke();
  }

  #way(ink, paint) {
    const apart = this.plot.room * this.scale; // from afar stops and aisles would be one blot
    ink.strokeStyle = paint.route;
    ink.lineWidth = Math.max(0.75, Math.min(2, apart));
    this.#line(ink, this.shown.way);
    ink.fillStyle = paint.route;
    const r = Math.min(3, 0.35 * apart);
    if (r >= 1) for (const plant of this.shown.ahead) this.#dot(ink, plant, r);
  }

  /** A square where a photo is asked for. */
  #asked(ink, paint) {
    ink.strokeStyle = paint.asked;
    ink.lineWidth = 4;
    for (const plant of this.shown.asked) {
      const [px, py] = this.#pixels(this.plot.x[plant], this.plot.y[plant]);
      ink.strokeRect(px - 11, py - 11, 22, 22);
    }
  }

  #dot(ink, plant, r) {
    const [px, py] = this.#pixels(this.plot.x[plant], this.plot.y[plant]);
    if (px < -r || py < -r || px > this.width + r || py > this.height + r) return;
    ink.beginPath();
    ink.arc(px, py, r, 0, 7);
    ink.fill();
  }

  #known(ink, paint) {
    const r = Math.max(3.5, Math.min(9, this.plot.room * 0.4 * this.scale));
    ink.fillStyle = paint.clean;
    for (const plant of this.shown.clean) this.#dot(ink, plant, r * 0.8);
    ink.lineWidth = 3;
    ink.strokeStyle = paint.edge;
    for (const plant of this.shown.skipped) this.#cross(ink, plant, r);
    // hollow: no inspection of the season found it
    ink.fillStyle = paint.ground;
    ink.strokeStyle = paint.found;
    ink.lineWidth = 2;
    for (const plant of this.shown.recorded) {
      this.#blank(ink, plant);
      this.#diamond(ink, plant, r);
    }
    ink.fillStyle = paint.found;
    ink.strokeStyle = paint.ring;
    ink.lineWidth = 1.5;
    for (const plant of this.shown.found) this.#diamond(ink, plant, r * 1.3);
  }

  #cross(ink, plant, r) {
    const [px, py] = this.#pixels(this.plot.x[plant], this.plot.y[plant]);
    ink.beginPath();
    ink.moveTo(px - r, py - r); ink.lineTo(px + r, py + r);
    ink.moveTo(px + r, py - r); ink.lineTo(px - r, py + r);
    ink.stroke();
  }

  /** Take a plant's square away: its corners would make a star of the diamond on it. */
  #blank(ink, plant) {
    const [px, py] = this.#pixels(this.plot.x[plant], this.plot.y[plant]), side = Math.min(this.plot.room * 0.6 * this.scale, 14) + 2;
    ink.fillRect(px - side / 2, py - side / 2, side, side);
  }

  #diamond(ink, plant, r) {
    const [px, py] = this.#pixels(this.plot.x[plant], this.plot.y[plant]);
    ink.beginPath();
    ink.moveTo(px, py - r); ink.lineTo(px + r, py); ink.lineTo(px, py + r); ink.lineTo(px - r, py);
    ink.closePath();
    ink.fill();
    ink.stroke();
  }

  #next(ink, paint) {
    const { next } = this.shown;
    if (next < 0) return;
    const [px, py] = this.#pixels(this.plot.x[next], this.plot.y[next]);
    for (const [colour, width] of [[paint.ring, 8], [paint.next, 5]]) {
      ink.strokeStyle = colour;
      ink.lineWidth = width;
      ink.beginPath();
      ink.arc(px, py, 15, 0, 7);
      ink.stroke();
    }
  }

  #here(ink, paint) {
    const { position } = this.shown;
    if (!position) return;
    const [px, py] = this.#pixels(position.x, position.y);
    ink.beginPath();
    ink.arc(px, py, position.accuracy * this.scale, 0, 7);
    ink.globalAlpha = 0.18;
    ink.fillStyle = paint.here;
    ink.fill();
    ink.globalAlpha = 1;
    ink.strokeStyle = paint.here;
    ink.lineWidth = 1.5;
    ink.stroke();
    ink.beginPath();
    ink.arc(px, py, 7, 0, 7);
    ink.fillStyle = paint.here;
    ink.fill();
    ink.lineWidth = 2.5;
    ink.strokeStyle = paint.ground;
    ink.stroke();
  }

  #listen() {
    const { canvas } = this;
    const at = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.touches.set(event.pointerId, at(event));
      if (this.touches.size === 1) this.began = at(event);
      else this.began = null;
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = this.touches.get(event.pointerId);
      if (!before) return;
      const now = at(event);
      if (this.touches.size === 2) {
        const [other] = [...this.touches].filter(([id]) => id !== event.pointerId).map(([, where]) => where);
        const gap = (where) => Math.hypot(where[0] - other[0], where[1] - other[1]);
        this.zoom(gap(now) / Math.max(1, gap(before)), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      }
      if (this.began && Math.hypot(now[0] - this.began[0], now[1] - this.began[1]) > 10) this.began = null;
      if (!this.began) this.pan((now[0] - before[0]) / this.touches.size, (now[1] - before[1]) / this.touches.size);
      this.touches.set(event.pointerId, now);
    });
    const up = (event) => {
      this.touches.delete(event.pointerId);
      if (this.began && event.type === "pointerup") this.#tap(...this.began);
      this.began = null;
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.zoom(event.deltaY < 0 ? 1.25 : 0.8, ...at(event)); }, { passive: false });
    const keys = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] };
    canvas.addEventListener("keydown", (event) => {
      if (keys[event.key]) this.pan(...keys[event.key]);
      else if (event.key === "+" || event.key === "-") this.zoom(event.key === "+" ? 1.5 : 1 / 1.5);
      else return;
      event.preventDefault();
    });
  }

  #tap(px, py) {
    if (!this.plot) return;
    const [x, y] = this.#metres(px, py);
    let best = FINGER / this.scale, plant = -1;
    for (let i = 0; i < this.plot.x.length; i++) {
      const d = Math.hypot(this.plot.x[i] - x, this.plot.y[i] - y);
      if (d < best) { best = d; plant = i; }
    }
    // from afar a finger covers a hundred plants: the first tap comes closer
    if (plant >= 0 && this.scale * this.plot.room < 7) { this.middle = [x, y]; this.zoom(14 / this.plot.room / this.scale); return; }
    if (plant < 0) return;
    const twin = twinOf(this.plot.itself, plant);
    this.picked(plant, twin < 0 || Math.hypot(this.plot.x[twin] - x, this.plot.y[twin] - y) > FINGER / this.scale);
  }
}

/** Plants by their class and by the square that they stand in: what is in sight is found without the rest. */
function inSquares({ x, y, plantSpacing, rowSpacing }, klass) {
  const n = x.length, size = SQUARE * Math.max(plantSpacing, rowSpacing);
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let i = 0; i < n; i++) {
    if (x[i] < x0) x0 = x[i]; if (x[i] > x1) x1 = x[i];
    if (y[i] < y0) y0 = y[i]; if (y[i] > y1) y1 = y[i];
  }
  const across = Math.floor((x1 - x0) / size) + 1, up = Math.floor((y1 - y0) / size) + 1;
  const square = (i) => (klass[i] * up + Math.floor((y[i] - y0) / size)) * across + Math.floor((x[i] - x0) / size);
  const first = new Int32Array(CLASSES.length * across * up + 1), plants = new Int32Array(n);
  for (let i = 0; i < n; i++) first[square(i) + 1] += 1;
  for (let k = 1; k < first.length; k++) first[k] += first[k - 1];
  const next = first.slice();
  for (let i = 0; i < n; i++) plants[next[square(i)]++] = i;
  const within = (value, most) => Math.min(Math.max(Math.floor(value / size), 0), most - 1);
  return {
    each(wanted, [west, south, east, north], work) {
      const from = within(west - x0, across), to = within(east - x0, across);
      for (let k = within(south - y0, up); k <= within(north - y0, up); k++) {
        const line = (wanted * up + k) * across;
        for (let j = first[line + from]; j < first[line + to + 1]; j++) work(plants[j]);
      }
    },
  };
}

function packed(colour) {
  const [r, g, b] = [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
  return (255 << 24) | (b << 16) | (g << 8) | r;
}
