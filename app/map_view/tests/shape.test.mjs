// The panel beside the map: what it covers, by its side, folded, and as a phone's sheet.

import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./page.mjs";

const made = page();
Object.assign(globalThis, { innerWidth: 1440, innerHeight: 900, sessionStorage: { kept: {}, getItem(k) { return this.kept[k] ?? null; }, setItem(k, v) { this.kept[k] = v; } } });
const { covered, keepShape } = await import("../src/shape.js");
const NONE = { left: 0, right: 0, bottom: 0 };
const WORDS = { fold: "Fold", unfold: "Unfold", sheet: "Pull up" };

test("without a panel nothing is covered", () => assert.deepEqual(covered(), NONE));

test("a panel covers the side where it stands, a sheet what is below its edge", () => {
  made.panel = { left: 0, top: 60, width: 400, right: 400 };
  assert.deepEqual(covered(), { ...NONE, left: 400 });
  made.panel = { left: 1040, top: 60, width: 400, right: 1440 }; // read from the right
  assert.deepEqual(covered(), { ...NONE, right: 400 });
  made.panel = { left: 0, top: 520, width: 1440, right: 1440 };
  assert.deepEqual(covered(), { ...NONE, bottom: 380 });
});

test("the handle folds the panel away and back, says which, and it is remembered", () => {
  made.panel = { left: 0, top: 60, width: 400, right: 400 };
  const shape = keepShape(() => WORDS);
  shape.again();
  const [fold, grip] = made.body.children.at(-1).shadow.children;
  assert.equal(fold.getAttribute("aria-label"), "Fold");
  fold.fire("click");
  assert.equal(fold.getAttribute("aria-label"), "Unfold");
  assert.equal(fold.getAttribute("aria-expanded"), "false");
  assert.deepEqual(covered(), NONE);
  assert.match(sessionStorage.getItem("fieldmon panel"), /"folded":true/);
  fold.fire("click");
  assert.deepEqual(covered(), { ...NONE, left: 400 });
  assert.equal(grip.getAttribute("aria-label"), "Pull up");
});

test("who asks is told when the panel covers more or less of the sides, and not otherwise", () => {
  made.panel = { left: 0, top: 60, width: 400, right: 400 };
  let told = 0;
  const shape = keepShape(() => WORDS, () => { told++; });
  told = 0;
  shape.again();
  assert.equal(told, 0);
  made.panel = { left: 0, top: 60, width: 560, right: 560 }; // another page's
  shape.again();
  assert.equal(told, 1);
  shape.again();
  assert.equal(told, 1);
});

test("a tap pulls the sheet up and lets it down; arrows move it, never off the screen", () => {
  keepShape(() => WORDS);
  const [, grip] = made.body.children.at(-1).shadow.children, top = () => Number.parseInt(made.documentElement.style["--sheet-top"]);
  const half = top(), tap = () => { grip.fire("pointerdown", { clientY: 500, pointerId: 1 }); grip.fire("pointerup"); };
  const above = () => made.documentElement.style["--above-sheet"];
  assert.equal(above(), "visible");
  tap();
  assert.ok(top() < half / 2);
  assert.equal(above(), "hidden", "scale and playback lay on the legend");
  tap();
  assert.equal(top(), half);
  for (let k = 0; k < 20; k++) grip.fire("keydown", { key: "ArrowDown" });
  assert.equal(top(), 85);
  for (let k = 0; k < 20; k++) grip.fire("keydown", { key: "ArrowUp" });
  assert.equal(top(), 10);
});
