// Words and numbers on the map, as the page's own text: any script, any direction, never crowded.

// which switch a kind of label belongs to
const SWITCH = { hot: "hot", leg: "numbers", stop: "numbers", row: "rows", place: "plan", block: "rows" };

const NUMBERS = new Set(["leg", "stop"]);
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

// Return a middle from which a word reaches over neither edge, if it is not out of view.
function inside(x, half, [left, right]) {
  return x < left || x > right || right - left < 2 * half ? x : Math.min(Math.max(x, left + half), right - half);
}

// `labels` are {p: [lon, lat], t: text, k: kind, from, to (zooms), row, at, away, gap}, the most important
// first; `at` are the places to be tried where it may stand at several. One with `away` [lon, lat] stands
// beyond its place in that direction, `gap` pixels from it.
export class Labels {
  constructor(place) {
    this.place = place;
    this.shown = [];
    this.placed = [];
  }

  // `over` are the boxes [left, top, right, bottom] of what lies over the map: no word stands below it.
  // `free` is from where to where the map is seen: a name beside its edge is moved into it.
  draw(labels, viewport, hidden, over = [], free = [0, viewport.width]) {
    const boxes = [...over];
    this.placed = [];
    for (const { p, t, k, from, to, row, at, away, gap } of labels) {
      if (hidden.has(SWITCH[k]) || viewport.zoom < (from ?? 0) || viewport.zoom >= (to ?? 99)) continue;
      const lines = t.split("\n"), half = 4 * Math.max(...lines.map((one) => one.length)) + 7, tall = 10 * lines.length;
      const [outX, outY] = away ? beyond(viewport, p, away, half, tall, gap ?? 3) : [0, 0];
      const place = (at ?? [p]).map((one) => viewport.project(one)).map(([x, y]) => [x + outX, y + outY])
        .map(([x, y]) => [k === "name" ? inside(x, half + 4, free) : x, y]).find(([x, y]) => {
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
