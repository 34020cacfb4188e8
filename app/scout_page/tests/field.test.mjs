import "fake-indexeddb/auto";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Field } from "../src/field.js";
import { twinOf } from "../src/geo.js";
import { openStore } from "../src/store.js";
import { KeyEnded, NotNow, Sync } from "../src/sync.js";
import { aDay, ASeason, facedPlot } from "./scene.mjs";

let stores = 0;
const ACCESS = { season: "Gate", key: "k1", on: null };
const PICTURE = () => ({ bytes: Uint8Array.from({ length: 5000 }, (_, k) => (k * 7) % 256).buffer, type: "image/jpeg" });

async function aField(season = new ASeason(), access = ACCESS) {
  const name = `test ${stores++}`, store = await openStore(name);
  const options = { ask: season.ask, clock: () => new Date("2026-11-22T08:00:00Z") };
  const field = new Field(store, options);
  await field.open(access);
  await field.load();
  return { season, store, field, sync: new Sync(store, season.ask),
    again: async () => { const other = new Field(await openStore(name), options); await other.open(); return other; } };
}

test("what was tapped comes back after a kill", async () => {
  const { field, again } = await aField();
  assert.equal(field.plant, 0);
  await field.tell("clean");
  await field.note({ open: true, count: 4, stage: "adult", notes: "webs" });
  const other = await again();
  assert.equal(other.plant, 1);
  assert.deepEqual([other.draft.count, other.draft.stage, other.draft.notes, other.draft.open], [4, "adult", "webs", true]);
  assert.deepEqual(other.records.map((one) => [one.plant, one.result, one.state]), [[0, "clean", "waiting"]]);
  assert.deepEqual(other.ahead, [1, 2, 10, 11]);
});

test("what is told of one face is sent as of that face, and leaves the other as it was", async () => {
  const season = new ASeason(aDay([0, 1], { chance: Array(20).fill(20), recorded: [12, 17] }), facedPlot());
  const { field, sync, again } = await aField(season);
  await field.goTo(17);
  await field.tell("clean");
  const other = await again();
  await sync.send();
  assert.deepEqual([...season.taken.values()].map((one) => [one.plant, one.result]), [[17, "clean"]]);
  const { clean, recorded } = other.known();
  assert.deepEqual([[...clean], [...recorded], twinOf(other.plot, 17)], [[17], [12, 17], 12]);
  assert.deepEqual(other.plot.drawn, field.plot.drawn);
});

test("a plant that is gone is sent as skipped with the word for it, which servers of before know too", async () => {
  const { season, field, sync, again } = await aField();
  await field.tell("gone");
  await field.note({ notes: "rotten" });
  await field.tell("gone");
  assert.deepEqual(field.ahead, [2, 10, 11]);
  await sync.send();
  const sent = [...season.taken.values()];
  assert.deepEqual(sent.map((one) => [one.plant, one.result, one.notes]), [[0, "skipped", "gone"], [1, "skipped", "gone: rotten"]]);
  assert.equal(sent.some((one) => "gone" in one), false, "a server refuses what it does not know");
  const other = await again();
  assert.deepEqual([...other.known().skipped], [0, 1]);
  assert.equal(other.lastRecord().gone, true);
  await other.undo();
  assert.deepEqual([other.plant, [...other.known().skipped]], [1, [0]]);
});

test("after a find nobody is led to a neighbour that is gone", async () => {
  const left = async (gone) => {
    const { field } = await aField(new ASeason(aDay([0, 10], gone && { gone })));
    await field.tell("found");
    return field.ahead;
  };
  const all = await left();
  assert.ok(all.includes(1));
  assert.deepEqual(await left([1]), all.filter((one) => one !== 1));
});

test("after a find nobody is led out of the rows of their own, nor to what is not wanted today", async () => {
  const left = async (more) => {
    const { field } = await aField(new ASeason(aDay([5, 7], more)));
    await field.tell("found");
    return field.ahead;
  };
  const all = await left();
  assert.deepEqual([0, 6, 10].map((one) => all.includes(one)), [true, true, true]);
  assert.deepEqual((await left({ rows: [2, 3] })).filter((one) => one < 5), [], "row 1 is another's");
  assert.ok((await left({ rows: [2, 3] })).includes(10));
  assert.ok(!(await left({ unwanted: [[0, 4]] })).includes(0));
  assert.deepEqual((await left({ others: [[0, 4]] })).filter((one) => one < 5), [], "row 1 is another's of the team");
  assert.ok((await left({ others: [[0, 4]] })).includes(6));
});

test("what the office leaves out while one is out is left out of the way, and it is said how many these are", async () => {
  const { season, field } = await aField(new ASeason(aDay([0, 1, 2, 10, 11], { rows: [1, 1] })));
  season.day = { ...season.day, unwanted: [[1, 2], [10, 12]] };
  await field.refresh();
  assert.deepEqual(field.ahead, [0]);
  assert.deepEqual(field.leftOut(), [{ why: "unwanted", own: 2 }]);
  assert.equal(field.plant, 0);
});

test("what was taken back here is shown no more, though what the season said last still says it", async () => {
  const { season, field, sync } = await aField();
  await field.tell("found");
  await sync.send();
  season.day = aDay(undefined, { found: [0, 3], today: [{ plant: 0, result: "found", who: "Ann" }, { plant: 3, result: "found", who: "Ben" }] });
  await field.reread();
  await field.refresh();
  assert.deepEqual([field.said(0).length, field.back.size], [1, 0]);
  await field.undo();
  assert.deepEqual([field.said(0), field.done.has(0), [...field.back]], [[], false, [0]]);
  assert.deepEqual([...field.known().found], [3]);
  await sync.send();
  await field.reread();
  season.day = aDay();
  await field.refresh();
  assert.equal(field.back.size, 0, "the season says it itself");
});

