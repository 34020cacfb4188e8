// Words on the map never cover each other, and the most important ones win.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Labels, withHot } from "../src/labels.js";
import { flatView, random } from "./plots.mjs";

// stands for the page: what is shown, and where
globalThis.document = { createElement: () => ({ style: {}, dataset: {}, textContent: "", hidden: true }) };

function shown(labels, view, hidden = new Set(), ...more) {
  const place = { made: [], appendChild(one) { this.made.push(one); return one; } };
  const drawn = new Labels(place);
  drawn.draw(labels, view, hidden, ...more);
  return place.made.filter((one) => !one.hidden).map((one) => {
    const [, x, y] = one.style.transform.match(/^translate\((-?[\d.]+)px, (-?[\d.]+)px\)/);
    return { t: one.textContent, k: one.className.split(" ")[1], x: Number(x), y: Number(y) };
  });
}

const view = flatView();

test("no two of a thousand labels cover each other, and none that has room is missing", () => {
  const next = random(11);
  const labels = Array.from({ length: 1000 }, (_, k) => ({ p: [next() * 0.8, -next() * 0.6], t: `${k}`, k: "stop" }));
  const made = shown(labels, view), half = (t) => 4 * t.length + 7;
  // places are written to a tenth of a pixel
  const apart = (a, b, by) => Math.abs(a.x - b.x) > half(a.t) + half(b.t) + by || Math.abs(a.y - b.y) > 20 + by;
  made.forEach((a, i) => made.slice(i + 1).forEach((b) => assert.ok(apart(a, b, -0.2), `${a.t} covers ${b.t}`)));
  assert.ok(made.length > 100);
  const names = new Set(made.map((one) => one.t));
  for (const { t, p } of labels) {
    const [x, y] = view.project(p);
    if (!names.has(t)) assert.ok(made.some((one) => !apart({ t, x, y }, one, 0.2)), `${t} had room`);
  }
});

test("the first of two that are too close is shown, where it is", () => {
  const [one, ...more] = shown([{ p: [0.1, -0.1], t: "1", k: "leg" }, { p: [0.101, -0.1], t: "2", k: "leg" }], view);
  assert.deepEqual([one.t, one.x, one.y, more.length], ["1", 100, 100, 0]);
});

test("numbers that are tight are crowded rather than missing, unless one hides the other", () => {
  const pair = (apart) => [{ p: [0.1, -0.1], t: "1", k: "leg", tight: true }, { p: [0.1 + apart, -0.1], t: "2", k: "leg", tight: true }];
  const view = { project: ([x, y]) => [1000 * x, -1000 * y], zoom: 5, pitch: 0, width: 800, height: 600 };
  assert.equal(shown(pair(0.016), view).length, 2);
  assert.equal(shown(pair(0.005), view).length, 1);
});

test("legs give way to stops at their zoom, and neither shows where it is switched off", () => {
  const labels = [{ p: [0.1, -0.1], t: "1", k: "leg", to: 18 }, { p: [0.1, -0.1], t: "7", k: "stop", from: 18 },
                  { p: [0.4, -0.4], t: "3", k: "row" }];
  const of = (zoom, hidden) => shown(labels, flatView({ zoom }), new Set(hidden)).map((one) => one.t);
  assert.deepEqual(of(17.9), ["1", "3"]);
  assert.deepEqual(of(18), ["7", "3"]);
  assert.deepEqual(of(18, ["numbers"]), ["3"]);
  assert.deepEqual(of(17, ["rows"]), ["1"]);
});

