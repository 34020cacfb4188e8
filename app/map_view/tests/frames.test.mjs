// The season's days: each takes the place of the map's own layers, and a film has all of them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { page, place } from "./page.mjs";

page();
const { Frames } = await import("../src/frames.js");
const WORDS = { play_season: "Play", day: "Day", film: "Film", film_name: "season" };
const NAMES = ["1 May", "2 May", "3 May"];

globalThis.fetch = async (url) => ({ ok: true, json: async () => ({ id: "plants", day: url }) });

function framed(more = {}) {
  const seen = [], saved = [];
  const frames = new Frames(place(), {
    changed: () => seen.push(frames.of([{ id: "plan" }, { id: "plants", day: "now" }, { id: "route" }]).map((one) => one.day ?? one.id)),
    shot: async (name) => ({ width: 4, height: 3, name, getContext: () => ({ getImageData: () => ({ data: new Uint8ClampedArray(48).fill(9) }) }) }),
    save: (blob, name) => saved.push([blob, name]),
  });
  const layers = NAMES.map((_, k) => [{ id: "plants", url: `day${k}` }]);
  frames.show({ key: "k", names: NAMES, layers, now: 2, ...more }, WORDS);
  return { frames, seen, saved };
}

test("the day shown first is the map's own; another day's layers stand where its own stood", async () => {
  const { frames, seen } = framed();
  assert.equal(frames.day, "3 May");
  assert.deepEqual(frames.hides, []);
  await frames.to(0);
  assert.deepEqual(seen.at(-1), ["plan", "day0", "route"]);
  assert.deepEqual(frames.hides, ["route", "numbers"], "the route is today's");
  await frames.to(2);
  assert.deepEqual(seen.at(-1), ["plan", "now", "route"]);
});

test("of two days asked for one after the other, the last one is shown whichever comes first", async () => {
  const { frames, seen } = framed();
  await Promise.all([frames.to(0), frames.to(1)]);
  assert.deepEqual(seen.at(-1), ["plan", "day1", "route"]);
  assert.equal(frames.name.textContent, "2 May");
  assert.equal(frames.slider.getAttribute("aria-valuetext"), "2 May");
});

test("a film is a GIF of every day in order, and the map then shows the day it showed", async () => {
  const { frames, saved } = framed();
  const days = [];
  const own = frames.shot;
  frames.shot = (name) => { days.push(name); assert.deepEqual(frames.hides, ["route", "numbers"]); return own(name); };
  await frames.to(1);
  await frames.record("gif", WORDS);
  assert.deepEqual(days, NAMES);
  const [[blob, name]] = saved, bytes = new Uint8Array(await blob.arrayBuffer());
  assert.equal(name, "season.gif");
  assert.equal(new TextDecoder().decode(bytes.slice(0, 6)), "GIF89a");
  assert.equal(frames.day, "2 May");
  assert.equal(frames.films.every((one) => !one.disabled), true);
});

test("a map without days shows no slider, and the same days sent again stay where they are", async () => {
  const { frames } = framed();
  await frames.to(0);
  frames.show({ key: "k", names: NAMES, layers: [[], [], []], now: 2 }, WORDS);
  assert.equal(frames.day, "1 May");
  frames.show(null, WORDS);
  assert.equal(frames.root.hidden, true);
  assert.equal(frames.day, null);
});
