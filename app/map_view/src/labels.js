// Words and numbers on the map, as the page's own text: any script, any direction, never crowded.

// which switch a kind of label belongs to
const SWITCH = { leg: "numbers", stop: "numbers", row: "rows", place: "plan", block: "rows" };

// `labels` are {p: [lon, lat], t: text, k: kind, from, to (zooms), row}, the most important first.
export class Labels {
  constructor(place) {
    this.place = place;
    this.shown = [];
    this.placed = [];
  }

  draw(labels, viewport, hidden) {
    const boxes = [];
    this.placed = [];
    for (const { p, t, k, from, to, row } of labels) {
      if (hidden.has(SWITCH[k]) || viewport.zoom < (from ?? 0) || viewport.zoom >= (to ?? 99)) continue;
      const [x, y] = viewport.project(p);
      if (x < -20 || y < -20 || x > viewport.width + 20 || y > viewport.height + 20) continue;
      const lines = t.split("\n"), half = 4 * Math.max(...lines.map((one) => one.length)) + 7, tall = 10 * lines.length;
      const box = [x - half, y - tall, x + half, y + tall];
      if (boxes.some((b) => box[0] < b[2] && box[2] > b[0] && box[1] < b[3] && box[3] > b[1])) continue;
      boxes.push(box);
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
