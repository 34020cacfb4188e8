// What lies on the map: a scale that is as long as it says, and a legend that says all.

import assert from "node:assert/strict";
import { test } from "node:test";

import { page, place } from "./page.mjs";

page();
const { button, element, legendOf, Scale } = await import("../src/chrome.js");
const { metresPerPixel } = await import("../src/view.js");

const LENGTHS = [[1, "1 m"], [5, "5 m"], [20, "20 m"], [100, "100 m"], [500, "500 m"]];

test("the scale bar is the longest that fits, and as long as it says at every zoom", () => {
  const scale = new Scale(place());
  for (let zoom = 10; zoom < 23; zoom += 0.7) {
    const view = { latitude: 30.3, zoom, bearing: 0 };
    scale.draw(view, { lengths: LENGTHS, alt: "It is {bar} long." });
    const { px, text } = scale.length, [metres] = LENGTHS.find(([, said]) => said === text);
    assert.ok(Math.abs(px * metresPerPixel(view) - metres) < 1e-6);
    assert.ok(px <= 120 || text === "1 m");
    assert.equal(scale.root.getAttribute("aria-label"), `It is ${text} long.`);
    const longer = LENGTHS.find(([m]) => m > metres);
    assert.ok(!longer || longer[0] / metresPerPixel(view) > 120, "a longer one would have fitted");
  }
});

test("the north arrow turns with the map", () => {
  const scale = new Scale(place());
  scale.draw({ latitude: 0, zoom: 15, bearing: 40 }, { lengths: LENGTHS, alt: "" });
  assert.equal(scale.north.style.transform, "rotate(-40deg)");
  assert.equal(scale.length.bearing, 40); // so it does in a picture
  assert.notEqual(scale.north.textContent, "▲", "it looks upright at every 120 degrees");
});

test("a legend says every sign with its words, a scale every class", () => {
  const parts = legendOf([
    { title: "", items: [["line", [1, 2, 3], "route"], ["ring", [4, 5, 6], "gate"]] },
    { title: "Chance", scale: true, items: [["square", [7, 8, 9], "0 %"], ["square", [1, 1, 1], "50 %+"]] },
  ]);
  const said = parts.flatMap((one) => one.all()).map((one) => one.textContent).filter((text) => text && !text.startsWith("<"));
  assert.deepEqual(said, ["route", "gate", "Chance", "0 %", "50 %+"]);
});

test("a button has a name for those who do not see its sign, and an attribute of false is none", () => {
  let pressed = 0;
  const made = button("fit", "The whole plot", () => { pressed++; });
  assert.equal(made.getAttribute("aria-label"), "The whole plot");
  made.fire("click");
  assert.equal(pressed, 1);
  const box = element("input", { checked: false, disabled: true });
  assert.equal(box.getAttribute("checked"), null);
  assert.equal(box.getAttribute("disabled"), "");
});