test("row numbers go in even steps, as many as have room, and do not change with what is in view", () => {
  const steps = [2.1, 4.1, 11, 21].map((scale) => {
    const n = Math.min(43, Math.floor(560 / scale));
    const rows = Array.from({ length: n }, (_, k) => ({ p: [0.1, -0.02 - (k * scale) / 1000], t: `${k + 1}`, k: "row", row: k + 1 }));
    const made = shown(rows, view).map(({ t }) => Number(t)), own = made.slice(1, -1), step = own[1] - own[0] || 20;
    assert.deepEqual([made[0], made.at(-1)], [1, n], "the first and the last");
    // what has no room beside these is left out
    const fits = rows.map(({ row }) => row).filter((row) => row % step === 0 && Math.min(row - 1, n - row) * scale >= 20);
    assert.deepEqual(own, step === 1 ? rows.slice(1, -1).map(({ row }) => row) : fits, `${scale}`);
    // two steps nearer to each other would not have room
    assert.ok(step === 1 || scale * [0, 1, 1, 1, 1, 2, 2, 2, 2, 2, 5][Math.min(step, 10)] < 20, `${scale}: ${step}`);
    const part = { ...view, project: (p) => { const [x, y] = view.project(p); return [x, y - 200]; } };
    assert.ok(shown(rows, part).every(({ t }) => made.includes(Number(t))));
    return step;
  });
  assert.deepEqual([...steps].sort((a, b) => b - a), steps);
  assert.equal(new Set(steps).size, 4);
});

test("the first and the last row have their numbers close beside the word of the gate, too", () => {
  const rows = [1, 2, 3].map((row) => ({ p: [0.1, -0.1 - row * 0.03], t: `${row}`, k: "row", row }));
  const gate = (row) => ({ p: [0.131, -0.1 - row * 0.03], t: "gate", k: "gate" });
  const beside = (row) => shown([gate(row), ...rows], view).map(({ t }) => t);
  assert.deepEqual([1, 2, 3].map(beside), [["gate", "1", "2", "3"], ["gate", "1", "3"], ["gate", "1", "2", "3"]]);
});

test("rows that count on from another number, or down, are shown by their own numbers", () => {
  const of = (numbers) => shown(numbers.map((n, k) => ({ p: [0.1, -0.02 - k * 0.0041], t: `${n}`, k: "row", row: k + 1 })), view).map(({ t }) => t);
  const from = Array.from({ length: 31 }, (_, k) => 12 + k);
  assert.deepEqual(of(from), ["12", "20", "25", "30", "35", "42"]);
  assert.deepEqual(of([...from].reverse()), ["42", "35", "30", "25", "20", "12"]);
  // numbers in no order: every so many rows on the ground
  assert.deepEqual(of([7, 3, 9, 1, 8, 2, 6, 5, 4, 11, 10, 13, 12, 14, 16, 15]), ["7", "11", "15"]);
});

test("of rows so few that none is a multiple of ten, some have their numbers", () => {
  const rows = [1, 2, 3, 4].map((row) => ({ p: [0.1, -0.1 - row * 0.001], t: `${row}`, k: "row", row }));
  assert.equal(shown(rows, view).length, 1);
});

test("what is out of view is not shown, and what was shown goes when the view moves", () => {
  const place = { made: [], appendChild(one) { this.made.push(one); return one; } }, drawn = new Labels(place);
  const labels = [{ p: [0.1, -0.1], t: "1", k: "stop" }];
  drawn.draw(labels, view, new Set());
  assert.equal(place.made[0].hidden, false);
  drawn.draw(labels, flatView({ west: 5 }), new Set());
  assert.equal(place.made[0].hidden, true);
  drawn.draw(labels, view, new Set());
  assert.equal(place.made.length, 1, "labels are used again");
});

const hotAt = (...spots) => ({ id: "hot", data: spots.map((at, k) => ({ p: [], number: { t: `${k + 1}`, at } })) });

test("a hot spot's number stands in its middle, or on its edge where a stop's number does", () => {
  const stop = { p: [0.2, -0.2], t: "17", k: "stop" }, row = { p: [0.5, -0.5], t: "3", k: "row" };
  const hot = hotAt([[0.4, -0.4], [0.45, -0.4]], [[0.2, -0.2], [0.205, -0.2], [0.3, -0.2]], [[0.5, -0.5]]);
  const made = shown(withHot([stop, row], [{ id: "plants" }, hot]), view);
  const of = (kind) => made.filter(({ k }) => k === kind).map(({ t, x, y }) => [t, x, y]);
  assert.deepEqual(of("stop"), [["17", 200, 200]], "no stop's number gives way");
  assert.deepEqual(of("hot"), [["1", 400, 400], ["2", 300, 200], ["3", 500, 500]]);
  assert.deepEqual(of("row"), [], "a row's number does");
});

