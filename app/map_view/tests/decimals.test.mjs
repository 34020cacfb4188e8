// A fraction that is typed with a comma is not ten times as much.

import assert from "node:assert/strict";
import { test } from "node:test";

import { takeCommas, written } from "../src/decimals.js";

test("a comma is a point where the language writes fractions with it", () => {
  for (const typed of [",", "2,5"]) {
    assert.equal(written(typed, "0.5", "es"), typed.replace(",", "."));
    assert.equal(written(typed, "any", "es"), typed.replace(",", "."));
    for (const language of ["en", "he", ""]) assert.equal(written(typed, "0.5", language), null, language);
  }
  assert.equal(written("٫", "0.1", "ar"), ".");
});

test("what is no fraction stays as it was typed", () => {
  for (const typed of ["5", ".", "1.320,5", "a,b", null, ""]) assert.equal(written(typed, "0.5", "es"), null, typed);
  assert.equal(written(",", "1", "es"), null, "a box of whole numbers");
});

test("it is written in the box that it was typed into, once however many maps there are", () => {
  const heard = [], made = [];
  globalThis.document = {
    documentElement: { lang: "es" }, addEventListener: (kind, hear) => heard.push([kind, hear]),
    execCommand: (...command) => made.push(command),
  };
  takeCommas();
  takeCommas();
  assert.deepEqual(heard.map(([kind]) => kind), ["beforeinput"]);
  let stopped = 0;
  const type = (target, data) => heard[0][1]({ target, data, preventDefault: () => { stopped += 1; } });
  type({ type: "text", step: "" }, ",");
  type({ type: "number", step: "0.5" }, "5");
  assert.equal(stopped, 0);
  type({ type: "number", step: "0.5" }, ",");
  assert.deepEqual([stopped, made], [1, [["insertText", false, "."]]]);
});
