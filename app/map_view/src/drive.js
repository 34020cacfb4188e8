// A driven day between the rows: one robot or several by one clock, their ways, what they found and what
// is believed by then.

import { COORDINATE_SYSTEM, WebMercatorViewport } from "@deck.gl/core";
import { TripsLayer } from "@deck.gl/geo-layers";
import { ColumnLayer, PathLayer, PolygonLayer, ScatterplotLayer } from "@deck.gl/layers";

import { element } from "./chrome.js";
import { sinceLast } from "./frame_time.js";
import { metresPerPixel } from "./view.js";

const SPEEDS = [1, 10, 30, 100, 300], M_PER_DEGREE = 111320;
// a day that is driven now is asked for so often
const ASK_MS = 1000;
export const PITCH = 55;
const ALONE = [255, 210, 0], LOST = [140, 140, 140], NOSE = [20, 24, 28], NOSE_ON_DARK = [255, 255, 255];
// nearer than so many metres a pixel plants are columns, the nearest of them, within so many metres
const NEAR = 0.11, MOST = 1500, FEW = 400, REACH_M = 60, SLOW_MS = 60;
// seen from above a plant has the legend's colour: its share of deck.gl's usual lights is then 1
const BUSH = { ambient: 0.858, diffuse: 0.25, specularColor: [0, 0, 0] };
// the robot is never smaller on the screen; it is followed from so near
const LEAST_PX = 30, FOLLOW_ZOOM = 20.5, TURN_MS = 900;

export class Drive {
  // `changed` is called when another moment is to be drawn
  constructor(place, changed) {
    this.changed = changed;
    this.root = place.appendChild(element("div", { class: "play drive", hidden: true }));
    this.data = null;
    this.key = null;
    this.speed = 30;
    this.root.addEventListener("keydown", (event) => {
      if (event.key === " " && event.target === this.slider) this.pressed(event);
    });
    this.typed = (event) => { if (event.key === " " && this.data && document.activeElement === document.body) this.pressed(event); };
    document.addEventListener("keydown", this.typed);
  }

  // `data` is what the server wrote (see `show/drive_play.py`) or null
  show(data, words, key) {
    const again = JSON.stringify([key, words]);
    if (again === this.key) return;
    const other = data !== this.data;
    this.key = again;
    this.words = words;
    if (other) this.stop();
    this.data = data;
    this.root.hidden = !data;
    this.ask(data?.poll, other);
    if (!data) return;
    if (other) {
      // several are seen together, until one of them is followed
      const following = data.robots.length === 1;
      // a day that goes on is seen at its end
      Object.assign(this, { second: data.link ? data.end : 0, lead: 0, following, turning: true, bearing: data.robots[0]?.heading[0] ?? 0, ranks: null });
    }
    this.press = element("button", { type: "button", class: "tool", text: "▶", "aria-label": words.play, onclick: () => this.toggle() });
    this.slider = element("input", { type: "range", min: 0, max: data.end, step: 1, value: this.second, "aria-label": words.time_of_day,
      oninput: () => this.to(Number(this.slider.value)) });
    this.clock = element("span", { class: "clock", dir: "auto" });
    this.standing = element("span", { class: "standing", dir: "auto", hidden: !data.poll });
    const speed = element("select", { "aria-label": words.speed, onchange: () => { this.speed = Number(speed.value); } },
      SPEEDS.map((by) => element("option", { value: by, text: `${by} ×`, selected: by === this.speed })));
    this.camera = element("input", { type: "checkbox", checked: this.following, onchange: () => this.lookAt(this.lead, this.camera.checked) });
    this.whom = element("select", { "aria-label": words.whom, onchange: () => this.lookAt(Number(this.whom.value), true) });
    this.follow = element("span");
    this.names = null;
    this.root.replaceChildren(this.press, this.slider, speed,
      element("label", { class: "follow" }, [this.camera, this.follow]), this.whom, this.clock, this.standing);
    this.tell();
  }

  lookAt(lead, following) {
    Object.assign(this, { lead, following, turning: true });
    this.camera.checked = following;
    this.changed();
  }

  // Offer the robots that can be followed; others may come while the day goes on.
  offer() {
    const names = this.data.robots.map((one) => one.name), said = JSON.stringify(names);
    if (said === this.names) return;
    this.names = said;
    this.whom.replaceChildren(...names.map((text, value) => element("option", { value, text, selected: value === this.lead })));
    this.whom.hidden = names.length < 2;
    this.follow.textContent = names.length < 2 ? this.words.follow : this.words.follow_one;
  }

