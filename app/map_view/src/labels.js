// Words and numbers on the map, as the page's own text: any script, any direction, never crowded.

// which switch a kind of label belongs to
const SWITCH = { hot: "hot", leg: "numbers", stop: "numbers", zone: "numbers", row: "rows", place: "plan", block: "rows" };

// every so many rows have their numbers, where there is not room for each
const STEPS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, Infinity];

// how much of a number others must leave free where it had rather be crowded than missing
const TIGHT = 0.6;

const NUMBERS = new Set(["leg", "stop", "zone"]);
const numbered = new WeakMap();
const known = new WeakMap();

// Return the labels with the numbers of the hot spots that are shown: after those of stops, which
// they never cover, before all other words.
export function withHot(labels, jsons) {
  const hot = jsons.find((json) => json.id === "hot");
  if (!hot) return labels;
  const before = numbered.get(hot);
  if (before?.labels === labels) return before.made;
  const own = hot.data.flatMap(({ number }) => (number ? [{ p: number.at[0], at: number.at, t: number.t, k: "hot" }] : []));
  const made = [...labels.filter(({ k }) => NUMBERS.has(k)), ...own, ...labels.filter(({ k }) => !NUMBERS.has(k))];
  numbered.set(hot, { labels, made });
  return made;
}

// How far, in pixels, a label that stands beyond its place `p` is from it, in the direction of `away`.
function beyond(viewport, p, away, half, tall, gap) {
  const [x, y] = viewport.project(p), [u, v] = viewport.project(away), far = Math.hypot(u - x, v - y);
  if (!far) return [0, 0];
  const dx = (u - x) / far, dy = (v - y) / far;
  // as far as its own edge that way
  const step = gap + Math.min(half / Math.abs(dx), tall / Math.abs(dy));
  return [dx * step, dy * step];
}

// Return how large a word is: half its width, and half its height; a plot's name has room around it.
function sizeOf(t, k) {
  const lines = t.split("\n");
  return [4 * Math.max(...lines.map((one) => one.length)) + 7, 10 * lines.length + (k === "name" ? 3 : 0)];
}

// Return where a word stands that belongs beyond its place.
function pushed(viewport, p, { away, gap }, [half, tall]) {
  const [x, y] = viewport.project(p), [outX, outY] = away ? beyond(viewport, p, away, half, tall, gap ?? 3) : [0, 0];
  return [x + outX, y + outY];
}

// Return the rows that have labels, each with the number `n` by which every so many are shown: its own
// where these follow on from row to row, else its place.
function rowsOf(labels) {
  if (known.has(labels)) return known.get(labels);
  const rows = labels.filter(({ k, row }) => k === "row" && row), own = rows.map(({ t }) => Number(t)), by = own[1] - own[0];
  const follow = Math.abs(by) === 1 && own.every((n, k) => n === own[0] + by * k);
  const made = rows.map((one, k) => ({ ...one, n: follow ? own[k] : one.row }));
  known.set(labels, made);
  return made;
}

// Return the rows that have room for their numbers, with these' boxes [left, top, right, bottom]: the first
// and the last, and every so many, the same all over the plot, whatever is in view.
function numberedRows(labels, viewport) {
  const rows = rowsOf(labels).map(({ row, n, t, p, ...one }) => {
    const [half, tall] = sizeOf(t), [x, y] = pushed(viewport, p, one, [half, tall]);
    return { row, n, box: [x - half, y - tall, x + half, y + tall] };
  });
  if (rows.length < 2) return rows;
  const of = new Map(rows.map((one) => [one.n, one]));
  const covered = ({ box: a }, { box: b }) => a[0] < b[2] && a[2] > b[0] && a[1] < b[3] && a[3] > b[1];
  const step = STEPS.find((k) => rows.every((one) => one.n % k || !of.has(one.n + k) || !covered(one, of.get(one.n + k))));
  const ends = [rows[0], rows.at(-1)].filter((one, k, [first]) => !k || !covered(first, one));
  for (const one of ends) one.end = true;
  return rows.filter((one) => one.end || (one.n % step === 0 && !ends.some((end) => covered(end, one))));
}

