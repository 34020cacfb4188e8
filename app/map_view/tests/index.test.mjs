// The map as a whole: from where it is seen.

import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./page.mjs";

page();
globalThis.matchMedia = () => ({ matches: false });
const { MapPage } = await import("../src/index.js");

test("a window that changes its size shows the robot again, or the whole plot if there is none", () => {
  const drawn = [], map = Object.assign(Object.create(MapPage.prototype), {
    deck: { setProps: () => drawn.push("plot") }, drawLayers: () => drawn.push("robot"), fit: () => ({}), drawing: {},
  });
  for (const leads of [true, false]) { map.drive = { leads: () => leads }; map.resized(); }
  assert.deepEqual(drawn, ["robot", "plot"]);
});

test("once there is no drive the whole plot is shown, north up, at once and until somebody moves it", () => {
  const wished = [], FIT = { longitude: 35, latitude: 30, zoom: 17, bearing: 0, pitch: 0 };
  // the page's own parts are not needed for where it is seen from
  const map = Object.assign(Object.create(MapPage.prototype), {
    deck: { setProps: ({ initialViewState }) => wished.push(initialViewState) }, fit: () => FIT, tip: {}, boxes: null,
  });
  const looks = (place, drive) => { map.data = { place, drive }; map.look(); return wished.at(-1); };
  assert.equal(looks("Gate", null).transitionDuration, 0);
  looks("Gate", "/a-day");
  map.moved = true;
  const after = looks("Gate", null);
  assert.deepEqual([after.bearing, after.pitch, after.zoom, after.transitionDuration], [0, 0, 17, 0]);
  assert.equal(map.moved, false);
  assert.ok(looks("Hill", null).transitionDuration > 0, "from plot to plot it is flown");
});
