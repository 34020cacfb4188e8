// The keyboard does on the map what a finger does, and leaves alone what is the browser's.

import assert from "node:assert/strict";
import { test } from "node:test";

import { asked, FINE_PX, moved, STEP_PX } from "../src/keys.js";
import { flatView } from "./plots.mjs";

const key = (name, more = {}) => ({ key: name, ...more });

test("arrows move the map, with Shift a little", () => {
  assert.deepEqual(asked(key("ArrowRight"), null), { move: [STEP_PX, 0] });
  assert.deepEqual(asked(key("ArrowUp", { shiftKey: true }), null), { move: [0, -FINE_PX] });
  assert.deepEqual(asked(key("ArrowDown"), "lasso"), { move: [0, STEP_PX] }, "while something is drawn, too");
});

test("plus and minus zoom on any keyboard, nought shows the whole plot", () => {
  for (const name of ["+", "="]) assert.deepEqual(asked(key(name), null), { zoom: 1 });
  for (const name of ["-", "_"]) assert.deepEqual(asked(key(name), null), { zoom: -1 });
  assert.deepEqual(asked(key("0"), null), { whole: true });
});

test("Enter opens a plant; where corners are drawn, space sets one and Enter ends", () => {
  assert.deepEqual(asked(key("Enter"), null), { press: true });
  assert.deepEqual(asked(key("Enter"), "rows"), { press: true });
  for (const mode of ["line", "area", "lasso", "outline"]) {
    assert.deepEqual(asked(key(" "), mode), { press: true });
    assert.deepEqual(asked(key("Enter"), mode), { finish: true });
    assert.deepEqual(asked(key("Backspace"), mode), { back: true });
  }
  assert.equal(asked(key("Backspace"), null), null);
  assert.deepEqual(asked(key("Escape"), "area"), { leave: true });
});

test("other keys, and keys held with Control, are the browser's", () => {
  for (const name of ["Tab", "a", "F5", "PageDown"]) assert.equal(asked(key(name), null), null);
  for (const held of ["ctrlKey", "metaKey", "altKey"]) assert.equal(asked(key("+", { [held]: true }), null), null);
});

test("a view that is moved has its middle where the pixels say", () => {
  const view = flatView();
  const { longitude, latitude, zoom } = moved(view, [100, -50]);
  assert.deepEqual([longitude, latitude, zoom], [0.5, -0.25, view.zoom]);
});
