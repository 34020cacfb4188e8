// Plants are read as Python writes them; what is fetched is fetched once.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { layer, persist, placesOf } from "../src/store.js";

// written by tests/app/show/maps/plants_file.py, and held to what is written today by a test there
const kept = JSON.parse(await readFile(new URL("plants.json", import.meta.url), "utf8"));
const bytes = Buffer.from(kept.places, "base64");
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);

test("every plant is where Python says, with its row and its number in it", () => {
  const places = placesOf(buffer);
  assert.equal(places.n, kept.rows * kept.plants);
  kept.lonlat.forEach(([lon, lat], k) => {
    assert.ok(Math.abs(places.lon[k] - lon) < 1e-12 && Math.abs(places.lat[k] - lat) < 1e-12);
  });
  assert.deepEqual([...places.row], kept.row);
  assert.deepEqual([...places.number], kept.number);
  assert.equal(places.step, kept.step);
});

test("the bounds hold every plant with half a step round it", () => {
  const { bounds, lon, lat, step } = placesOf(buffer), [west, south, east, north] = bounds;
  const flat = Math.cos((lat[0] * Math.PI) / 180);
  const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-9, `${a} ${b}`);
  near(west, Math.min(...lon) - step / 2 / flat);
  near(east, Math.max(...lon) + step / 2 / flat);
  near(south, Math.min(...lat) - step / 2);
  near(north, Math.max(...lat) + step / 2);
});

test("a layer has its arrays in place of their addresses, and each is fetched once", async () => {
  const asked = [];
  const content = {
    "/a": { json: { "@@type": "PlantsLayer", id: "plants" } },
    "/p": { buffer }, "/r": { buffer: new Uint8Array([1, 2, 3]).buffer },
    "/v": { buffer: new Float32Array([0.25, 0.5]).buffer },
  };
  globalThis.fetch = async (url) => {
    asked.push(url);
    return { ok: true, json: async () => content[url].json, arrayBuffer: async () => content[url].buffer };
  };
  const sent = { url: "/a", places: "/p", ranks: "/r", values: "/v" };
  for (let k = 0; k < 3; k++) {
    const made = await layer(sent);
    assert.equal(made.id, "plants");
    assert.equal(made.places.n, kept.row.length);
    assert.deepEqual([...made.ranks], [1, 2, 3]);
    assert.deepEqual([...made.values], [0.25, 0.5]);
  }
  assert.deepEqual(asked.sort(), ["/a", "/p", "/r", "/v"]);
});

test("what could not be fetched is asked for again", async () => {
  let there = false;
  globalThis.fetch = async () => ({ ok: there, status: 404, json: async () => ({ id: "late" }) });
  await assert.rejects(layer({ url: "/late" }), /404/);
  there = true;
  assert.equal((await layer({ url: "/late" })).id, "late");
});

test("what fails is asked for until it is there, and the server hears of what it has let go of", async () => {
  const answers = [new TypeError("no network"), Object.assign(new Error("404"), { gone: true }), "the map"];
  const rests = [];
  let heard = 0;
  const fetched = async () => {
    const next = answers.shift();
    if (next instanceof Error) throw next;
    return next;
  };
  assert.equal(await persist(fetched, () => true, () => heard++, async (ms) => rests.push(ms)), "the map");
  assert.equal(heard, 1);
  assert.ok(rests[1] > rests[0]);
});

test("what is no longer wanted is not asked for again", async () => {
  let wanted = true, asked = 0;
  const fails = async () => { asked++; throw new TypeError("no network"); };
  assert.equal(await persist(fails, () => wanted, () => {}, async () => { wanted = false; }), null);
  assert.equal(await persist(async () => "late", () => false, () => {}), null);
  assert.equal(asked, 1);
});