  // Ask how a day that is driven now goes, again and again; no address: no more.
  ask(address, other) {
    if (!other && address === this.asked) return;
    this.asked = address;
    const again = async () => {
      if (this.asked !== address) return;
      // who missed an answer asks for everything
      let got = { number: null, values: { link: "away" } };
      const since = Number.isInteger(this.data.number) ? `?since=${this.data.number}` : "";
      try {
        got = await (await fetch(address + since, { cache: "no-store" })).json();
      } catch { /* asked again */ }
      if (this.asked !== address) return;
      this.take(got);
      setTimeout(again, ASK_MS);
    };
    if (address) again();
  }

  // Take in what is new of a day; who looks at its end goes on looking at it.
  take(got) {
    const atEnd = !this.timer && this.second >= this.data.end, { lists = {}, values = {} } = got;
    this.data = withNews(this.data, got);
    // nothing of the map says how long ago a robot was heard
    if (![...Object.keys(lists), ...Object.keys(values)].some((path) => !path.endsWith(".lag"))) {
      this.tell();
      return;
    }
    this.slider.max = this.data.end;
    if (atEnd) {
      this.second = this.data.end;
      if (this.turning) this.bearing = this.pose()?.heading ?? this.bearing;
    }
    this.tell();
    this.changed();
  }

  pressed(event) {
    event.preventDefault();
    this.toggle();
  }

  toggle() {
    if (this.timer) {
      this.stop();
      return;
    }
    if (this.second >= this.data.end) this.to(0);
    this.press.textContent = "❚❚";
    const since = sinceLast();
    const step = (now) => {
      // a page that was not seen for a while goes on where it was
      const gone = Math.min(since(now), 400);
      this.second = Math.min(this.second + (gone / 1000) * this.speed, this.data.end);
      this.turn(gone);
      this.timer = this.second < this.data.end ? requestAnimationFrame(step) : null;
      if (this.mayDraw(now, gone) || !this.timer) {
        this.draws = now;
        this.tell();
        this.changed();
      }
      if (!this.timer) this.stop();
    };
    this.timer = requestAnimationFrame(step);
  }

  // Without a graphics card a picture takes long: then fewer of them, and half the time for the page.
  mayDraw(now, gone) {
    this.cost = Math.max(gone, 0.9 * (this.cost ?? 0));
    return this.draws === undefined || this.cost < SLOW_MS || now - this.draws >= Math.min(2 * this.cost, 700);
  }

  stop() {
    if (this.timer) cancelAnimationFrame(this.timer);
    this.timer = null;
    this.draws = undefined;
    if (this.press) this.press.textContent = "▶";
    if (this.data) this.tell();
  }

  to(second) {
    this.second = second;
    this.tell();
    this.changed();
  }

  release(state) {
    if (!this.leads()) return;
    if (state?.isRotating) this.turning = false;
    if (state?.isPanning) this.following = this.camera.checked = false;
  }

  // Return where the robot is that is followed, or would be; null: nobody knows.
  pose() {
    const robot = this.data.robots[this.lead ?? 0];
    return robot?.at.length ? poseAt(robot, this.second) : null;
  }

  tell() {
    this.offer();
    const { stops } = this.data, made = stops.slice(0, until(stops, this.second)), now = this.pose();
    const found = made.filter((one) => one[2]).length, minutes = Math.floor(this.second / 60);
    const time = `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}`;
    this.slider.value = this.second;
    this.clock.textContent = this.words.driven.replace("{time}", time).replace("{stops}", made.length).replace("{found}", found);
    this.slider.setAttribute("aria-valuetext", this.clock.textContent);
    if (this.data.link) {
      const [standing, said] = standingOf(this.data, this.words);
      this.standing.textContent = said;
      this.standing.dataset.standing = standing;
    }
    this.root.dataset.now = JSON.stringify({ second: this.second, ...now, stops: made.length, found, playing: Boolean(this.timer) });
  }