test("a plant that two say otherwise of is named, until this phone takes its own back", async () => {
  const { season, field, sync } = await aField();
  await field.tell("found");
  await sync.send();
  const both = [{ plant: 0, result: "found", who: "Ann" }, { plant: 0, result: "clean", who: "Ben" }];
  season.day = aDay(undefined, { today: both, contradicting: both });
  await field.reread();
  assert.deepEqual(field.contradictions(), []);
  await field.refresh();
  assert.deepEqual(field.contradictions(), [{ plant: 0, said: both }]);
  await field.undo();
  assert.deepEqual(field.contradictions(), []);
});

test("who has rows of their own is told of plants there and of their own records, not of what others settle", async () => {
  const both = [0, 12].flatMap((plant) => [{ plant, result: "found", who: "Cem" }, { plant, result: "clean", who: "Ben" }]);
  const season = new ASeason(aDay([0, 1], { rows: [1, 1], others: [[0, 4]], today: both, contradicting: both }));
  const { field } = await aField(season);
  assert.deepEqual(field.contradictions().map(({ plant }) => plant), [0]);
  await field.goTo(12);
  await field.tell("clean");
  assert.deepEqual(field.contradictions().map(({ plant }) => plant), [0, 12]);
});

test("a find changes what the season says, until it said so; what is clean does not", async () => {
  const { field, sync } = await aField();
  const heard = async () => { await sync.send(); await field.reread(); return field.changedHere(); };
  await field.tell("clean");
  assert.equal(await heard(), false);
  await field.tell("found");
  assert.equal(field.changedHere(), false, "it is not sent yet");
  assert.equal(await heard(), true);
  await field.refresh();
  assert.equal(field.changedHere(), false);
  await field.undo();
  assert.equal(field.changedHere(), true);
});

test("records that somebody took back in the season are told by name, and told again or let go", async () => {
  for (const again of [true, false]) {
    const { season, store, field, sync } = await aField();
    await field.tell("found");
    await field.tell("clean");
    await sync.send();
    const ids = field.records.map((one) => one.id);
    season.day = aDay(undefined, { taken_back: ids.slice(0, 1) });
    await field.reread();
    await field.refresh();
    assert.deepEqual(field.takenBack().map((one) => one.plant), [0]);
    assert.deepEqual([field.kept(), field.done.has(0), field.known().found.has(0), field.lastRecord().plant], [1, false, false, 1]);
    await field.answer(again);
    assert.deepEqual([field.takenBack(), field.kept()], [[], again ? 2 : 1]);
    assert.equal(field.lastRecord().plant, 1, "what was tapped last is what can be taken back");
    await sync.send();
    const sent = [...season.taken.values()].map((one) => [one.plant, one.result, one.at]);
    assert.deepEqual(sent.slice(2), again ? [sent[0]] : []);
    assert.equal((await store.left()).records, 0);
    season.day = aDay(undefined, { taken_back: [] }); // the undo was taken back
    await field.refresh();
    assert.equal(field.kept(), 2);
  }
});

test("what was taken back of a day before is said once, and not where it was answered on its day", async () => {
  const { season, field, sync, again } = await aField();
  for (const result of ["found", "clean"]) await field.tell(result);
  await sync.send();
  const [first, second] = field.records.map((one) => one.id);
  season.day = aDay(undefined, { taken_back: [first] });
  await field.reread();
  await field.refresh();
  await field.answer(false);
  season.day = aDay(undefined, { day: "2026-11-23", live: false, past: false, taken_back_before: { "2026-11-22": [first, second] } });
  await field.load();
  assert.deepEqual(field.takenBackBefore(), [{ day: "2026-11-22", n: 1 }]);
  assert.deepEqual((await again()).takenBackBefore(), [{ day: "2026-11-22", n: 1 }], "until it was read");
  await field.readTakenBack();
  assert.deepEqual([field.takenBackBefore(), (await again()).takenBackBefore()], [[], []]);
  season.day = { ...season.day, taken_back_before: { "2026-11-21": ["old"], "2026-11-22": [first, second] } };
  await field.load();
  assert.deepEqual(field.takenBackBefore(), [{ day: "2026-11-21", n: 1 }]);
});

test("a find brings its neighbours, and undo brings back what was before", async () => {
  const { field, again } = await aField();
  await field.note({ open: true, count: 3, leaves: 5, stage: "egg" });
  await field.tell("found");
  assert.deepEqual(field.ahead, [1, 5, 2, 10, 11]);
  assert.deepEqual([field.added(), field.progress()], [1, { done: 1, left: 5, all: 6, fits: true }], "as many are left as before");
  assert.equal((await again()).added(), 1);
  assert.equal(field.records[0].count, 3);
  await field.undo();
  assert.deepEqual([field.ahead, field.added()], [[0, 1, 2, 10, 11], 0]);
  assert.equal(field.plant, 0);
  assert.equal(field.own.size, 0);
  assert.equal((await again()).records.length, 2, "nothing is deleted");
});

test("an undo keeps the photo and the note of the plant in hand: it comes again after the one taken back", async () => {
  const { season, field, sync, again } = await aField();
  await field.tell("clean");
  await field.addPhoto(field.photoOf(), PICTURE());
  await field.note({ notes: "webs" });
  const inHand = field.draft;
  await field.undo();
  await field.undo();
  assert.deepEqual([field.plant, field.draft.photos, field.draft.notes], [0, 0, undefined]);
  const other = await again();
  await other.goTo(1);
  assert.deepEqual([other.draft.id, other.draft.photos, other.draft.aside], [inHand.id, 1, undefined], "at once, where one goes to it");
  await field.tell("found");
  assert.deepEqual([field.plant, field.draft.id, field.draft.photos, field.draft.notes], [1, inHand.id, 1, "webs"]);
  await field.tell("clean");
  assert.deepEqual([field.plant, field.draft.photos], [5, 0]);
  await sync.send();
  assert.deepEqual([season.taken.get(inHand.id).plant, season.taken.get(inHand.id).notes, season.photos.size], [1, "webs", 1]);
});

