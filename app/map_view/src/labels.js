// Words and numbers on the map, as the page's own text: any script, any direction, never crowded.

// which switch a kind of label belongs to
const SWITCH = { hot: "hot", leg: "numbers", stop: "numbers", zone: "numbers", row: "rows", place: "plan", block: "rows" };

// every so many rows have their numbers, where there is not room for each
const STEPS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

// how much of a number others must leave free where it had rather be crowded than missing
const TIGHT = 0.6;

const NUMBERS = new Set(["leg", "stop", "zone"]);
const numbered = new WeakMap();

// Return the labels with the numbers of the hot spots that are shown: after those of stops, which
// they never cover, before all other words.
export function withHot(labels, jsons) {
  const hot = jsons.find((json) => json.id === "hot");
  if (!hot) return labels;
  const known = numbered.get(hot);
  if (known?.labels === labels) return known.made;
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

// Return how large a word is: half its width, and half its height.
function sizeOf(t) {
  const lines = t.split("\n");
  return [4 * Math.max(...lines.map((one) => one.length)) + 7, 10 * lines.length];
}

// Return where a word stands that belongs beyond its place.
function pushed(viewport, p, { away, gap }, [half, tall]) {
  const [x, y] = viewport.project(p), [outX, outY] = away ? beyond(viewport, p, away, half, tall, gap ?? 3) : [0, 0];
  return [x + outX, y + outY];
}

// Return every how many rows there is room for a number: the same all over the plot, whatever is in view.
// Of very few rows none may be a multiple of that: then those of the next smaller step are shown.
function rowStep(rows, viewport) {
  const at = new Map(rows.map((one) => [one.row, { size: sizeOf(one.t), xy: pushed(viewport, one.p, one, sizeOf(one.t)) }]));
  const covered = (a, b) => Math.abs(a.xy[0] - b.xy[0]) < a.size[0] + b.size[0] && Math.abs(a.xy[1] - b.xy[1]) < a.size[1] + b.size[1];
  const several = STEPS.filter((step) => rows.filter(({ row }) => row % step === 0).length > 1);
  const free = several.find((step) => rows.every(({ row }) => row % step || !at.has(row + step) || !covered(at.get(row), at.get(row + step))));
  return free ?? several.at(-1) ?? 1;
}

// Return the boxes [left, top, right, bottom] of the numbers that rows have in a view.
export function rowBoxes(labels, viewport) {
  const rows = labels.filter(({ k, row }) => k === "row" && row), step = rowStep(rows, viewport);
  return rows.filter(({ row }) => row % step === 0).map((one) => {
    const [half, tall] = sizeOf(one.t), [x, y] = pushed(viewport, one.p, one, [half, tall]);
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
// beyond its place in that direction, `gap` pixels from it; one that is `tight` may be crowded.
export class Labels {
  constructor(place) {
    this.place = place;
    this.shown = [];
    this.placed = [];
  }

  // Return every how many rows have a number: it changes with the zoom alone.
  step(labels, viewport) {
    const { zoom, pitch } = viewport, known = this.known;
    if (known?.labels === labels && known.zoom === zoom && known.pitch === pitch) return known.step;
    const step = rowStep(labels.filter(({ k, row }) => k === "row" && row), viewport);
    this.known = { labels, zoom, pitch, step };
    return step;
  }

  // `over` are the boxes [left, top, right, bottom] of what lies over the map: no word stands below it.
  // `free` is from where to where the map is seen: a name beside its edge is moved into it.
  draw(labels, viewport, hidden, over = [], free = [0, viewport.width]) {
    const boxes = [...over];
    this.placed = [];
    const step = this.step(labels, viewport);
    for (const label of labels) {
      const { p, t, k, from, to, row, at, tight } = label;
      if (hidden.has(SWITCH[k]) || viewport.zoom < (from ?? 0) || viewport.zoom >= (to ?? 99) || row % step) continue;
      const [half, tall] = sizeOf(t).map((one) => (tight ? TIGHT * one : one));
      const places = (at ?? [p]).map((one) => pushed(viewport, one, label, [half, tall]));
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
