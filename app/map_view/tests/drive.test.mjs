// A driven day: where the robot is at each second, what is known by then, and who is drawn tall.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Drive, nearest, orderedOf, piecesOf, poseAt, standingOf, turned, until, withNews } from "../src/drive.js";

const ROBOT = {
  name: "", at: [0, 10, 40, 50], lon: [35, 35.001, 35.001, 35.001], lat: [30, 30, 30, 30.001], heading: [90, 90, 350, 10],
  unseen: [], size: [0.8, 0.6], colours: [[0, 0, 9], [9, 9, 0]],
};
const DAY = {
  robots: [ROBOT], stops: [[40, 2, true, 0], [50, 0, false, 0]], changes: [[40, [0, 1, 2], [3, 3, 0]], [50, [1], [2]]], end: 50,
  clean: [0, 0, 255], found: [255, 0, 0], plant: [0.3, 1.5],
};
const heard = (standing, lag = 1) => ({ heard: { standing, lag, said: "" } });
const PLANTS = { id: "plants-chance", places: { n: 3 }, ranks: new Uint8Array([1, 1, 1]), table: [[0], [1], [2], [3]] };

function driving(second) {
  // the page's own parts are not needed for what is drawn
  return Object.assign(Object.create(Drive.prototype), { data: DAY, second, key: "day" });
}

test("the robot moves evenly, stands at a stop, and turns the short way", () => {
  assert.deepEqual(poseAt(ROBOT, 5), { lon: 35.0005, lat: 30, heading: 90 });
  assert.deepEqual([poseAt(ROBOT, 11).lon, poseAt(ROBOT, 39).lon], [35.001, 35.001]);
  assert.equal(poseAt(ROBOT, 45).heading, 0);
  assert.equal(poseAt(ROBOT, -1).lon, 35);
  assert.equal(poseAt(ROBOT, 99).lat, 30.001);
});

test("where nobody knows the way none is drawn, and the robot stays where it was seen last", () => {
  const jumped = { ...ROBOT, unseen: [1] };
  assert.deepEqual([0, 9, 10].map((second) => poseAt(jumped, second).lon), [35, 35, 35.001]);
  assert.deepEqual(piecesOf(jumped).map(({ at }) => at), [[10, 40, 50]], "one place alone is no way");
  assert.deepEqual(piecesOf({ ...ROBOT, unseen: [2] }).map(({ path }) => path.length), [2, 2]);
  assert.deepEqual(piecesOf({ ...ROBOT, at: [], lon: [], lat: [] }), []);
  assert.equal(poseAt({ at: [7], lon: [35], lat: [30], heading: [4] }, 0).heading, 4);
});

test("several robots are seen together, each with its colour and name, until one is followed", () => {
  const late = { ...ROBOT, name: "b", at: [30, 40], lon: [35, 35.002], lat: [30, 30], heading: [0, 0], ...heard("lost", 40) };
  const never = { ...ROBOT, name: "c", at: [], lon: [], lat: [], heading: [], ...heard("waiting", null) };
  const data = { ...DAY, robots: [{ ...ROBOT, name: "a", ...heard("live") }, late, never], link: "live" };
  const drive = Object.assign(driving(50), { data, words: { robot_lost: "{name}: lost" }, lead: 0, following: false });
  assert.deepEqual(drive.labels().map(({ t }) => t).sort(), ["a", "b: lost"]);
  drive.second = 20; // what stands wrong now did not then, and one had not been heard yet
  assert.deepEqual(drive.labels().map(({ t }) => t), ["a"]);
  const [a, b] = piecesOf(late), tones = drive.parts().pieces.map(({ colours }) => colours);
  assert.deepEqual([a.path.length, b, tones.length], [2, undefined, 2]);
  assert.deepEqual([drive.leads(), drive.pitch()], [false, 0]);
  Object.assign(drive, { following: true, lead: 2 });
  assert.equal(drive.leads(), false, "nobody knows where it is");
  drive.lead = 1;
  assert.deepEqual([drive.leads(), drive.pose().lon], [true, 35]);
  drive.data = DAY;
  assert.deepEqual(drive.labels(), [], "one alone needs no name");
});

