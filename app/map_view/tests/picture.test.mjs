// A picture for a report: what the panel leaves free, and every sign of the legend.

import assert from "node:assert/strict";
import { test } from "node:test";

import { foot, freePart, legendPlace, linesOf, titleSize } from "../src/picture.js";

test("what panels leave free is taken, and never nothing", () => {
  const size = { width: 1440, height: 840 };
  assert.deepEqual(freePart(size, { left: 400, right: 0, bottom: 0 }), { x: 400, y: 0, width: 1040, height: 840 });
  assert.deepEqual(freePart(size, { left: 0, right: 400, bottom: 0 }), { x: 0, y: 0, width: 1040, height: 840 });
  assert.deepEqual(freePart(size, { left: 0, right: 0, bottom: 840 }), { x: 0, y: 0, width: 1440, height: 50 });
});

test("each part of a legend has its title, if it has one, and a line a sign", () => {
  const lines = linesOf([
    { title: "Chance", scale: true, items: [["square", [1, 2, 3], "0 %"], ["square", [4, 5, 6], "1 %"]] },
    { title: "", items: [["line", [7, 8, 9], "route"]] },
  ]);
  assert.deepEqual(lines.map((one) => one.title ?? one.text), ["Chance", "0 %", "1 %", "route"]);
});

test("the scale bar's number and unit stand in the order of the language", () => {
  for (const rtl of [false, true]) {
    const said = new Map();
    const pen = new Proxy({}, { get: (all, name) => all[name] ?? ((text) => said.set(text, all.direction)) });
    foot(pen, { bar: { px: 80, text: "10 m" }, credit: "", colours: {}, rtl }, { width: 800, height: 400 });
    assert.equal(said.get("10 m"), rtl ? "rtl" : "ltr");
  }
});

test("a picture as narrow as a phone has its legend below the map, a wide one on it", () => {
  const wide = legendPlace({ width: 1040, height: 840 }, 8, 200);
  assert.deepEqual([wide.below, wide.columns], [0, 1]);
  const phone = legendPlace({ width: 390, height: 430 }, 8, 150);
  assert.ok(phone.below > 0 && phone.high <= phone.below, "none of it lies on the plot");
  assert.deepEqual([phone.columns, phone.rows], [2, 4]);
  assert.equal(legendPlace({ width: 390, height: 430 }, 8, 300).columns, 1);
  assert.equal(legendPlace({ width: 390, height: 430 }, 0, 0).below, 0);
});

test("a title too long for a picture is set smaller", () => {
  assert.equal(titleSize(300, 390), 20);
  assert.ok(titleSize(700, 390) * 700 / 20 + 48 <= 390);
});
