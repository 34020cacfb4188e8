// The first view holds the whole plot in what panels leave free; the scale is Web Mercator's.

import assert from "node:assert/strict";
import { test } from "node:test";

import { WebMercatorViewport } from "@deck.gl/core";

import { nameBoxes, rowBoxes } from "../src/labels.js";
import { besideBox, fitted, metresPerPixel } from "../src/view.js";

const ROOMS = [
  [{ width: 1440, height: 840 }, { left: 430, right: 64, top: 24, bottom: 56 }],
  [{ width: 390, height: 784 }, { left: 30, right: 64, top: 24, bottom: 420 }],
  [{ width: 1024, height: 700 }, { left: 30, right: 480, top: 24, bottom: 56 }],
];
const PLOTS = [[35, 0.004, 0.001], [35, 0.001, 0.004], [35, 0.002, 0.002]];

for (const lat of [-34, 0, 30.3, 52]) {
  test(`a whole plot at ${lat} degrees is in the free part of the window, and fills it`, () => {
    for (const [size, padding] of ROOMS) {
      for (const [lon, wide, tall] of PLOTS) {
        const view = fitted([lon, lat, lon + wide, lat + tall], size, padding);
        const port = new WebMercatorViewport({ ...size, ...view });
        const [x0, y1] = port.project([lon, lat]), [x1, y0] = port.project([lon + wide, lat + tall]);
        const free = [padding.left, padding.top, size.width - padding.right, size.height - padding.bottom];
        assert.ok(x0 > free[0] - 1 && x1 < free[2] + 1 && y0 > free[1] - 1 && y1 < free[3] + 1, `${[x0, y0, x1, y1]} not in ${free}`);
        const share = Math.max((x1 - x0) / (free[2] - free[0]), (y1 - y0) / (free[3] - free[1]));
        assert.ok(share > 0.98, `fills only ${share}`);
        assert.equal(view.pitch, 0);
        assert.equal(view.bearing, 0);
      }
    }
  });
}

test("a plot of one plant and a window all covered by panels have a view too", () => {
  const one = fitted([35, 30, 35, 30], { width: 800, height: 600 }, { left: 30, right: 30, top: 30, bottom: 30 });
  assert.ok(one.zoom <= 21 && Number.isFinite(one.longitude));
  const covered = fitted([35, 30, 35.001, 30.001], { width: 300, height: 200 }, { left: 900, right: 64, top: 24, bottom: 700 });
  assert.ok(Object.values(covered).every(Number.isFinite));
});

test("a pixel is as many metres as on the map", () => {
  for (const latitude of [0, 30.3, -52]) {
    const port = new WebMercatorViewport({ width: 800, height: 600, longitude: 35, latitude, zoom: 17 });
    const [x0] = port.project([35, latitude]), [x1] = port.project([35.001, latitude]);
    const metres = 0.001 * (40075016.686 / 360) * Math.cos((latitude * Math.PI) / 180);
    assert.ok(Math.abs(metresPerPixel({ latitude, zoom: 17 }) * (x1 - x0) / metres - 1) < 1e-6);
  }
});

test("a plot whose corner a legend would hide is shown beside it or above it, any other as large as it can be", () => {
  const size = { width: 1024, height: 700 }, padding = { left: 430, right: 64, top: 24, bottom: 56 };
  const bounds = [35, 30, 35.002, 30.002], all = [[35, 30], [35.002, 30], [35, 30.002], [35.002, 30.002]];
  for (const box of [{ left: 700, right: 1012, top: 500, bottom: 700 }, { left: 430, right: 640, top: 500, bottom: 700 }]) {
    const view = besideBox(bounds, size, padding, box, all), port = new WebMercatorViewport({ ...size, ...view });
    const hidden = all.filter((place) => {
      const [x, y] = port.project(place);
      return x > box.left && x < box.right && y > box.top && y < box.bottom;
    });
    assert.deepEqual(hidden, []);
    assert.ok(view.zoom < fitted(bounds, size, padding).zoom);
    assert.deepEqual(besideBox(bounds, size, padding, box, [[35.001, 30.001]]), fitted(bounds, size, padding));
  }
  assert.deepEqual(besideBox(bounds, size, padding, null, all), fitted(bounds, size, padding));
});

// every fifth row of a plot has its number beyond its end, in the west or in the east
function numbered([west, south, east, north], side) {
  const [end, away] = side === "west" ? [west, west - 1] : [east, east + 1];
  return Array.from({ length: 20 }, (_, k) => {
    const lat = south + ((north - south) * (k + 0.5)) / 20;
    return { p: [end, lat], away: [away, lat], t: `${k + 101}`, k: "row", row: k + 1 };
  });
}

for (const side of ["west", "east"]) {
  test(`numbers of rows in the ${side} are clear of panels, handle, tools and legend`, () => {
    const legend = { left: 700, right: 1012, top: 500, bottom: 700 };
    for (const [size, padding] of ROOMS) {
      for (const [lon, wide, tall] of PLOTS) {
        const bounds = [lon, 30, lon + wide, 30 + tall], labels = numbered(bounds, side);
        const box = size.width > 1000 ? legend : null;
        const view = besideBox(bounds, size, padding, box, [], (port) => rowBoxes(labels, port));
        const boxes = rowBoxes(labels, new WebMercatorViewport({ ...size, ...view }));
        assert.ok(boxes.length > 1);
        for (const [left, top, right, bottom] of boxes) {
          assert.ok(left > padding.left - 5 && right < size.width - padding.right + 5, `${left} to ${right}`);
          assert.ok(top > 0 && bottom < size.height - padding.bottom + 25, `${top} to ${bottom}`);
          const hidden = box && right > box.left && left < box.right && bottom > box.top && top < box.bottom;
          assert.ok(!hidden, `${left}, ${top} is behind the legend`);
        }
      }
    }
  });
}

test("names of plots that stand below their marks are clear of the legend, too", () => {
  const bounds = [34, 29, 37, 32], size = { width: 1024, height: 700 }, padding = { left: 30, right: 60, top: 24, bottom: 76 };
  const legend = { left: 700, right: 1012, top: 640, bottom: 700 };
  const labels = [[34, 32], [36.2, 29]].map((p) => ({ p, away: [p[0], p[1] - 1e-4], gap: 12, t: "South-east 2026", k: "name" }));
  const view = besideBox(bounds, size, padding, legend, labels.map(({ p }) => p), (port) => nameBoxes(labels, port));
  const port = new WebMercatorViewport({ ...size, ...view });
  for (const [left, top, right, bottom] of nameBoxes(labels, port)) {
    assert.ok(left > 0 && right < size.width && top > 0 && bottom < size.height);
    assert.ok(!(right > legend.left && left < legend.right && bottom > legend.top), `${left}, ${bottom} is behind the legend`);
  }
});

test("who works on a plot and when takes no room from the plots", () => {
  const [size, padding] = ROOMS[1], bounds = [34, 29, 37, 32];
  const viewOf = (more) => {
    const labels = [[34.1, 31], [36.9, 30]].map((p) => ({ p, t: `Gate${more}`, k: "name" }));
    return besideBox(bounds, size, padding, null, [], (port) => nameBoxes(labels, port));
  };
  const planned = viewOf("\nrobot 1, 06:00-15:59");
  assert.ok(viewOf("").zoom - planned.zoom < 0.1, `${planned.zoom}`);
});
