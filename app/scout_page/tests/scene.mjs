// A small plot and day for tests: three rows of five plants, two metres apart, three metres between rows.

import { laidOut } from "../src/geo.js";

export function aPlot() {
  const lon = [], lat = [], number = [];
  const [kx, ky] = [96000, 110900];
  for (let row = 0; row < 3; row++) for (let k = 0; k < 5; k++) {
    lon.push(35 + (2 * k) / kx); lat.push(30 + (3 * row) / ky); number.push(k + 1);
  }
  return { name: "Gate", boundary: { type: "Polygon", coordinates: [[[35, 30], [35.0001, 30], [35, 30.0001], [35, 30]]] },
    no_go: { type: "MultiPolygon", coordinates: [] }, gate: null, zone: "Asia/Jerusalem",
    row_spacing_m: 3, plant_spacing_m: 2, rows: { start: [0, 5, 10, 15], row: [1, 2, 3], aisle: [0, 0, 1], side: [1, -1, 1] }, plants: { lon, lat, number } };
}

/** The same with two faces of each plant of its first and its last row: piece after piece, first faces first. */
export function facedPlot() {
  const one = aPlot(), of = [0, 0, 2, 2], plants = { lon: [], lat: [], number: [], face: [], drawn_lon: [], drawn_lat: [] };
  of.forEach((row, piece) => {
    for (let k = 5 * row; k < 5 * row + 5; k++) {
      for (const name of ["lon", "lat", "number"]) plants[name].push(one.plants[name][k]);
      plants.face.push(1 + (piece % 2));
      plants.drawn_lon.push(one.plants.lon[k]);
      plants.drawn_lat.push(one.plants.lat[k] + (piece % 2 ? 0.5 : -0.5) / 110900);
    }
  });
  return { ...one, rows: { start: [0, 5, 10, 15, 20], row: [1, 1, 2, 2], aisle: [0, 1, 1, 2], side: [-1, 1, -1, 1] }, plants };
}

export const laid = () => laidOut(aPlot(), "p1");

export function aDay(plants = [0, 1, 2, 10, 11], more = {}) {
  return { season: "Gate", scout: "Ann", rows: null, plot: "p1", day: "2026-11-22", live: true, starts: "06:00",
    robot: { hours: 4, speed_m_s: 1, row_change_s: 3, visit_s: 35, returns: true }, seconds_left: 14400,
    route: { plants, walk_s: plants.map(() => 2), end_s: 500, line: [] },
    chance: Array(15).fill(20), found: [], clean: [], today: [], contradicting: [], hot_spots: [], photos: [], ...more };
}

/** A season that takes what it is sent, and breaks as it is told. */
export class ASeason {
  constructor(day = aDay(), plot = aPlot()) { Object.assign(this, { day, plot, taken: new Map(), photos: new Map(), by: new Map(), asked: [], breaks: [] }); }

  ask = async (address, request = {}) => {
    this.asked.push(address);
    const how = this.breaks.shift();
    if (how === "before") throw new TypeError("network");
    if (typeof how === "number") return new Response("<html>", { status: how });
    const answer = await this.#answer(address, request);
    if (how === "after") throw new TypeError("answer lost");
    if (how === "half") return new Response((await answer.text()).slice(0, 20), { status: 200 });
    return answer;
  };

  async #answer(address, { method = "GET", body, headers = {} }) {
    const said = (value, status = 200) => new Response(JSON.stringify(value), { status, headers: this.date ? { date: this.date } : {} });
    if (this.keys && !this.keys.includes(headers.authorization?.slice(7))) return said({ error: "no key" }, 401);
    const path = address.split("/").slice(5).join("/").split("?")[0];
    if (path === "plot") return said(this.plot);
    if (path === "day") return said(this.day);
    if (path === "route") return said({ route: { plants: [14, 13], walk_s: [5, 2], end_s: 90, line: [] } });
    if (path === "findings") {
      const { findings } = JSON.parse(body);
      if (findings.some((one) => one.notes === "poison")) return said({ error: "not as described" }, 422);
      return said({ taken: findings.map((one) => {
        const isNew = !this.taken.has(one.id);
        const key = headers.authorization?.slice(7);
        if (isNew) { this.taken.set(one.id, one); this.by.set(key, (this.by.get(key) ?? 0) + 1); }
        return { id: one.id, new: isNew, problem: "" };
      }) });
    }
    const id = path.split("/")[1];
    if (method === "PUT") { this.photos.set(id, new Uint8Array(body).slice()); return said({ new: true }); }
    return said({ error: "none" }, 404);
  }
}