// Return the boxes [left, top, right, bottom] of the numbers that rows have in a view.
export function rowBoxes(labels, viewport) {
  return numberedRows(labels, viewport).map(({ box }) => box);
}

// Return the boxes of the names of plots, and of the gate's, in a view: as wide as the name alone. Who works
// there when, below it, is moved into the map where it is drawn; room for all of it left none for the plots.
export function nameBoxes(labels, viewport) {
  return labels.filter(({ k }) => k === "name" || k === "gate").map((one) => {
    const [half] = sizeOf(one.t.split("\n")[0], one.k), [, tall] = sizeOf(one.t, one.k), [x, y] = pushed(viewport, one.p, one, [half, tall]);
    return [x - half, y - tall, x + half, y + tall];
  });
}

// Return a middle from which a word reaches over neither edge, if it is not out of view.
function inside(x, half, [left, right]) {
  return x < left || x > right || right - left < 2 * half ? x : Math.min(Math.max(x, left + half), right - half);
}

// Return where a name may stand, the nearest first: within the edges, or beside what lies over the map.
function besides([x, y], half, over, free) {
  const near = over.filter(([left, , right]) => x + half > left && x - half < right);
  return [x, ...near.flatMap(([left, , right]) => [left - half, right + half])]
    .sort((a, b) => Math.abs(a - x) - Math.abs(b - x))
    .map((one) => [inside(one, half, free), y]).filter(([one]) => Math.abs(one - x) <= 2 * half);
}

// `labels` are {p: [lon, lat], t: text, k: kind, from, to (zooms), row, at, away, gap}, the most important
// first; `at` are the places to be tried where it may stand at several. One with `away` [lon, lat] stands
// beyond its place in that direction, `gap` pixels from it; one that is `tight`, and the first and the last
// row, may be crowded.
export class Labels {
  constructor(place) {
    this.place = place;
    this.shown = [];
    this.placed = [];
  }

  // Return which rows have a number, and whether each is an end: they change with the zoom alone.
  rows(labels, viewport) {
    const { zoom, pitch } = viewport, last = this.last;
    if (last?.labels === labels && last.zoom === zoom && last.pitch === pitch) return last.rows;
    const rows = new Map(numberedRows(labels, viewport).map(({ row, end }) => [row, end]));
    this.last = { labels, zoom, pitch, rows };
    return rows;
  }

  // `over` are the boxes [left, top, right, bottom] of what lies over the map: no word stands below it.
  // `free` is from where to where the map is seen: a name beside its edge is moved into it. What moves
  // comes `first`.
  draw(labels, viewport, hidden, over = [], free = [0, viewport.width], first = []) {
    const boxes = [...over];
    this.placed = [];
    const rows = this.rows(labels, viewport);
    for (const label of [...first, ...labels]) {
      const { p, t, k, from, to, row, at, tight } = label;
      if (hidden.has(SWITCH[k]) || viewport.zoom < (from ?? 0) || viewport.zoom >= (to ?? 99) || (row && !rows.has(row))) continue;
      const size = sizeOf(t, k).map((one) => (tight ? TIGHT * one : one));
      const places = (at ?? [p]).map((one) => pushed(viewport, one, label, size));
      const [half, tall] = size.map((one) => (rows.get(row) ? TIGHT * one : one));
      const place = (k === "name" ? places.flatMap((one) => besides(one, half + 4, over, free)) : places).find(([x, y]) => {
        if (x < -20 || y < -20 || x > viewport.width + 20 || y > viewport.height + 20) return false;
        return !boxes.some((b) => x - half < b[2] && x + half > b[0] && y - tall < b[3] && y + tall > b[1]);
      });
      if (!place) continue;
      const [x, y] = place;
      boxes.push([x - half, y - tall, x + half, y + tall]);
      const one = (this.shown[this.placed.length] ??= this.place.appendChild(document.createElement("span")));
      this.placed.push({ x, y, t, k });
      if (one.textContent !== t) one.textContent = t;
      one.className = `label ${k}`;
      one.dataset.row = row ?? "";
      one.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
      one.hidden = false;
    }
    for (let k = this.placed.length; k < this.shown.length; k++) this.shown[k].hidden = true;
  }
}
