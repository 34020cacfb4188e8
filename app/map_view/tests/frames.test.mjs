// The season's days: each takes the place of the map's own layers, and a film has all of them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { page, place } from "./page.mjs";

page();
const { Frames } = await import("../src/frames.js");
const WORDS = { play_season: "Play", day: "Day", film: "Film", film_name: "season" };
const NAMES = ["1 May", "2 May", "3 May"];

globalThis.fetch = async (url) => ({ ok: true, json: async () => ({ id: "plants", day: url }) });

function framed(more = {}, called = "") {
  const seen = [], saved = [];
  const frames = new Frames(place(), {
    changed: () => seen.push(frames.of([{ id: "plan" }, { id: "plants", day: "now" }, { id: "route" }]).map((one) => one.day ?? one.id)),
    shot: async (name) => ({ width: 4, height: 3, name, getContext: () => ({ getImageData: () => ({ data: new Uint8ClampedArray(48).fill(9) }) }) }),
    save: (blob, name) => saved.push([blob, name]), called: () => called,
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

test("a day that cannot be fetched is not named until it is, and a film waits for it", async (context) => {
  context.mock.method(globalThis, "setTimeout", (done) => setImmediate(done));
  let fails = 2;
  context.mock.method(globalThis, "fetch", async (url) => {
    if (url === "late0" && fails-- > 0) return { ok: false, status: 404 };
    return { ok: true, json: async () => ({ id: "plants", day: url }) };
  });
  const layers = NAMES.map((_, k) => [{ id: "plants", url: `late${k}` }]);
  const { frames, seen } = framed({ layers });
  let gone = 0;
  frames.gone = () => { gone++; assert.equal(frames.day, "3 May"); };
  const films = [];
  frames.shot = async (name) => { films.push([name, seen.at(-1)[1]]); return {}; };
  for await (const canvas of frames.canvases()) assert.ok(canvas);
  assert.equal(gone, 2);
  assert.deepEqual(films, [["1 May", "late0"], ["2 May", "late1"], ["3 May", "now"]]);
});

test("days that the server has elsewhere now are fetched from there", async () => {
  const { frames, seen } = framed();
  frames.show({ key: "k", names: NAMES, layers: NAMES.map((_, k) => [{ id: "plants", url: `new${k}` }]), now: 2 }, WORDS);
  await frames.to(0);
  assert.deepEqual(seen.at(-1), ["plan", "new0", "route"]);
});

test("while a film is made the days stay its own, and one of other days is not saved", async () => {
  const { frames, saved } = framed();
  const own = frames.shot;
  frames.shot = (name) => {
    assert.ok(frames.slider.disabled && frames.press.disabled);
    if (name === "2 May") frames.show({ key: "other", names: ["4 May"], layers: [[]], now: 0 }, WORDS);
    return own(name);
  };
  await frames.record("gif", WORDS);
  assert.equal(frames.day, "4 May");
  assert.deepEqual(saved, []);
  assert.equal(frames.slider.disabled, undefined);
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

test("a film is called as what it shows, in letters that a file's name may have", async () => {
  const { frames, saved } = framed({}, "\u2068Olivar / Sur\u2069 «B»: دفيئة 3");
  await frames.record("gif", WORDS);
  assert.equal(saved[0][1], "Olivar _ Sur «B»_ دفيئة 3.gif");
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