test("a free find is off the route, and the route goes on", async () => {
  const { field } = await aField();
  await field.goTo(14);
  assert.ok(field.offRoute);
  await field.tell("found");
  assert.deepEqual([field.records[0].plant, field.records[0].off_route], [14, true]);
  assert.ok(field.ahead.includes(0) && field.ahead[0] === 13);
});

test("each record says what the route that one goes by finds, and none where the route says nothing", async () => {
  const day = aDay();
  day.route.detects = 0.3;
  const { season, field, sync } = await aField(new ASeason(day));
  await field.tell("clean");
  season.day = { ...day, plan: 9, route: { ...day.route, detects: 0.6 } };
  await field.refresh();
  await field.tell("clean");
  await field.undo();
  await sync.send();
  const said = [...season.taken.values()];
  assert.deepEqual(said.map((one) => one.detects), [0.3, 0.3, undefined]);
  const silent = await aField();
  await silent.field.tell("clean");
  await silent.sync.send();
  assert.ok(!("detects" in [...silent.season.taken.values()][0]));
});

test("all goes in once, byte for byte, and only then is forgotten", async () => {
  const { season, store, field, sync } = await aField();
  await field.addPhoto(field.photoOf(), PICTURE());
  await sync.send();
  assert.equal(season.photos.size, 0, "a photo of what is not said yet stays");
  await field.tell("found");
  await field.tell("clean");
  await field.undo();
  assert.deepEqual(await store.left().then(({ records, photos }) => [records, photos]), [3, 1]);
  await sync.send();
  await sync.send();
  assert.equal(season.taken.size, 3);
  const [bytes] = [...season.photos.values()];
  assert.deepEqual(Buffer.from(bytes), Buffer.from(PICTURE().bytes));
  assert.deepEqual(await store.left(), { records: 0, photos: 0, refused: [] });
  assert.equal(await store.db.count("photos"), 0);
});

test("however it breaks, nothing is lost and nothing is doubled", async () => {
  const { season, store, field, sync } = await aField();
  for (let k = 0; k < 4; k++) { await field.addPhoto(field.photoOf(), PICTURE()); await field.tell(k % 2 ? "clean" : "found"); }
  const kinds = ["before", "after", "half", 500, 502, 429, 200];
  for (let round = 0; round < 200; round++) {
    season.breaks = [...Array(round % 4).fill(null), kinds[round % kinds.length]];
    await sync.send().catch((error) => assert.ok(error instanceof NotNow, error));
    const left = await store.left();
    assert.equal(left.refused.length, 0);
    for (const one of await store.records("Gate")) assert.ok(one.state === "waiting" || season.taken.has(one.id));
    if (round % 20 === 0) { await field.reread(); await field.goTo(round % 15); await field.tell("clean"); }
  }
  season.breaks = [];
  await sync.send();
  const records = await store.records("Gate");
  assert.deepEqual([...season.taken.keys()].sort(), records.map((one) => one.id).sort());
  assert.equal(season.photos.size, 4);
});

test("one that is refused does not hold up the others, and is not thrown away", async () => {
  const { season, store, field, sync } = await aField();
  await field.tell("clean");
  await field.note({ notes: "poison" });
  await field.tell("clean");
  await field.tell("clean");
  await sync.send();
  assert.equal(season.taken.size, 2);
  const left = await store.left();
  assert.deepEqual(left.refused.map((one) => one.problem), ["not as described"]);
  assert.equal((await store.unsent()).findings.length, 1);
  await store.again();
  assert.equal((await store.left()).records, 1);
});

test("a key taken back keeps everything here until there is a new one", async () => {
  const { season, store, field, sync } = await aField();
  await field.addPhoto(field.photoOf(), PICTURE());
  await field.tell("found");
  season.keys = ["k2"];
  await assert.rejects(sync.send(), KeyEnded);
  assert.deepEqual(await store.left().then(({ records, photos }) => [records, photos]), [1, 1]);
  season.day = aDay([0, 1], { scout: "ann" });
  await field.open({ season: "Gate", key: "k2", on: null });
  await field.load();
  assert.equal(field.records.length, 1, "the same person's, as the season has it");
  await sync.send();
  assert.deepEqual([season.taken.size, season.photos.size, sync.stranded.size], [1, 1, 0]);
});

test("a new code of the same person keeps the photo and the note of the plant in hand, another person's does not show them", async () => {
  for (const [scout, inHand] of [["Ann", [1, "webs", 1]], ["Gil", [0, undefined, 0]]]) {
    const { season, store, field, again } = await aField();
    await field.tell("clean");
    await field.addPhoto(field.photoOf(), PICTURE());
    await field.note({ notes: "webs" });
    await field.undo();
    season.day = aDay([0, 1], { scout });
    await field.open({ season: "Gate", key: "k2", on: null });
    await field.load();
    for (const one of [field, await again()]) assert.deepEqual([one.plant, one.draft.notes, one.draft.photos], inHand);
    assert.deepEqual((await store.unsent()).photos.map((one) => one.who), ["Ann"], "whose it is stays known");
  }
});

