// What is being typed is not lost where its box is emptied.

import assert from "node:assert/strict";
import { test } from "node:test";

import { keepUnfinished } from "../src/unfinished.js";

class Box {
  constructor(key, type = "number") {
    const root = { classList: ["stElementContainer", `st-key-${key}`], parentElement: null, querySelector: () => this };
    Object.assign(this, { type, tagName: "INPUT", parentElement: root, root, isConnected: true, heard: [], typed: "" });
  }
  get value() { return this.typed; }
  set value(text) { this.typed = text; }
  focus() { this.isFocused = true; }
  dispatchEvent(event) { this.heard.push(event.type); heard.input({ target: this }); }
}

const heard = {}, all = [];
let changed = null, watching = false;
globalThis.document = {
  addEventListener: (kind, hear) => { heard[kind] = hear; }, body: {},
  querySelectorAll: (asked) => all.filter((one) => one.root.classList[1].includes(/"(.*)"/.exec(asked)[1])).map((one) => one.root),
};
globalThis.MutationObserver = class {
  constructor(hear) { changed = () => watching && hear(); }
  observe() { watching = true; }
  disconnect() { watching = false; }
};
keepUnfinished();

const shown = (key, type) => { const box = new Box(key, type); all.push(box); return box; };
const type = (box, text) => { box.value = text; heard.input({ target: box }); };
function replace(box, key) {
  all.splice(all.indexOf(box), 1);
  box.isConnected = false;
  const next = shown(key, box.type);
  changed?.();
  return next;
}

test("what is typed goes on in the box that is emptied, and in no other", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const plant = shown("one_plant-one_plant-0-2026-11-16-s1");
  const other = shown("one_row-one_plant-1-2026-11-17-s1");
  const row = shown("one_row-one_plant-0-2026-11-16-s1");
  type(row, "7");
  changed();
  assert.deepEqual([plant.value, other.value], ["", ""]);
  heard.focusout({ target: row }); // as some browsers say of a box that goes
  const emptied = replace(row, "one_row-one_plant-1-2026-11-16-s1");
  context.mock.timers.tick(0);
  assert.deepEqual([emptied.value, emptied.isFocused, emptied.heard], ["7", true, ["input"]]);
  assert.deepEqual([plant.value, other.value], ["", ""]);
  const again = replace(emptied, "one_row-one_plant-2-2026-11-16-s1");
  assert.equal(again.value, "7", "it goes on being typed");
  heard.focusout({ target: again });
  context.mock.timers.tick(0);
  assert.equal(watching, false);
});

test("what was sent is in no emptied box, nor does what is typed cover what is said there", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  let row = shown("product-treatment-0-2026-11-16-s1", "text");
  for (const finish of [(target) => heard.focusout({ target }), (target) => heard.keydown({ target, key: "Enter" })]) {
    type(row, "Vertimec");
    finish(row);
    context.mock.timers.tick(0);
    row = replace(row, row.root.classList[1].slice(7).replace(/-(\d)-/, (_, n) => `-${Number(n) + 1}-`));
    assert.equal(row.value, "");
  }
  type(row, "Milbeknock");
  heard.keydown({ target: row, key: "a" });
  context.mock.timers.tick(0);
  all.splice(all.indexOf(row), 1);
  row.isConnected = false;
  const said = shown("product-treatment-3-2026-11-16-s1", "text");
  said.value = "Envidor";
  changed();
  assert.equal(said.value, "Envidor");
});

test("a box that is no day's is left alone", () => {
  type(shown("season_name Gate 2026", "text"), "Hill");
  type(shown("day-Gate-0-2026-11-16-s1", "checkbox"), "on");
  assert.equal(watching, false);
});