  // Turn the camera slowly to where the robot heads, unless someone wants little motion.
  turn(gone) {
    if (!this.turning || matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    const by = (((this.pose()?.heading ?? this.bearing) - this.bearing + 540) % 360) - 180;
    this.bearing = (this.bearing + by * Math.min(1, gone / TURN_MS) + 360) % 360;
  }

  // Return the view that follows the robot, at a place of the window; null where nobody wants it.
  view(viewport, middle) {
    if (!this.leads()) return null;
    const { lon, lat } = this.pose(), { width, height } = viewport;
    const own = this.turning ? { bearing: this.bearing } : { bearing: viewport.bearing };
    const near = this.near === this.key ? viewport.zoom : FOLLOW_ZOOM, pitch = viewport.pitch || PITCH;
    Object.assign(this, { near: this.key, size: `${width} ${height}` });
    const port = new WebMercatorViewport({ width, height, longitude: lon, latitude: lat, zoom: near, pitch, ...own });
    return { ...port.panByPosition([lon, lat], middle), zoom: near, pitch, ...own };
  }

  // Return the map's layers with the plants as they are known and believed at the moment.
  of(jsons) {
    const k = this.data ? jsons.findIndex((one) => one.id === "plants-chance" && one.places) : -1;
    if (k < 0) return jsons;
    if (this.from !== jsons[k]) Object.assign(this, { from: jsons[k], ranks: null });
    this.learn();
    return jsons.with(k, this.shaded);
  }

  learn() {
    const { stops, changes, clean, found } = this.data, { table, ranks } = this.from;
    const done = [until(changes, this.second), until(stops, this.second)];
    if (this.ranks && done[0] === this.done[0] && done[1] === this.done[1]) return;
    if (!this.ranks || done[0] < this.done[0] || done[1] < this.done[1]) {
      this.ranks = ranks.slice();
      this.done = [0, 0];
    }
    for (const [, plants, classes] of changes.slice(this.done[0], done[0])) {
      plants.forEach((plant, i) => { if (this.ranks[plant] < table.length) this.ranks[plant] = classes[i]; });
    }
    for (const [, plant, saw] of stops.slice(this.done[1], done[1])) {
      if (saw !== null) this.ranks[plant] = table.length + (saw ? 1 : 0);
    }
    this.done = done;
    // another object: what is made of the ranks is then made again
    this.shaded = { ...this.from, ranks: this.ranks.slice(), table: [...table, [...clean, 255], [...found, 255]] };
    this.columnsAt = null;
  }

  // Return deck.gl's own layers: nothing of them is sent, or made from JSON.
  //
  // Their data is the same object from picture to picture while nothing of it changes: of another
  // one deck.gl makes everything anew, the whole way too.
  layers(viewport, dark) {
    if (!this.data || !viewport) return [];
    const { pieces, ordered, finds } = this.parts(), metres = metresPerPixel(viewport);
    const { places } = this.from ?? {}, tone = dark ? 1 : 0;
    return [
      new TripsLayer({ id: "driven", data: pieces, getPath: (d) => d.path, getTimestamps: (d) => d.at, getColor: (d) => d.colours[tone],
        updateTriggers: { getColor: dark }, widthMinPixels: 3, getWidth: 0.2, currentTime: this.second, trailLength: 1e7, fadeTrail: false, capRounded: true }),
      new PathLayer({ id: "ordered", data: ordered, getPath: (one) => one.path, getColor: (one) => [...one.colours[tone], one.opacity],
        updateTriggers: { getColor: dark }, getWidth: 0.1, widthMinPixels: 2, capRounded: true }),
      places && new ScatterplotLayer({ id: "glow", data: finds, getPosition: (plant) => [places.lon[plant], places.lat[plant]],
        getRadius: 1.1, radiusMinPixels: 7, getFillColor: [...this.data.found, 70], stroked: true, getLineColor: dark ? [255, 255, 255] : [90, 0, 0],
        getLineWidth: 0.08, lineWidthMinPixels: 1.5 }),
      places && this.isNear(viewport) && this.columns(viewport),
      ...this.placed().flatMap(([robot, k]) => this.boxesOf(robot, k, metres, tone)),
    ];
  }

  // Return the robots of which somebody knows where they are, with their numbers: who is followed comes last.
  placed() {
    const { robots } = this.data, isThere = ({ at }) => at.length && (robots.length === 1 || at[0] <= Math.max(this.second, 0.1));
    const known = robots.map((one, k) => [one, k]).filter(([one]) => isThere(one));
    return known.sort(([, a], [, b]) => (a === this.lead) - (b === this.lead));
  }

  // Return the names of several robots, where they are: with their standing, where that is not as it should be.
  labels() {
    if (!this.data || this.data.robots.length < 2) return [];
    const atEnd = this.second >= this.data.end;
    return this.placed().reverse().map(([robot]) => {
      const { lon, lat } = poseAt(robot, this.second), said = atEnd && this.words[`robot_${robot.heard?.standing}`];
      const t = said ? said.replace("{name}", robot.name) : robot.name;
      return { p: [lon, lat], t, k: "who", away: [lon, lat + 1e-4], gap: 18, tight: true };
    });
  }

  // Return what layers are made of: the ways, in pieces where nobody knows what lies between, the ways
  // ordered, and the finds up to now.
  parts() {
    const { stops, robots } = this.data, done = until(stops, this.second);
    const of = robots.flatMap((one) => [one.at, one.unseen, one.way, one.released]), made = this.made?.of;
    if (made?.length !== of.length || made.some((one, k) => one !== of[k])) {
      this.made = { of, pieces: robots.flatMap(piecesOf), ordered: robots.flatMap(orderedOf), finds: [] };
    }
    if (this.made.done !== done) {
      const finds = stops.slice(0, done).filter((one) => one[2]).map((one) => one[1]);
      Object.assign(this.made, { done, finds: finds.length === this.made.finds.length ? this.made.finds : finds });
    }
    return this.made;
  }

  isNear(viewport) {
    return (this.tall = metresPerPixel(viewport) < NEAR);
  }

  centre(viewport) {
    return this.leads() ? this.pose() : { lon: viewport.longitude, lat: viewport.latitude };
  }

  // Tell whether the map follows a robot: of one that was never heard nobody knows where it is.
  leads() {
    return Boolean(this.data && this.following && this.pose());
  }

  // Return how far the map is tilted at first: several robots are seen from above.
  pitch() {
    return this.following ? PITCH : 0;
  }

  // Tell whether other plants are to be drawn tall since somebody moved the map, or whether the robot is
  // elsewhere in a window that was made larger or smaller.
  isStale(viewport) {
    if (!this.data || this.timer || !viewport) return false;
    if (this.leads() && this.size !== `${viewport.width} ${viewport.height}`) return true;
    const near = metresPerPixel(viewport) < NEAR;
    return near !== this.tall || (near && this.columnsAt && metresApart(this.centre(viewport), this.columnsAt) > REACH_M / 8);
  }

  columns(viewport) {
    const { places } = this.from, [radius, tall] = this.data.plant, centre = this.centre(viewport);
    if (!this.columnsAt || metresApart(centre, this.columnsAt) > REACH_M / 8) {
      this.columnsAt = centre;
      const which = nearest(places, centre, this.cost < SLOW_MS ? MOST : FEW), n = which.length, { table, ranks } = this.shaded;
      const positions = new Float64Array(2 * n), colours = new Uint8Array(4 * n), heights = new Float32Array(n);
      which.forEach((plant, k) => {
        const rank = ranks[plant];
        positions.set([places.lon[plant], places.lat[plant]], 2 * k);
        colours.set(table[rank], 4 * k);
        heights[k] = rank === table.length - 1 ? 1.5 * tall : tall;
      });
      this.near3d = { length: n, attributes: { getPosition: { value: positions, size: 2 },
        getFillColor: { value: colours, size: 4, normalized: true }, getElevation: { value: heights, size: 1 } } };
    }
    return new ColumnLayer({ id: "columns", data: this.near3d, radius, diskResolution: 6, extruded: true,
      material: BUSH });
  }

  // Return a robot's layers: boxes that are made once, and put where it stands. One of several has its own
  // colour, and none while its connection is lost.
  boxesOf(robot, k, metres, tone) {
    const { lon, lat, heading } = poseAt(robot, this.second), [long, wide] = robot.size;
    const grown = Math.max(1, (LEAST_PX * metres) / long), of = robot.size.join(" ");
    this.boxes ??= [];
    if (this.boxes[k]?.of !== of) {
      const body = [[-wide / 2, long / 2], [wide / 2, long / 2], [wide / 2, -long / 2], [-wide / 2, -long / 2]];
      const nose = [[0, long / 2], [wide / 3, -long / 4], [-wide / 3, -long / 4]];
      this.boxes[k] = { of, each: [[`robot-${k}`, [body], 0.5], [`nose-${k}`, [nose], 0.62]] };
    }
    const isOne = this.data.robots.length === 1, isLost = this.second >= this.data.end && ["lost", "off"].includes(robot.heard?.standing);
    const own = isLost ? LOST : isOne ? ALONE : robot.colours[tone], paint = [own, isOne || tone ? NOSE : NOSE_ON_DARK];
    return this.boxes[k].each.map(([id, data, tall], part) =>
      new PolygonLayer({ id, data, getPolygon: (one) => one, coordinateSystem: COORDINATE_SYSTEM.METER_OFFSETS, coordinateOrigin: [lon, lat, 0],
        modelMatrix: turned(heading, grown), extruded: true, getElevation: tall, getFillColor: paint[part], material: { ambient: 0.7, diffuse: 0.5 } }));
  }

  end() {
    this.stop();
    this.ask(null);
    document.removeEventListener("keydown", this.typed);
  }
}

// Return a day with what is new of it (see `state/news_since.py`): each thing by its path, of a list what
// comes after so many of its entries, which are as they were. What is `whole` names every robot that is there.
export function withNews(data, { number, whole, lists = {}, values = {} }) {
  const now = { ...data, number, robots: whole ? [] : data.robots.map((one) => ({ ...one, heard: { ...one.heard } })) };
  const put = (path, value) => {
    const names = path.split("."), last = names.pop();
    let at = now;
    for (const name of names) at = at[name] ??= {};
    at[last] = value(at[last]);
  };
  for (const [path, value] of Object.entries(values)) put(path, () => value);
  for (const [path, [same, more]] of Object.entries(lists)) put(path, (before = []) => [...before.slice(0, same), ...more]);
  return now;
}

// Return how many entries of a list that begin with their seconds are at or before a second.
export function until(list, second) {
  let low = 0, high = list.length;
  while (low < high) {
    const mid = (low + high) >> 1;
    if ((Array.isArray(list[mid]) ? list[mid][0] : list[mid]) <= second) low = mid + 1;
    else high = mid;
  }
  return low;
}

// Return where a robot is at a second and where it heads, degrees: while nobody knows its way, where it was
// seen last.
export function poseAt({ at, lon, lat, heading, unseen = [] }, second) {
  if (at.length === 1) return { lon: lon[0], lat: lat[0], heading: heading[0] };
  const k = Math.min(Math.max(until(at, second), 1), at.length - 1);
  const span = unseen.includes(k) && second < at[k] ? Infinity : at[k] - at[k - 1];
  const share = span === Infinity ? 0 : span > 0 ? Math.min(Math.max((second - at[k - 1]) / span, 0), 1) : 1;
  const turned = ((heading[k] - heading[k - 1] + 540) % 360) - 180;
  return { lon: lon[k - 1] + share * (lon[k] - lon[k - 1]), lat: lat[k - 1] + share * (lat[k] - lat[k - 1]),
    heading: (heading[k - 1] + share * turned + 360) % 360 };
}

// Return the pieces of a robot's way, each without a gap in what is known of it.
export function piecesOf({ at, lon, lat, colours, unseen = [] }) {
  const ends = [0, ...unseen, at.length];
  return ends.slice(1).map((to, k) => [ends[k], to]).filter(([from, to]) => to - from > 1)
    .map(([from, to]) => ({ at: at.slice(from, to), path: at.slice(from, to).map((_, k) => [lon[from + k], lat[from + k]]), colours }));
}

// Return the way that a robot is ordered: what is released of it, and fainter what comes after.
export function orderedOf({ way = [], released = 0, colours }) {
  const parts = [{ path: way.slice(0, released), opacity: 200, colours }, { path: way.slice(Math.max(released - 1, 0)), opacity: 80, colours }];
  return parts.filter(({ path }) => path.length > 1);
}

// Return how robots stand, as one word for all and in words: of several those that are not as they should be.
export function standingOf({ link, robots }, words) {
  if (link !== "live") return [link, words[link] ?? ""];
  const said = ({ heard: { standing, lag } }) =>
    (words[standing === "lost" && lag === null ? "lost_before" : standing] ?? "").replace("{seconds}", Math.round(lag ?? 0));
  const odd = robots.length > 1 ? robots.filter(({ heard }) => !["live", "done", "held", "idle"].includes(heard.standing)) : robots;
  const all = odd.map((one) => (robots.length > 1 ? `${one.name}: ${said(one)}` : said(one)));
  return [odd.find(({ heard }) => heard.standing !== "live")?.heard.standing ?? "live", all.join(" · ")];
}

// Return the matrix, column by column, that turns what heads north by degrees clockwise, so many times as large.
export function turned(heading, times) {
  const way = (heading * Math.PI) / 180, cos = times * Math.cos(way), sin = times * Math.sin(way);
  return [cos, -sin, 0, 0, sin, cos, 0, 0, 0, 0, times, 0, 0, 0, 0, 1];
}

function metresApart(a, b) {
  return Math.hypot((a.lon - b.lon) * Math.cos((a.lat * Math.PI) / 180), a.lat - b.lat) * M_PER_DEGREE;
}

// Return the plants nearest to a place, not too many of them.
export function nearest({ n, lon, lat }, place, most) {
  const found = [];
  for (let k = 0; k < n; k++) {
    const apart = metresApart({ lon: lon[k], lat: lat[k] }, place);
    if (apart < REACH_M) found.push([apart, k]);
  }
  if (found.length > most) found.sort((a, b) => a[0] - b[0]);
  return found.slice(0, most).map((one) => one[1]);
}