test("another person's code brings another day, and what the first one told goes in as theirs or waits", async () => {
  const { season, store, field, sync } = await aField();
  await field.tell("clean");
  await field.addPhoto(field.photoOf(), PICTURE());
  await field.tell("found");
  season.day = aDay([7, 8], { scout: "Gil" });
  await field.open({ season: "Gate", key: "k2", on: null });
  assert.equal(field.day, null, "it is to be loaded");
  await field.load();
  assert.deepEqual([field.day.scout, field.records.length, field.lastRecord()], ["Gil", 0, undefined]);
  await field.tell("clean");
  season.keys = ["k2"];
  await sync.send();
  assert.deepEqual([[...season.taken.values()].map((one) => one.plant), [...sync.stranded]], [[7], [["Ann", 3]]]);
  assert.deepEqual(await store.left().then(({ records, photos }) => [records, photos]), [2, 1]);
  season.keys = ["k1", "k2"];
  await sync.send();
  assert.deepEqual([season.by.get("k1"), season.by.get("k2"), sync.stranded.size], [2, 1, 0]);
});

test("the language of a code stays when the page is opened again without it, until another code says one", async () => {
  const name = `test ${stores++}`, opened = async (said) => (await openStore(name)).languageOfCode(said);
  assert.deepEqual([await opened(null), await opened("he"), await opened(null), await opened("es"), await opened("")], [undefined, "he", "he", "es", "es"]);
  const full = await openStore(name);
  full.put = async () => { throw new Error("disk full"); };
  assert.equal(await full.languageOfCode("ar"), "ar");
});

test("the same code again, as an iPhone's home screen says it, changes nothing", async () => {
  const { season, field } = await aField(new ASeason(aDay([0, 1], { live: false, past: false, day: "2026-11-23" })), { ...ACCESS, on: "2026-11-23" });
  field.clock = () => new Date("2026-11-24T08:00:00Z");
  season.day = aDay([3, 4], { day: "2026-11-24" });
  await field.load();
  await field.open({ ...ACCESS, on: "2026-11-23" });
  assert.deepEqual([field.day.day, field.access.on], ["2026-11-24", null]);
});

test("a file of what is not sent says whose it is and of which season, and holds no key", async () => {
  const { store, field } = await aField();
  await field.addPhoto(field.photoOf(), PICTURE());
  await field.tell("found");
  const file = await store.unsent(field.time.said()), [one] = file.findings, [photo] = file.photos;
  assert.deepEqual(file.saved, { clock: "2026-11-22T08:00:00.000Z", time: "2026-11-22T08:00:00.000Z" });
  assert.deepEqual([file.kind, one.season, one.who, one.id], ["fieldmon findings", "Gate", "Ann", photo.finding]);
  assert.deepEqual([photo.season, photo.who, Buffer.from(photo.base64, "base64").length], ["Gate", "Ann", 5000]);
  assert.ok(!("key" in one) && !("key" in photo));
});

test("two seasons on one phone: each goes on where it was left", async () => {
  const { season, field, again } = await aField();
  await field.tell("clean");
  await field.note({ open: true, count: 2 });
  season.day = aDay([7, 8], { season: "Other", scout: "Bea" });
  await field.open({ season: "Other", key: "k9", on: null });
  await field.load();
  await field.tell("found");
  const other = await again();
  assert.deepEqual([other.season, other.seasons, other.records.length], ["Other", ["Gate", "Other"], 1]);
  await other.turnTo("Gate");
  assert.deepEqual([other.day.scout, other.plant, other.draft.count, other.access.key, other.records.length], ["Ann", 1, 2, "k1", 1]);
  await other.turnTo("Other");
  assert.deepEqual([other.day.scout, other.access.key, other.records[0].plant], ["Bea", "k9", 7]);
});

/** Two seasons on one plot, the first shown; what the network says of it comes when it is let go. */
async function twoSeasons() {
  const days = { Gate: aDay([0, 1, 2]), Other: aDay([7, 8], { season: "Other", scout: "Bea" }) };
  const { season, field, ...more } = await aField();
  await field.open({ season: "Other", key: "k9", on: null });
  season.day = days.Other;
  await field.load();
  await field.turnTo("Gate");
  let go;
  const gone = new Promise((done) => { go = done; }), ask = season.ask;
  field.ask = async (address, ...rest) => {
    const of = address.split("/")[4];
    if (of === "Gate") await gone;
    season.day = days[of];
    return ask(address, ...rest);
  };
  return { season, field, go, days, ...more };
}

for (const asking of ["load", "refresh", "planRest"]) {
  test(`what comes of a season after one turned to another is not that one's: ${asking}`, async () => {
    const { season, store, field, sync, go, days } = await twoSeasons();
    days.Gate = aDay([4, 5], { found: [3] });
    const asked = field[asking]();
    await field.turnTo("Other");
    go();
    await asked;
    assert.deepEqual([field.season, field.day.scout, field.day.found, field.ahead, field.access.key], ["Other", "Bea", [], [7, 8], "k9"]);
    assert.deepEqual([field.people, await store.get("people")], [{ k1: "Ann", k9: "Bea" }, { k1: "Ann", k9: "Bea" }]);
    await field.tell("clean");
    await sync.send();
    assert.deepEqual([...season.by], [["k9", 1]]);
    await field.turnTo("Gate");
    assert.deepEqual(field.ahead, [0, 1, 2, 10, 11], "and the other one is as it was left");
  });
}

test("a season is turned to whole: what is noted meanwhile is of one or of the other", async () => {
  const { field } = await twoSeasons(), noted = {}, of = { Gate: ["k1", "Ann"], Other: ["k9", "Bea"] };
  for (const season of ["Other", "Gate", "Other", "Gate"]) {
    const turned = field.turnTo(season);
    for (let k = 0; k < 12; k++) {
      assert.deepEqual([field.access.key, field.day.scout], of[field.season]);
      noted[field.season] = `${season} ${k}`;
      field.note({ notes: noted[field.season] });
      await new Promise((done) => setImmediate(done));
    }
    await turned;
    assert.deepEqual([field.season, field.draft.notes], [season, noted[season]]);
  }
});

