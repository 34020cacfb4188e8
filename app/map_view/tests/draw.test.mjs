// Drawing by clicks: exact, snapping near corners only, taken back, finished with enough of them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Drawing } from "../src/draw.js";
import { flatView } from "./plots.mjs";

const view = flatView(); // a pixel is a thousandth of a degree
const AREA = { kind: "area", id: "no_go", snap: [[0.1, -0.1]] };

function begun(mode) {
  const told = [], drawing = new Drawing(() => { drawing.times = (drawing.times ?? 0) + 1; }, (...what) => told.push(what));
  drawing.begin(mode);
  return { drawing, told };
}

test("an area of clicks is told corner by corner, once there are three", () => {
  const { drawing, told } = begun(AREA), corners = [[0.3, -0.3], [0.5, -0.3], [0.4, -0.5]];
  for (const [k, corner] of corners.entries()) {
    assert.equal(drawing.ready, false);
    drawing.finish();
    assert.deepEqual(told, [], `finished with ${k} corners`);
    drawing.click(corner, view);
  }
  drawing.finish();
  assert.deepEqual(told, [[AREA, corners]]);
  assert.deepEqual(drawing.points, [], "the next one begins anew");
});

test("a gate is one click, a path at least two", () => {
  const gate = begun({ kind: "point", id: "gate" });
  gate.drawing.click([0.2, -0.2], view);
  assert.deepEqual(gate.told[0][1], [[0.2, -0.2]]);
  const path = begun({ kind: "line", id: "path" });
  path.drawing.click([0, 0], view);
  path.drawing.finish();
  assert.equal(path.told.length, 0);
  path.drawing.click([0.1, 0], view);
  path.drawing.finish();
  assert.equal(path.told[0][1].length, 2);
});

test("a click within ten pixels of a corner is that corner, the nearest of them; others are exact", () => {
  const { drawing } = begun({ ...AREA, snap: [[0.1, -0.1], [0.104, -0.1]] });
  drawing.click([0.103, -0.101], view);
  drawing.click([0.1, -0.0901], view);
  drawing.click([0.1, -0.0899], view);
  assert.deepEqual(drawing.points, [[0.104, -0.1], [0.1, -0.1], [0.1, -0.0899]]);
});

test("corners are dragged, taken back one by one, and dropped", () => {
  const { drawing } = begun(AREA);
  for (const x of [0.3, 0.5, 0.7]) drawing.click([x, -0.5], view);
  assert.equal(drawing.grabbed([0.509, -0.505], view), 1);
  assert.equal(drawing.grabbed([0.52, -0.5], view), -1);
  drawing.move(1, [0.1005, -0.1], view);
  assert.deepEqual(drawing.points[1], [0.1, -0.1], "a corner that is dragged snaps too");
  drawing.undo();
  assert.equal(drawing.points.length, 2);
  drawing.drop();
  drawing.undo();
  assert.deepEqual(drawing.points, []);
});

test("another thing to draw begins anew, the same goes on though the page was sent again", () => {
  const { drawing } = begun(AREA);
  drawing.click([0.3, -0.3], view);
  drawing.begin({ ...AREA });
  assert.equal(drawing.points.length, 1);
  drawing.begin({ kind: "line", id: "path" });
  assert.equal(drawing.points.length, 0);
  drawing.begin(null);
  assert.equal(drawing.mode, null);
});

test("what is drawn so far is shown: closed from the third corner on, with a handle for each", () => {
  const { drawing } = begun(AREA);
  assert.deepEqual(drawing.layers([1, 2, 3]), []);
  for (const [k, corner] of [[0.3, -0.3], [0.5, -0.3], [0.4, -0.5]].entries()) {
    drawing.click(corner, view);
    const [casing, line, corners] = drawing.layers([1, 2, 3]);
    assert.ok(casing.getWidth > line.getWidth && casing.getColor.every((one) => one === 255), "seen on any plants");
    assert.deepEqual(drawing.layers([200, 210, 220])[0].getColor, [0, 0, 0]);
    assert.equal(line.data[0].p.length, k === 2 ? 4 : k + 1);
    assert.equal(corners.data.length, k + 1);
  }
  assert.deepEqual(drawing.layers([1, 2, 3])[0].data[0].p.at(-1), [0.3, -0.3]);
});