test("how robots stand is said of one, and of several of those that do not stand as they should", () => {
  const words = { live: "live, {seconds} s ago", lost: "lost {seconds}", lost_before: "lost before", held: "waits", ended: "over" };
  const robots = (...all) => ({ link: "live", robots: all.map((one, k) => ({ name: `r${k}`, ...one })) });
  assert.deepEqual(standingOf(robots(heard("live", 1.4)), words), ["live", "live, 1 s ago"]);
  assert.deepEqual(standingOf(robots(heard("lost", null)), words), ["lost", "lost before"]);
  assert.deepEqual(standingOf(robots(heard("live"), heard("held")), words), ["live", ""]);
  assert.deepEqual(standingOf(robots(heard("live"), heard("lost", 9)), words), ["lost", "r1: lost 9"]);
  assert.deepEqual(standingOf({ link: "ended", robots: [] }, words), ["ended", "over"]);
});

test("what is over is counted by its second", () => {
  assert.deepEqual([0, 39.9, 40, 49, 50, 99].map((second) => until(DAY.stops, second)), [0, 0, 1, 1, 2, 2]);
});

test("finds and chances are those of the second, forwards and backwards, and inspected plants stay so", () => {
  const drive = driving(0);
  const ranks = (second) => { drive.second = second; return [...drive.of([PLANTS])[0].ranks]; };
  assert.deepEqual(ranks(0), [1, 1, 1]);
  assert.deepEqual(ranks(40), [3, 3, 5]);
  assert.deepEqual(ranks(50), [4, 2, 5]);
  assert.deepEqual(ranks(45), [3, 3, 5]);
  assert.deepEqual([...PLANTS.ranks], [1, 1, 1]);
  assert.deepEqual(drive.of([PLANTS])[0].table.slice(4), [[0, 0, 255, 255], [255, 0, 0, 255]]);
});

test("the same moment is the same object, so that nothing is made twice", () => {
  const drive = driving(41), [first] = drive.of([PLANTS]);
  drive.second = 45;
  assert.equal(drive.of([PLANTS])[0], first);
});

test("who follows the robot stays near it in a window of another size, who let go of it stays where they are", () => {
  const drive = Object.assign(driving(10), { following: true, turning: true, bearing: 90 });
  const port = (width, zoom) => ({ width, height: 400, longitude: 35, latitude: 30, zoom, pitch: 0, bearing: 0 });
  assert.equal(drive.view(port(400, 16), [200, 100]).zoom, 20.5);
  assert.equal(drive.view(port(400, 19), [200, 100]).zoom, 19, "from then on as near as somebody wants");
  Object.assign(drive, { changed() {}, tell() {}, slider: {} }).take({ values: { end: 51 } });
  assert.equal(drive.view(port(400, 18), [200, 100]).zoom, 18, "though more of a live day comes every second");
  assert.equal(drive.isStale(port(300, 19)), true);
  drive.view(port(300, 19), [150, 100]);
  drive.following = false;
  assert.deepEqual([drive.leads(), drive.view(port(200, 19), [100, 100])], [false, null]);
});

test("only the nearest plants are drawn tall, and not too many", () => {
  const n = 500, lon = Float64Array.from({ length: n }, (_, k) => 35 + k * 1e-5), lat = new Float64Array(n).fill(30);
  const own = nearest({ n, lon, lat }, { lon: 35, lat: 30 }, 1500);
  assert.equal(own.length, 63); // 60 m at 0.963 m each
  assert.deepEqual(nearest({ n, lon, lat }, { lon: 35.002, lat: 30 }, 3).sort(), [199, 200, 201]);
});

test("where pictures take long there are fewer of them", () => {
  const drive = driving(0), drawn = (each) => {
    Object.assign(drive, { cost: 0, draws: undefined });
    let count = 0;
    for (let now = 0; now < 3000; now += each) {
      if (drive.mayDraw(now, each)) { count += 1; drive.draws = now; }
    }
    return count;
  };
  assert.equal(drawn(20), 150);
  assert.ok(drawn(100) <= 16);
});