test("what is noted in one window of the page is not undone by the news that another one hears", async () => {
  const { season, field, again } = await aField();
  const other = await again();
  await field.note({ notes: "webs", open: true, count: 12 });
  await other.refresh();
  const later = await again();
  assert.deepEqual([later.draft.notes, later.draft.count, later.plant], ["webs", 12, 0]);
  season.day = aDay([0, 1], { today: [{ plant: 10, result: "found", who: "Ben", count: null, second: 1 }] });
  await other.refresh();
  assert.deepEqual((await again()).ahead, [0, 1, 2, 11]);
});

test("what is noted and where one turns while a window reads the disk again is not lost", async () => {
  const { store, field } = await twoSeasons();
  for (let k = 0; k < 12; k++) {
    const opened = field.open(), to = field.season === "Gate" ? "Other" : "Gate";
    for (let n = 0; n < k; n++) await new Promise((done) => setImmediate(done));
    await field.note({ notes: `note ${k}` });
    await field.turnTo(to);
    await opened;
    assert.deepEqual([field.season, await store.get("season"), field.access.key], [to, to, to === "Gate" ? "k1" : "k9"]);
    const left = await store.get(`of ${to === "Gate" ? "Other" : "Gate"}`);
    assert.equal(left.draft.notes, `note ${k}`);
  }
});

test("what others found is seen, and not inspected twice; the way stays", async () => {
  const { season, field } = await aField();
  await field.tell("clean");
  season.day = aDay([7, 8], { today: [{ plant: 10, result: "found", who: "Ben", count: null, second: 1 }], found: [10] });
  await field.refresh();
  assert.deepEqual(field.ahead, [1, 2, 11]);
  assert.ok(field.known().found.has(10));
});

test("it tells by which plan it goes on as it sees what others found, until it loads another", async () => {
  const { season, field } = await aField();
  const asked = [], ask = season.ask;
  field.ask = (address, ...rest) => { asked.push(new URL(address, "http://here").searchParams.get("plan")); return ask(address, ...rest); };
  season.day = aDay([0, 1], { plan: 7 });
  await field.load();
  season.day = aDay([1, 2], { plan: 9 });
  await field.refresh();
  assert.deepEqual([field.day.plan, field.hasNewer()], [7, true]);
  await field.load();
  assert.equal(field.hasNewer(), false);
  await field.refresh();
  assert.equal(field.hasNewer(), false);
  assert.deepEqual(asked, [null, "7", null, "9"]);
});

test("the plant in large print stays when another records it: a tap is of what is shown", async () => {
  const { season, field } = await aField();
  season.day = aDay([1, 2], { today: [{ plant: 0, result: "clean", who: "Ben", count: null, second: 1 }], clean: [0] });
  await field.refresh();
  assert.equal(field.plant, 0);
  assert.deepEqual(field.ahead, [1, 2, 10, 11]);
  await field.goBack();
  assert.equal(field.plant, 1);
  await field.goTo(0);
  await field.tell("found");
  assert.deepEqual(field.records.map((one) => [one.plant, one.result]), [[0, "found"]]);
});

test("an undo brings back the way as it was, but for what others did since, and with the photos asked for since", async () => {
  const { season, field } = await aField();
  await field.tell("clean");
  season.day = aDay([7, 8], { today: [{ plant: 10, result: "clean", who: "Ben", count: null, second: 1 }],
    photos_asked: [{ id: "a2", plant: 12, note: "", who: "Office" }] });
  await field.refresh();
  await field.undo();
  assert.deepEqual([field.plant, field.ahead], [0, [0, 1, 2, 11, 12]]);
});

test("past midnight the rest is not planned of a day that is over: the next one is loaded", async () => {
  const { season, field } = await aField();
  field.clock = () => new Date("2026-11-22T22:30:00Z");
  season.day = aDay([3, 4], { day: "2026-11-23" });
  await field.planRest();
  assert.deepEqual([field.day.day, field.ahead, season.asked.filter((one) => one.endsWith("/route"))], ["2026-11-23", [3, 4], []]);
});

test("the full planner plans the rest when the network is there", async () => {
  const { field } = await aField();
  await field.planRest();
  assert.deepEqual([field.ahead, field.plant], [[14, 13], 14]);
});

test("rows that were sprayed are closed until their time on the plot", async () => {
  const season = new ASeason(aDay(undefined, { closed: [{ rows: [1, 2], until: "2026-11-22T10:01" }, { rows: [2, 3], until: "2026-11-22T10:00" }] }));
  const { field } = await aField(season);
  assert.deepEqual([0, 5, 10].map((plant) => field.closedUntil(plant)), ["2026-11-22T10:01", "2026-11-22T10:01", null]);
  assert.equal(field.closed().length, 1);
});

test("a find leads to no plant that plans leave out, and how many these are is said", async () => {
  const left_out = [{ why: "skipped", plants: [[5, 5], [12, 14]], own: 3 }, { why: "flagged", plants: [[1, 1]], own: 0 }];
  const { field } = await aField(new ASeason(aDay([0, 10, 11], { left_out })));
  assert.deepEqual([0, 1, 5, 6, 13].map((plant) => field.isLeftOut(plant)), [false, true, true, false, true]);
  await field.tell("found");
  assert.deepEqual(field.ahead, [10, 11]);
  assert.deepEqual(field.leftOut().map(({ why, own }) => [why, own]), [["skipped", 3]]);
  const old = await aField(new ASeason(aDay([0, 10, 11])));
  await old.field.tell("found");
  assert.deepEqual(old.field.ahead, [1, 5, 10, 11], "a server of before says nothing of them");
});