test("hot spots' numbers are those of the day that is shown, and go with the hot spots", () => {
  const labels = [{ p: [0.2, -0.2], t: "3", k: "row" }], hot = hotAt([[0.4, -0.4]]), other = hotAt();
  assert.equal(withHot(labels, []), labels);
  assert.deepEqual(shown(withHot(labels, [hot]), view).map(({ k }) => k), ["hot", "row"]);
  assert.deepEqual(shown(withHot(labels, [other]), view).map(({ k }) => k), ["row"]);
  assert.deepEqual(shown(withHot(labels, [hot]), view, new Set(["hot"])).map(({ k }) => k), ["row"]);
  assert.equal(withHot(labels, [hot]), withHot(labels, [hot]), "made once");
});

test("a word beyond its place stands clear of it, whatever the direction and the zoom", () => {
  for (const [dx, dy] of [[-1, 0], [0, 1], [1, 1], [-3, 1]]) {
    const away = [0.4 + dx * 1e-4, -0.4 - dy * 1e-4];
    const [one] = shown([{ p: [0.4, -0.4], away, gap: 12, t: "gate", k: "place" }], view);
    const half = 4 * 4 + 7, apart = Math.max(Math.abs(one.x - 400) - half, Math.abs(one.y - 400) - 10);
    assert.ok(apart >= 12 / Math.SQRT2 - 0.2, `${dx} ${dy}: ${apart}`);
    assert.ok(Math.sign(one.x - 400) === Math.sign(dx) && Math.sign(one.y - 400) === Math.sign(dy));
  }
  const [still] = shown([{ p: [0.4, -0.4], away: [0.4, -0.4], t: "3", k: "row" }], view);
  assert.deepEqual([still.x, still.y], [400, 400]);
});

test("no word stands below what lies over the map", () => {
  const labels = [{ p: [0.1, -0.1], t: "gate", k: "place" }, { p: [0.4, -0.4], t: "3", k: "row" }];
  const of = (over) => shown(labels, view, new Set(), over).map((one) => one.t);
  assert.deepEqual(of([[80, 80, 300, 120]]), ["3"]);
  assert.deepEqual(of([[80, 120, 300, 160]]), ["gate", "3"]);
});

test("a name of two lines stands clear of what lies above it, with the room around it", () => {
  // as the page draws it, it is 46 px tall
  const at = (y) => shown([{ p: [0.4, -y], t: "Gate\nrobot 1, 06:00-15:59", k: "name" }], view, new Set(), [[0, 0, 800, 50]]).length;
  assert.deepEqual([at(0.0715), at(0.0735)], [0, 1]);
});

test("a name under the buttons of the map is moved beside them, and no other word is", () => {
  const at = (k, x) => shown([{ p: [x, -0.3], t: "Gate 2026", k }], view, new Set(), [[650, 200, 700, 400]], [0, 800])[0]?.x;
  const half = 4 * "Gate 2026".length + 7 + 4;
  assert.equal(at("name", 0.64), 650 - half);
  assert.equal(at("name", 0.69), 700 + half);
  assert.equal(at("place", 0.64), undefined);
});

test("a name beside the edge is moved to where it is read in full, and no other word is", () => {
  const at = (k, x, t) => shown([{ p: [x, -0.3], t, k }], view, new Set(), [], [100, 700])[0]?.x;
  const half = 4 * "Small vineyard".length + 7 + 4;
  assert.equal(at("name", 0.11, "Small vineyard"), 100 + half);
  assert.equal(at("name", 0.69, "Small vineyard"), 700 - half);
  assert.equal(at("name", 0.4, "Small vineyard"), 400);
  assert.equal(at("name", 0.05, "Small vineyard"), 50, "what the panel covers stays there");
  assert.equal(at("row", 0.11, "Small vineyard"), 110);
});
