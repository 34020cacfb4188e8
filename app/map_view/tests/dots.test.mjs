// Each plot that is too small to be seen has a dot; plots under the same dot are counted on it, and none is lost.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Dots, MARKS, dotUnder } from "../src/dots.js";
import { flatView, random } from "./plots.mjs";

// half a pixel wide each, at a pixel of the view
const view = flatView(), [origin] = [view.project([0, 0])];
const at = (x, y) => view.unproject([origin[0] + x, origin[1] + y]);
function plot(x, y, side = 0.5, urgent = 0) {
  const [west, south] = at(x - side / 2, y + side / 2), [east, north] = at(x + side / 2, y - side / 2);
  return { p: at(x, y), t: `${x} ${y}`, c: [urgent], around: [west, south, east, north], urgent };
}
const layer = (...plots) => [{ id: "plots", data: [] }, { id: MARKS, data: plots }];
const shown = (jsons, port = view) => new Dots().of(jsons, port).find(({ id }) => id === MARKS).data;
const names = (plots) => plots.map(({ p, t }, k) => ({ p, t, k: "name", plot: k }));

test("plots under one dot are counted, each other small plot has its own, a large one none", () => {
  const jsons = layer(plot(100, 100, 0.5, 2), plot(103, 100, 0.5, 1), plot(200, 100), plot(300, 200, 80));
  assert.deepEqual(shown(jsons).map(({ of }) => of), [[0, 1], [2]]);
  assert.deepEqual(shown(jsons)[0].c, [1], "in the colour of the more urgent one");
  const labels = new Dots().labels(names(jsons[1].data), jsons, view);
  assert.deepEqual(labels.map(({ t }) => t), ["2", "200 100", "300 200"]);
  assert.deepEqual(labels.map(({ away }) => Boolean(away)), [false, true, false], "the name stands below the dot");
});

test("two seasons of one plot share a dot however near they are seen", () => {
  const both = [plot(100, 100, 300), plot(100, 100, 300)];
  assert.deepEqual(shown(layer(...both)).map(({ of }) => of), [[0, 1]]);
});

test("plots whose areas can be told apart share no dot, however near their middles are", () => {
  assert.deepEqual(shown(layer(plot(100, 100, 16), plot(117, 100, 16))), []);
  assert.deepEqual(shown(layer(plot(100, 100, 300), plot(112, 100), plot(116, 104))).map(({ of }) => of), [[1, 2]]);
});

test("every plot is under a dot or large, dots are apart, and coming closer parts them", () => {
  const next = random(5), plots = Array.from({ length: 300 }, () => plot(300 * next(), 300 * next()));
  const dots = shown(layer(...plots));
  assert.deepEqual(dots.flatMap(({ of }) => of).sort((a, b) => a - b), plots.map((_, k) => k));
  const places = dots.map(({ p }) => view.project(p));
  for (const [k, [x, y]] of places.entries()) {
    for (const [u, v] of places.slice(k + 1)) assert.ok(Math.hypot(u - x, v - y) >= 19.99);
    assert.equal(dotUnder(dots, dots[k].p, view, 12), dots[k]);
  }
  assert.ok(dots.length < 200);
});

test("the nearest dot is under the pointer, and none beyond its reach", () => {
  const dots = shown(layer(plot(100, 100), plot(121, 100)));
  assert.deepEqual(dotUnder(dots, at(109, 100), view, 12).of, [0]);
  assert.deepEqual(dotUnder(dots, at(112, 100), view, 12).of, [1]);
  assert.equal(dotUnder(dots, at(100, 113), view, 12), undefined);
});

test("dots are drawn anew when the zoom changes them, and only then", () => {
  const jsons = layer(plot(100, 100), plot(130, 100)), dots = new Dots(), near = flatView({ zoom: 11, px: 2000 });
  dots.drawn(jsons, null);
  assert.equal(dots.isStale(jsons, null), false, "nothing is seen yet");
  assert.equal(dots.isStale(jsons, view), true);
  const drawn = dots.drawn(jsons, view);
  assert.equal(dots.isStale(jsons, view), false);
  assert.equal(dots.isStale(jsons, near), false, "the same dots");
  assert.equal(dots.of(jsons, near)[1], drawn[1]);
  assert.equal(dots.isStale(jsons, flatView({ zoom: 9, px: 500 })), true, "they come together");
});