test("of rows that say their plants only these are closed, and neither a find nor a photo leads there", async () => {
  const asked = [{ id: "a1", plant: 6, note: "", who: "Office" }, { id: "a2", plant: 12, note: "", who: "Office" }];
  const closed = [{ rows: [2, 2], until: "2026-11-22T23:00", plants: [[5, 6]], own: 2 }];
  const { field } = await aField(new ASeason(aDay([0, 1], { closed, photos_asked: asked })));
  assert.deepEqual([5, 6, 7].map((plant) => field.closedUntil(plant) !== null), [true, true, false]);
  assert.deepEqual([field.ahead.includes(6), field.ahead.includes(12)], [false, true]);
  await field.tell("found");
  assert.equal(field.ahead.includes(5), false);
});

test("a time zone that is too new for the phone stops nothing: its own is taken", async () => {
  const { field } = await aField();
  field.plot.zone = "Europe/Too_New";
  assert.equal(field.isOld(), new Intl.DateTimeFormat("sv-SE").format(field.clock()) > "2026-11-22");
  await field.tell("clean");
  assert.equal(field.records.length, 1);
});

test("a route of yesterday is called so", async () => {
  const { field } = await aField();
  assert.equal(field.isOld(), false);
  field.clock = () => new Date("2026-11-22T22:30:00Z"); // past midnight on the plot
  assert.equal(field.isOld(), true);
});

test("a code for a day ahead is of that day until it is over, and with times on the day itself", async () => {
  const season = new ASeason(aDay([0, 1, 2], { day: "2026-11-23", live: false, past: false }));
  const { field } = await aField(season, { ...ACCESS, on: "2026-11-23" });
  await field.tell("clean"); // the evening before
  field.clock = () => new Date("2026-11-23T06:00:00Z");
  assert.deepEqual([field.meant(), field.isOld(), field.secondsLeft()], [null, false, 14400]);
  await field.tell("clean");
  field.clock = () => new Date("2026-11-24T06:00:00Z");
  assert.equal(field.isOld(), true);
  await field.tell("clean");
  assert.deepEqual(field.records.map((one) => one.on), ["2026-11-23", null, null]);
  season.day = aDay([3], { day: "2026-11-24" });
  await field.load();
  assert.ok(season.asked.at(-1).endsWith("/day"), "today's, whatever the code was made for");
  assert.equal(field.isOld(), false);
});

test("a code for a day ahead that is heard of after that day does not become the day meant", async () => {
  const ahead = aDay([0, 1, 2], { day: "2026-11-23", live: false, past: false });
  for (const loaded of ["2026-11-22T08:00:00Z", "2026-11-23T08:00:00Z"]) {
    const season = new ASeason(loaded < "2026-11-23" ? ahead : { ...ahead, live: true }), { field, again } = await aField(season, { ...ACCESS, on: "2026-11-23" });
    field.clock = () => new Date("2026-11-24T06:00:00Z");
    season.day = { ...ahead, past: true, found: [7] };
    await field.refresh();
    assert.ok(season.asked.at(-1).includes("on=2026-11-23"), "as the code was made for it");
    assert.deepEqual([field.day.found, field.isOld(), field.meant()], [[7], true, null]);
    await field.tell("clean");
    assert.deepEqual(field.records.map((one) => [one.on, one.at]), [[null, "2026-11-24T06:00:00.000Z"]]);
    const later = await again();
    later.clock = field.clock;
    assert.equal(later.isOld(), true);
    season.day = aDay([3], { day: "2026-11-24" });
    await later.load();
    assert.deepEqual([season.asked.at(-1).includes("on="), later.day.day, later.isOld()], [false, "2026-11-24", false]);
  }
});

test("without a network the next day goes on with the rest of the route, with hours of its own", async () => {
  const begun = { begins: "2026-11-22T04:00:00Z", begun: true, seconds_left: 200 };
  const { field, again } = await aField(new ASeason(aDay([0, 1, 2, 12, 13], begun)));
  field.clock = () => new Date("2026-11-22T08:10:00Z");
  await field.tell("found");
  assert.equal(field.inHours().length, 0, "the hours are over");
  const rest = field.ahead;
  assert.deepEqual(rest, [1, 2, 12, 13], "what did not fit is not forgotten");
  for (const one of [field, await again()]) {
    one.clock = () => new Date("2026-11-23T06:00:00Z");
    assert.deepEqual([one.isOld(), one.secondsLeft(), one.inHours(), one.way().length > 0, one.plant], [true, 14400, rest, true, 1]);
  }
  await field.tell("found");
  assert.deepEqual(field.ahead.filter((plant) => rest.includes(plant)).sort((a, b) => a - b), [2, 12, 13]);
  field.clock = () => new Date("2026-11-23T06:30:00Z");
  assert.equal(field.secondsLeft(), 14400 - 35 - 1800);
  assert.equal((await again()).begun, field.begun);
  await field.tell("clean");
  assert.deepEqual(field.records.map((one) => [one.on, one.at.slice(0, 10)]), [[null, "2026-11-22"], [null, "2026-11-23"], [null, "2026-11-23"]]);
  field.clock = () => new Date("2026-11-24T06:00:00Z");
  assert.equal(field.secondsLeft(), 14400, "and so on each further day");
});

test("the hours of a day loaded in mid-work run on by the clock, without a tap and over a kill", async () => {
  const season = new ASeason(aDay(undefined, { begins: "2026-11-22T04:00:00Z", begun: true, seconds_left: 2520 }));
  const { field, again } = await aField(season);
  for (const one of [field, await again()]) {
    one.clock = () => new Date("2026-11-22T08:30:00Z");
    assert.equal(one.secondsLeft(), 720);
  }
  season.day = aDay(undefined, { begins: "2026-11-22T04:00:00Z", begun: true, seconds_left: 660 });
  await field.refresh();
  assert.equal(field.secondsLeft(), 660, "as the season counts them");
});