test("a row that is there is bent by dragging and by new corners, each change told at once", () => {
  const row = { kind: "bent", id: "row 1", points: [[0.1, -0.5], [0.5, -0.5], [0.9, -0.5]] };
  const { drawing, told } = begun(row);
  assert.deepEqual(drawing.points, row.points);
  assert.equal(drawing.grabbed([0.505, -0.505], view), 1);
  drawing.move(1, [0.5, -0.6], view);
  assert.equal(told.length, 0, "not before the pointer is let go");
  drawing.told();
  assert.deepEqual(told[0], [row, [[0.1, -0.5], [0.5, -0.6], [0.9, -0.5]]]);
  drawing.click([0.7, -0.5], view);
  assert.deepEqual(told[1][1].map(([x]) => x), [0.1, 0.5, 0.7, 0.9], "between the corners it lies beside");
  drawing.click([0.02, -0.5], view);
  drawing.click([0.97, -0.5], view);
  assert.deepEqual(told[3][1].map(([x]) => x), [0.02, 0.1, 0.5, 0.7, 0.9, 0.97]);
  drawing.finish();
  assert.equal(told.length, 4, "it stays to be bent on");
  drawing.drop();
  assert.deepEqual(told[4][1], row.points, "dropped, it runs as it did");
});

const OUTLINE = { kind: "outline", id: "outline 0", points: [] };
const SQUARE = [[0.1, -0.1], [0.3, -0.1], [0.3, -0.3], [0.1, -0.3]];

function outlined(corners = SQUARE) {
  const { drawing, told } = begun(OUTLINE);
  for (const corner of corners) drawing.click(corner, view);
  return { drawing, told };
}

test("of a plot each corner is told at once, and it goes on from the corners that there are", () => {
  const { drawing, told } = outlined();
  assert.deepEqual(told.map(([mode, points]) => [mode.id, points.length]), [1, 2, 3, 4].map((n) => ["outline 0", n]));
  assert.deepEqual(drawing.points, SQUARE);
  drawing.undo();
  assert.deepEqual(told.at(-1), [OUTLINE, SQUARE.slice(0, 3)]);
  drawing.drop();
  assert.deepEqual(told.at(-1), [OUTLINE, []], "dropped is dropped");
  drawing.begin({ ...OUTLINE, id: "outline 1", points: SQUARE });
  assert.deepEqual(drawing.points, SQUARE);
});

test("a tap on an edge adds a corner there, one beside it or beyond its end comes last", () => {
  const { drawing } = outlined();
  drawing.click([0.2, -0.105], view);
  assert.deepEqual(drawing.points[1], [0.2, -0.105]);
  drawing.click([0.2, -0.2], view);
  drawing.click([0.4, -0.1], view);
  assert.deepEqual(drawing.points.slice(-2), [[0.2, -0.2], [0.4, -0.1]]);
});

test("a tap on the first corner finishes once there are three, one on another does nothing", () => {
  const few = outlined(SQUARE.slice(0, 2));
  few.drawing.click(SQUARE[0], view);
  assert.equal(few.told.length, 2);
  const { drawing, told } = outlined();
  drawing.click([0.302, -0.101], view);
  assert.equal(told.length, 4);
  drawing.click([0.102, -0.101], view);
  assert.deepEqual(told.at(-1), [{ ...OUTLINE, id: "outline 0 done" }, SQUARE]);
  assert.deepEqual(drawing.points, SQUARE, "it stays: the server may refuse it");
});

