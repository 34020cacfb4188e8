import assert from "node:assert/strict";
import { test } from "node:test";
import {
  apart, arrowOf, hasNames, laidOut, metres, metresPerDegree, nearest, neighbours, offered, pieceOf, plantAt, rowOf, rowsCalled, shownEnds, signOf, twinOf,
  walkSeconds,
} from "../src/geo.js";
import { aPlot, facedPlot, laid } from "./scene.mjs";

const plot = laid(), robot = { speed_m_s: 1, row_change_s: 3 };

test("a degree is as long as on WGS 84 (at 30 degrees north: 96.486 and 110.852 km)", () => {
  const [kx, ky] = metresPerDegree(30);
  assert.ok(Math.abs(kx - 96486.3) < 1 && Math.abs(ky - 110852.4) < 1, `${kx} ${ky}`);
});

test("plants are apart as on the ground", () => {
  assert.ok(Math.abs(apart(plot, 0, 1) - 2) < 0.02);
  assert.ok(Math.abs(apart(plot, 0, 5) - 3) < 0.02);
});

test("a plant is known by its row and number, and has them", () => {
  for (let plant = 0; plant < 15; plant++) assert.equal(plantAt(plot, rowOf(plot, plant), plot.number[plant]), plant);
  assert.equal(plantAt(plot, 4, 1), -1);
  assert.deepEqual([0, 4, 5, 14].map((plant) => pieceOf(plot, plant)), [0, 0, 1, 2]);
});

test("neighbours stand in the row and across", () => {
  assert.deepEqual(neighbours(plot, 7).sort((a, b) => a - b), [2, 6, 8, 12]);
  assert.deepEqual(neighbours(plot, 0).sort((a, b) => a - b), [1, 5]);
});

test("two faces of a plant are twins, each drawn towards its aisle; a plant with one has none", () => {
  const document = facedPlot(), faced = laidOut(document, "p2"), all = [...faced.number.keys()];
  assert.deepEqual([...faced.face], document.plants.face);
  assert.deepEqual(all.map((plant) => twinOf(faced, plant)), [5, 6, 7, 8, 9, 0, 1, 2, 3, 4, 15, 16, 17, 18, 19, 10, 11, 12, 13, 14]);
  assert.deepEqual([twinOf(plot, 7), plot.face, plot.drawn], [-1, undefined, undefined]);
  for (const plant of all) assert.ok(Math.abs(faced.drawn.y[plant] - faced.y[plant] - (faced.face[plant] === 2 ? 0.5 : -0.5)) < 0.01);
  assert.deepEqual([2, 7].map((plant) => arrowOf(faced, plant)), ["↓", "↑"]);
  const alone = laidOut({ ...document, plants: { ...document.plants, face: document.plants.face.map((one, k) => (k % 5 === 2 ? 0 : one)) } }, "p3");
  assert.deepEqual([2, 7, 3].map((plant) => twinOf(alone, plant)), [-1, -1, 8], "0: no other face is inspected");
});

test("a row's and a plant's number, and a position, mean the first of two faces, whose twin is known", () => {
  const faced = laidOut(facedPlot(), "p2"), [x, y] = [faced.x[17], faced.y[17]];
  const found = plantAt(faced, 2, 3);
  assert.deepEqual([found, twinOf(faced, found)], [12, 17]);
  assert.equal(offered(faced, { x, y, accuracy: 1 }), 12);
});

test("neighbours of a face are those along its row and its twin, as the season has them: none across the aisle", () => {
  const faced = laidOut(facedPlot(), "p2");
  assert.deepEqual(neighbours(faced, 7).sort((a, b) => a - b), [2, 6, 8]);
  assert.deepEqual(neighbours(faced, 0).sort((a, b) => a - b), [1, 5]);
});

test("rows called by other numbers have the same neighbours", () => {
  const document = aPlot(), named = laidOut({ ...document, rows: { ...document.rows, row: [30, 12, 7] } }, "p2");
  for (let plant = 0; plant < 15; plant++) assert.deepEqual(neighbours(named, plant), neighbours(plot, plant));
  assert.equal(plantAt(named, 12, 3), 7);
});

test("rows are shown and called as the plot's file has them", () => {
  const document = aPlot(), rows = { ...document.rows, row: [1, 101, 2], sign: ["1", "101 · 5A", "2"] };
  const named = laidOut({ ...document, rows }, "p3");
  assert.deepEqual([0, 5, 10].map((plant) => signOf(named, plant)), ["1", "101 · 5A", "2"]);
  assert.deepEqual(["5a", " 05A", "101", "02", "5", ""].map((said) => rowsCalled(named, said)), [[101], [101], [101], [2], [], []]);
  assert.deepEqual(shownEnds(named, [2, 101]), ["2", "101 · 5A"]);
  const across = laidOut({ ...document, rows: { ...rows, row: [1, 2, 3], sign: ["1 · 3", "2 · 2", "3 · 1"] } }, "p4");
  assert.deepEqual(["1", "2"].map((said) => rowsCalled(across, said)), [[1, 3], [2]]);
  assert.deepEqual([named, plot].map(hasNames), [true, false]);
  assert.deepEqual([signOf(plot, 7), rowsCalled(plot, "2"), shownEnds(plot, [1, 9])], ["2", [2], ["1", 9]]);
});

test("a position offers a plant only within its accuracy", () => {
  const [x, y] = metres(plot, [35 + 4.5 / 96486, 30 + 3.2 / 110852]);
  assert.equal(nearest(plot, x, y).plant, 7);
  assert.equal(offered(plot, { x, y, accuracy: 1 }), 7);
  assert.equal(offered(plot, { x: x + 40, y, accuracy: 5 }), -1);
  assert.equal(offered(plot, null), -1);
});

test("nobody walks through a row: the way goes round its end", () => {
  assert.ok(Math.abs(walkSeconds(plot, robot, 1, 6) - 3) < 0.1, "the same aisle");
  const round = walkSeconds(plot, robot, 6, 11);
  assert.ok(round > 2 + 3 + 2 + 3 - 0.2, `${round}`);
});