test("hours begin at the start, or with the way to a first plant that is more than minutes off it", async () => {
  for (const [begins, left] of [["2026-11-22T07:56:00Z", 14160], ["2026-11-22T08:04:00Z", 14400], ["2026-11-22T07:50:00Z", 14363], [undefined, 14400]]) {
    const season = new ASeason(aDay(undefined, { begins, begun: false })), { field } = await aField(season);
    await field.tell("clean");
    assert.equal(field.secondsLeft(), left);
    field.clock = () => new Date("2026-11-22T08:30:00Z");
    const counted = field.secondsLeft();
    await field.load();
    await field.refresh();
    assert.equal(field.secondsLeft(), counted, "the season has not heard of it yet");
    await field.undo();
    await field.load();
    assert.equal(field.secondsLeft(), 14400);
  }
});

test("the hours of a day that is over are what its plants cost, whatever the clock says", async () => {
  const season = new ASeason(aDay([0, 1, 2], { day: "2026-11-01", live: false, past: true }));
  const { field, sync, again } = await aField(season, { ...ACCESS, on: "2026-11-01" });
  await field.tell("clean");
  await field.tell("clean");
  for (const one of [field, await again()]) {
    one.clock = () => new Date("2026-11-22T11:00:00Z");
    assert.equal(one.secondsLeft(), 14400 - 2 * 37);
  }
  await field.undo();
  assert.equal(field.secondsLeft(), 14400 - 37);
  await sync.send();
  await field.reread();
  season.day = { ...season.day, seconds_left: 14000 };
  await field.refresh();
  assert.equal(field.secondsLeft(), 14000, "as the season counts them");
  await field.tell("clean");
  assert.equal(field.secondsLeft(), 14000 - 37);
});

test("a day that was over when it was loaded stays the day meant", async () => {
  const season = new ASeason(aDay([0, 1, 2], { day: "2026-11-01", live: false, past: true }));
  const { field } = await aField(season, { ...ACCESS, on: "2026-11-01" });
  await field.tell("clean");
  assert.deepEqual([field.records[0].on, field.isOld()], ["2026-11-01", false]);
  await field.load();
  assert.ok(season.asked.at(-1).endsWith("?on=2026-11-01"));
});

test("each record says the least that the time can be, over a kill too", async () => {
  const { season, store, field, sync, again } = await aField();
  await field.tell("clean");
  assert.equal("after" in field.records[0], false, "nothing was heard");
  season.date = "Sun, 22 Nov 2026 08:00:00 GMT";
  await field.refresh();
  await field.tell("clean");
  const other = await again();
  other.clock = () => new Date("1970-01-01T00:00:09Z");
  assert.equal(other.time.isWrong(), true);
  await other.tell("clean");
  await sync.send();
  const [, second, third] = [...season.taken.values()];
  assert.ok(second.after >= "2026-11-22T08:00:00" && third.after >= second.after, `${second.after} ${third.after}`);
  assert.equal(third.at, "1970-01-01T00:00:09.000Z");
  assert.equal((await store.left()).records, 0);
});

test("each record says the season's time where the phone knows it: heard since it was opened, by a clock not set back since", async () => {
  const { season, field, sync, again } = await aField();
  season.date = "Sun, 22 Nov 2026 08:00:00 GMT";
  field.clock = () => new Date("2026-11-22T17:00:00Z");
  await field.tell("clean");
  await field.refresh();
  await field.tell("clean");
  field.clock = () => new Date("2026-11-22T16:00:00Z");
  await field.tell("clean");
  const other = await again();
  other.clock = () => new Date("2026-11-22T18:00:00Z");
  await other.tell("clean");
  await sync.send();
  const said = [...season.taken.values()].map((one) => one.known_at?.slice(0, 16));
  assert.deepEqual(said, [undefined, "2026-11-22T08:00", undefined, undefined]);
});

test("another season on the same phone does not mix with the first, whose records still go in", async () => {
  const { season, store, field, sync } = await aField();
  await field.tell("clean");
  await field.open({ season: "Other", key: "k9", on: null });
  assert.deepEqual([field.day, field.records.length], [null, 0]);
  await sync.send();
  assert.equal(season.taken.size, 1);
  assert.ok(season.asked.at(-1).includes("/Gate/"));
});

/** A disk that writes when it is told to, or not at all. */
function held(store) {
  const waiting = [], write = store.record.bind(store);
  store.record = (...all) => new Promise((done, failed) => {
    waiting.push({ go: () => write(...all).then(done, failed), fail: () => failed(new Error("disk full")) });
  });
  const turn = () => new Promise((done) => setTimeout(done));
  return { go: async () => { await turn(); waiting.shift().go(); }, fail: async () => { await turn(); waiting.shift().fail(); }, waiting };
}

test("the next plant is there at once; a tap counts as done when it is on the disk", async () => {
  const { store, field, again } = await aField();
  const disk = held(store), told = field.tell("clean");
  assert.deepEqual([field.plant, field.ahead, field.kept(), field.unwritten()], [1, [1, 2, 10, 11], 0, 1]);
  const killed = await again();
  assert.deepEqual([killed.plant, killed.records.length], [0, 0], "killed now, the plant is asked for again");
  await disk.go();
  await told;
  assert.deepEqual([field.kept(), field.unwritten()], [1, 0]);
  const later = await again();
  assert.deepEqual([later.plant, later.records.length], [1, 1]);
});