test("a corner is dragged, and dragged onto a neighbour it is gone", () => {
  const { drawing, told } = outlined();
  drawing.move(1, [0.35, -0.1], view);
  drawing.dropped(1, view);
  assert.deepEqual(told.at(-1)[1][1], [0.35, -0.1]);
  drawing.move(0, [0.102, -0.301], view);
  drawing.dropped(0, view);
  assert.deepEqual(told.at(-1)[1], [[0.35, -0.1], ...SQUARE.slice(2)]);
});

test("what was done last to a plot's corners is taken back: one on an edge, a drag, all of them dropped", () => {
  const { drawing, told } = outlined();
  drawing.click([0.2, -0.1], view);
  drawing.undo();
  assert.deepEqual(drawing.points, SQUARE);
  drawing.move(0, [0.15, -0.05], view);
  drawing.move(0, [0.16, -0.05], view);
  drawing.dropped(0, view);
  drawing.dropped(0, view);
  drawing.undo();
  assert.deepEqual(drawing.points, SQUARE);
  drawing.drop();
  drawing.undo();
  assert.deepEqual(told.at(-1), [OUTLINE, SQUARE]);
  for (const left of [3, 2, 1, 0]) {
    assert.equal(drawing.canUndo, true);
    drawing.undo();
    assert.equal(drawing.points.length, left);
  }
  assert.equal(drawing.canUndo, false);
  drawing.begin({ ...OUTLINE, id: "outline 1", points: SQUARE });
  drawing.undo();
  assert.equal(drawing.points.length, 3, "of corners that there were, the last");
});

test("the outline of a plot is closed from three corners on", () => {
  const path = (n) => outlined(SQUARE.slice(0, n)).drawing.layers([0, 0, 0])[0].data[0].p;
  assert.equal(path(2).length, 2);
  assert.deepEqual(path(3), [...SQUARE.slice(0, 3), SQUARE[0]]);
});

test("an outline that crosses itself is drawn as wrong and cannot be finished until it does not", () => {
  const told = [], drawing = new Drawing(() => {}, (mode, points) => told.push([mode.id, points]));
  const box = [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]], shown = () => drawing.layers([0, 120, 0])[1].getColor;
  drawing.begin({ kind: "outline", id: "o", points: [box[0], box[2], box[1], box[3]], lengths: [] });
  drawing.finish();
  assert.deepEqual([drawing.ready, told.length], [false, 0]);
  assert.notDeepEqual(shown(), [0, 120, 0]);
  drawing.begin({ kind: "outline", id: "p", points: box, lengths: [] });
  assert.deepEqual([drawing.ready, shown()], [true, [0, 120, 0]]);
});

test("the edges of a plot say how long they are while a corner is dragged", () => {
  const lengths = [[0, 1, "0", "{n} m"], [1000, 1000, "0,00", "{n} km"]];
  const { drawing } = begun({ ...OUTLINE, lengths, points: [[34.9, 31.5], [34.902, 31.5], [34.902, 31.502]] });
  const said = () => drawing.labels().map(({ t }) => t);
  assert.deepEqual(said(), ["1", "2", "3", "190 m", "222 m", "292 m"]);
  drawing.points = drawing.points.with(1, [34.92, 31.5]);
  assert.deepEqual(said().slice(3), ["1,90 km", "1,72 km", "292 m"]);
  drawing.points = drawing.points.slice(0, 2);
  assert.deepEqual(said(), ["1", "2", "1,90 km"]);
  drawing.points = [];
  assert.deepEqual(said(), []);
});

test("a corner is set and dragged to the centimetre, as it is kept", () => {
  const { drawing, told } = outlined(SQUARE.slice(0, 2));
  drawing.add([34.90000004, 31.49999996]);
  assert.deepEqual(told.at(-1)[1].at(-1), [34.9, 31.5]);
  drawing.move(0, [34.90000014, 31.5], view);
  assert.deepEqual(drawing.points[0], [34.9000001, 31.5]);
});