test("more of a day that is driven now is taken in, and who looked at its end still does", () => {
  const told = [], drive = Object.assign(driving(50), { slider: {}, changed: () => told.push(drive.second), tell() {} });
  const first = drive.data, poses = { at: [0, 60], lon: [35, 35], lat: [30, 30], heading: [0, 90] };
  const lists = Object.fromEntries(Object.entries(poses).map(([name, all]) => [`robots.0.${name}`, [0, all]]));
  drive.take({ number: 7, lists: { ...lists, stops: [1, [[50, 0, false, 0], [60, 1, true, 0]]] }, values: { end: 60 } });
  assert.deepEqual(drive.data.stops, [[40, 2, true, 0], [50, 0, false, 0], [60, 1, true, 0]]);
  assert.deepEqual([drive.data.robots[0].at, drive.data.number, first.stops.length], [[0, 60], 7, 2]);
  assert.deepEqual([drive.second, drive.slider.max, told], [60, 60, [60]]);
  drive.second = 20; // somebody looks back
  drive.take({ values: { end: 70 } });
  assert.equal(drive.second, 20);
  // how long ago it was heard is no reason to draw
  drive.take({ number: 9, values: { "robots.0.heard.lag": 1.5 } });
  assert.deepEqual([told.length, drive.data.number, drive.data.robots[0].heard.lag], [2, 9, 1.5]);
  assert.deepEqual([...drive.of([PLANTS])[0].ranks], [1, 1, 1]);
});

test("a day that is driven now is asked for until another one is shown", async () => {
  const drive = driving(50), asked = [];
  Object.assign(drive, { slider: {}, changed() {}, tell() {}, take: (got) => asked.push(got) });
  globalThis.fetch = async (address) => ({ json: async () => ({ from: address }) });
  drive.ask("/one", true);
  await new Promise((done) => setTimeout(done));
  drive.ask(null, true);
  await new Promise((done) => setTimeout(done));
  assert.deepEqual(asked, [{ from: "/one" }]);
  drive.data = { ...DAY, number: 12 };
  drive.ask("/one", true);
  await new Promise((done) => setTimeout(done));
  drive.ask(null, true);
  assert.deepEqual(asked.pop(), { from: "/one?since=12" });
  globalThis.fetch = async () => { throw new Error("gone"); };
  drive.ask("/two", true);
  await new Promise((done) => setTimeout(done));
  drive.ask(null, true);
  assert.deepEqual(asked.at(-1), { number: null, values: { link: "away" } }, "the next time it asks for everything");
});

test("from picture to picture layers keep their data, or the whole way would be made anew each time", () => {
  const drive = driving(10), { pieces, finds } = drive.parts();
  drive.second = 39;
  assert.equal(drive.parts().pieces, pieces);
  assert.equal(drive.parts().finds, finds);
  drive.second = 45;
  assert.equal(drive.parts().pieces, pieces);
  assert.deepEqual(drive.parts().finds, [2]);
  drive.data = { ...DAY, robots: [{ ...ROBOT, way: [[35, 30], [35.001, 30], [35.001, 30.001]], released: 2 }] };
  assert.notEqual(drive.parts().pieces, pieces);
  assert.deepEqual(drive.parts().ordered.map((one) => one.path.length), [2, 2]);
  assert.deepEqual(orderedOf({ way: [[35, 30]], released: 1 }), []);
});

test("the robot's boxes are turned clockwise from north and grow", () => {
  const [a, b, , , c, d] = turned(90, 2); // what lies ahead comes to lie in the east
  assert.deepEqual([c, d, a, b].map((one) => Math.round(one)), [2, 0, 0, -2]);
});

test("what is new of a day is put where it belongs, of another robot too, and nothing else is made anew", () => {
  const before = { link: "live", stops: [], robots: [{ name: "a", at: [0, 1], unseen: [], heard: { standing: "live", lag: 0 } }] };
  const now = withNews(before, { number: 3, lists: { "robots.0.at": [1, [2, 3]], "robots.1.at": [0, [5]] },
    values: { link: "unheard", "robots.0.heard.standing": "lost", "robots.1.name": "b" } });
  assert.deepEqual(now.robots.map((one) => one.at), [[0, 2, 3], [5]]);
  assert.deepEqual([now.link, now.robots[0].heard, now.robots[1].name], ["unheard", { standing: "lost", lag: 0 }, "b"]);
  assert.equal(now.stops, before.stops);
  assert.deepEqual(withNews(now, { whole: true, lists: { "robots.0.at": [0, [7]] } }).robots, [{ at: [7] }], "another is gone");
  assert.deepEqual([before.robots.length, before.robots[0].at, before.robots[0].heard.standing], [1, [0, 1], "live"]);
});