test("what cannot be written is taken back, and what was tapped after it too", async () => {
  const { store, field, again } = await aField();
  const disk = held(store);
  await field.note({ notes: "webs" });
  const told = ["clean", "found", "clean"].map((result) => field.tell(result));
  assert.equal(field.unwritten(), 3);
  await disk.go();
  await told[0];
  await disk.fail();
  await assert.rejects(told[1], /disk full/);
  await assert.rejects(told[2], /not kept/);
  assert.equal(disk.waiting.length, 0, "nothing follows what is not there");
  assert.deepEqual([field.plant, field.kept(), field.unwritten(), field.ahead], [1, 1, 0, [1, 2, 10, 11]]);
  const other = await again();
  assert.deepEqual([other.plant, other.records.map((one) => one.notes), other.ahead], [1, ["webs"], [1, 2, 10, 11]]);
  const last = field.tell("clean");
  await disk.go();
  await last;
  assert.equal((await again()).records.length, 2, "the next tap is kept as ever");
});

test("a position counts as long as it is fresh: where one was before a sleep is not where one is", async () => {
  const { field } = await aField();
  field.moved({ longitude: 35, latitude: 30, accuracy: 4 });
  assert.ok(field.position.accuracy === 4 && field.isThere());
  field.clock = () => new Date("2026-11-22T08:01:30Z");
  assert.deepEqual([field.position, field.isThere(), field.metresAway(), field.offered()], [null, false, null, -1]);
  await field.tell("clean");
  assert.equal(field.records.at(-1).lon, undefined);
  field.moved({ longitude: 35, latitude: 30, accuracy: 4 });
  await field.tell("clean");
  assert.ok(Math.abs(field.records.at(-1).lon - 35) < 1e-9);
  field.moved(null);
  assert.equal(field.position, null);
});

test("a photo belongs to its plant though the next one was there before it was ready", async () => {
  const { season, store, field, sync } = await aField();
  const begun = field.photoOf(), finding = field.draft.id;
  await field.tell("found");
  await field.addPhoto(begun, PICTURE());
  assert.equal(field.draft.photos, 0, "not to the next one");
  assert.equal((await store.db.getAll("photos"))[0].finding, finding);
  await sync.send();
  assert.equal(season.photos.size, 1, "and it does not wait for ever");
  await field.reread();
  assert.equal(field.records[0].photos, 1);
});

test("a photo that was kept is counted though the page was killed before it was", async () => {
  const { store, field, again } = await aField();
  await store.addPhoto({ ...field.photoOf(), ...PICTURE() });
  assert.equal((await again()).draft.photos, 1);
});

test("reading the disk again loses nothing that is being written", async () => {
  const { store, field } = await aField();
  const disk = held(store), told = field.tell("clean");
  await field.reread();
  assert.deepEqual([field.unwritten(), field.plant], [1, 1]);
  const reading = field.reread();
  await disk.go();
  await Promise.all([told, reading]);
  assert.deepEqual([field.kept(), field.records.length], [1, 1]);
});

test("a photo asked for is on the way, is ticked off by a photo, and asked for again after an undo", async () => {
  const asked = [{ id: "a1", plant: 6, note: "webs?", who: "Office" }];
  const season = new ASeason(aDay([0, 1, 2], { photos_asked: asked }));
  const { field, again } = await aField(season);
  assert.deepEqual([...field.ahead].sort(), [0, 1, 2, 6]);
  await field.goTo(6);
  assert.deepEqual(field.asked(6).map((one) => one.note), ["webs?"]);
  await field.tell("clean");
  assert.equal(field.asked().length, 1, "without a photo it stays asked for");
  await field.undo();
  await field.addPhoto(field.photoOf(), PICTURE());
  await field.tell("clean");
  assert.equal(field.asked().length, 0);
  assert.equal((await again()).asked().length, 0);
  await field.undo();
  assert.equal(field.asked().length, 1);
});

test("a photo asked for while one is out comes on the way with the network", async () => {
  const { season, field } = await aField();
  season.day = aDay([7, 8], { photos_asked: [{ id: "a2", plant: 12, note: "", who: "Office" }] });
  await field.refresh();
  assert.ok(field.ahead.includes(12));
  const ahead = field.ahead;
  await field.refresh();
  assert.deepEqual(field.ahead, ahead, "once");
});

test("finds of records alone are apart on the map until one is found here; a server of before says none", async () => {
  const { season, field } = await aField(new ASeason(aDay(undefined, { found: [4], recorded: [0, 1, 7] })));
  assert.deepEqual([[...field.known().found], [...field.known().recorded]], [[4], [0, 1, 7]]);
  await field.tell("found");
  await field.tell("clean");
  assert.deepEqual([[...field.known().found], [...field.known().recorded]], [[4, 0], [1, 7]]);
  season.day = aDay();
  await field.refresh();
  assert.deepEqual([...field.known().recorded], []);
});

test("what no longer fits the hours that run is not ahead on a phone that idles, and is again where its clock is put right", async () => {
  const day = aDay(undefined, { begins: "2026-11-22T04:00:00Z", begun: true, seconds_left: 600 }), { field } = await aField(new ASeason(day));
  const at = (clock) => { field.clock = () => new Date(`2026-11-22T${clock}Z`); return field.inHours(); };
  assert.equal(field.inHours(), field.ahead);
  const left = at("08:08:00"); // two minutes
  assert.deepEqual([left, field.inHours()], [[0, 1, 2], left]);
  assert.deepEqual(field.progress(), { done: 0, left: 3, all: 5, fits: false });
  assert.equal(at("08:08:01"), left, "the same way is not laid anew each second");
  assert.deepEqual([at("08:11:00"), field.plant], [[], 0]);
  assert.equal(at("08:00:00"), field.ahead);
});

test("who is not of the team and without rows has no hours, and is led to no neighbour of a find", async () => {
  const { field } = await aField(new ASeason(aDay([], { has_route: false })));
  assert.deepEqual([field.hasNoRoute(), field.secondsLeft()], [true, 0]);
  await field.goTo(7);
  await field.tell("found");
  assert.deepEqual([field.ahead, field.plant, field.own.size], [[], -1, 1]);
  assert.equal((await aField()).field.hasNoRoute(), false, "a server of before says nothing of it");
});
