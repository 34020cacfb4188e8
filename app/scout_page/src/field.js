// What a scout does in the field. A step is seen at once; it is said to be kept when it is on the phone's disk.

import { Clock } from "./clock.js";
import { laidOut, metres, neighbours, offered, rings, rowOf } from "./geo.js";
import { afterFind, fitting, results, secondsAhead, secondsLeft, secondsThrough, withAsked } from "./plan.js";
import { fetchDay, fetchRest, isOf } from "./sync.js";
import { wayAhead } from "./way.js";

const KEPT = ["season", "plot", "day", "ahead", "draft", "begun", "last", "saidBack"];
const EMPTY = { plot: null, day: null, ahead: [], draft: null, begun: null, last: null, saidBack: [] };
// a record that is on no disk yet
const WRITING = "writing";
// where one was longer ago is not where one is
const FRESH_MS = 60000;
// whose first plant is no more off the start than this has the hours from the start, as the season counts them
const LATE_MS = 300000;

const AS_TIME = { dateStyle: "short", timeStyle: "short" };

/** The date in a time zone, or in the phone's own where there is none or it is too new for the phone. */
function dateIn(zone, ms, how = {}) {
  try { return new Intl.DateTimeFormat("sv-SE", zone ? { ...how, timeZone: zone } : how).format(ms); } catch { return dateIn("", ms, how); }
}

const within = (at, [low, high]) => at >= low && at <= high;

// a plant that does not stand there any more: skipped, as every server knows; that it is gone says its note, and here the page itself
const GONE = { result: "skipped", gone: true };

/** The note of a plant that is gone, with what else was noted. */
const goneNote = (notes) => (notes ? `gone: ${notes}` : "gone");

/** Whether something of a plant is in hand that is not told yet. */
const isNoted = (draft) => Boolean(draft?.open || draft?.photos || draft?.notes);

/** What is noted and not told: of the plant in hand, or of the one before an undo. */
const inHand = (draft) => (isNoted(draft) ? draft : draft?.aside);

export class Field {
  #written = Promise.resolve();
  #failures = 0;
  #way = null;
  #fit = null;
  #pending = 0;
  #steps = 0;

  constructor(store, { ask = (...all) => fetch(...all), clock = () => new Date(), id = () => crypto.randomUUID(), time = new Clock(() => this.clock()) } = {}) {
    Object.assign(this, { store, ask: time.listening(ask), clock, id, time });
    this.coords = null;
    this.records = [];
    this.back = new Set();
    this.people = {};
    this.seasons = [];
  }

  /**
   * Take a step: it holds at once, and is on the disk when this resolves. Steps are written in their
   * order. Where one cannot be written, it is taken back, and those after it with it.
   */
  #step(changes, write, record = null) {
    const before = Object.fromEntries([...KEPT, "access"].map((name) => [name, this[name]]));
    const failures = this.#failures;
    Object.assign(this, changes);
    if (record) this.records = [...this.records, { ...record, state: WRITING }];
    this.#work();
    this.#pending += 1;
    this.#steps += 1;
    const written = this.#written.then(async () => {
      if (failures !== this.#failures) throw new Error("the step before it was not kept");
      try {
        await write();
      } catch (error) {
        this.#failures += 1;
        Object.assign(this, before, { records: this.records.filter((one) => one.state !== WRITING) });
        this.#work();
        throw error;
      }
      if (!record) return;
      this.records = this.records.map((one) => (one.id === record.id ? { ...one, state: "waiting" } : one));
      this.#work();
    }).finally(() => { this.#pending -= 1; });
    this.#written = written.catch(() => {});
    return written;
  }

  /** Resolves when nothing is being written. */
  async settled() {
    while (this.#pending) await this.#written;
  }

  /** Bring back what was there when the page was closed, or killed. */
  async open(access) {
    let kept, known, steps;
    do {
      steps = this.#steps;
      await this.settled();
      kept = await this.store.several([...KEPT, "people", "heard", "fast"]);
      known = kept.season ? await this.store.access(kept.season) : null;
    } while (this.#steps !== steps);
    const { people = {}, heard, fast, ...here } = kept;
    Object.assign(this, here, { people, access: known });
    this.time.knew(heard, fast);
    if (access) await this.#comes(access);
    await this.#begin();
  }

  /** Somebody has scanned a code. */
  async #comes(access) {
    const had = await this.store.access(access.season), now = this.season && await this.store.access(this.season);
    // a page that did not note yet whose key it was
    if (now && this.day && !this.people[now.key]) await this.#name(now.key, this.day.scout);
    if (access.season !== this.season) await this.#change(access.season);
    // the home screen of an iPhone says the same code whenever it is opened
    if (had?.key === access.key) return;
    await this.store.allow(access);
    // whose key it is is said as the day comes
    const noted = inHand(this.draft), draft = had && noted ? { ...noted, by: this.draft.by ?? had.key } : null;
    await this.#change(access.season, { plot: this.plot, draft });
  }

  async #begin() {
    const { season } = this, [access, seasons] = await Promise.all([season ? this.store.access(season) : null, this.store.seasons()]);
    if (this.season === season) this.access = access;
    this.seasons = seasons.sort();
    await this.reread();
    await this.#countPhotos();
  }

  #name(key, who) {
    this.people = { ...this.people, [key]: who };
    return this.store.put({ people: this.people });
  }

  /** Turn to another season of this phone; the day of this one stays as it is. */
  async turnTo(season) {
    await this.settled();
    try { if (season !== this.season) await this.#change(season); } finally { await this.#begin(); }
  }

  /** Go on with a season as it was left, or with what is given of it: all of it at once, whatever is tapped meanwhile. */
  async #change(season, given) {
    const [kept, access, records] = await Promise.all([given ?? this.store.get(`of ${season}`), this.store.access(season), this.store.records(season)]);
    await this.settled();
    const left = this.season ? { [`of ${this.season}`]: Object.fromEntries(Object.keys(EMPTY).map((name) => [name, this[name]])) } : {};
    const values = { ...EMPTY, ...kept, season };
    this.records = this.#ownOf(records, access);
    await this.#step({ ...values, access: access ?? null }, () => this.store.put({ ...left, ...values }));
  }

  /** A photo may be on the disk, and the page was killed before it was counted. */
  async #countPhotos() {
    if (!this.draft) return;
    const { id } = this.draft, photos = await this.store.drafts(id);
    if (this.draft?.id === id && photos !== (this.draft.photos ?? 0)) this.draft = { ...this.draft, photos };
  }

  async reread() {
    const { season, access } = this, before = new Set(this.records.filter((one) => one.state !== WRITING).map((one) => one.id));
    const all = season ? await this.store.records(season) : [];
    if (this.#hasTurned(season, access)) return;
    const kept = this.#ownOf(all, access), ids = new Set(kept.map((one) => one.id));
    // what was told while the disk was read
    const newer = this.records.filter((one) => one.season === this.season && one.key === this.access?.key && !ids.has(one.id) && !before.has(one.id));
    this.records = [...kept, ...newer];
    this.#work();
  }

  /** What another person told on this phone is not one's own. */
  #ownOf(records, access) { return records.filter((one) => isOf(this.people, one.key, access?.key)); }

  /** Whether another season, or another person's key, is here than there was. */
  #hasTurned(season, access) { return this.season !== season || this.access?.key !== access?.key; }

  /** What the network answers to this season's key; null where another is here by then: it is of no use to that. */
  async #hear(asking) {
    const { season, access } = this;
    const heard = access.season === season ? await asking(access) : null;
    await this.settled();
    return this.#hasTurned(season, access) ? null : heard;
  }

  /** Load plot, plants, route, chances and hot spots, while there is a network. */
  async load() {
    // a code made for a day ahead is of that day until it is over
    if (this.access.on && this.isOld()) await this.store.allow((this.access = { ...this.access, on: null }));
    const heard = await this.#hear((access) => fetchDay(this.ask, access, this.plot?.digest));
    if (!heard) return;
    const { day, plot } = heard, { season } = this;
    this.people = { ...this.people, [this.access.key]: day.scout };
    if (plot) this.plot = laidOut(plot, day.plot);
    const { begun, ...left } = this.#hours(day);
    this.#take({ ...day, ...left });
    this.begun = begun;
    this.last = null;
    this.ahead = this.#withAsked(day.route.plants);
    const by = this.draft?.by;
    if (by && !isOf(this.people, by, this.access.key)) this.draft = null;
    this.draft = { ...this.#keepDraft(), by: null };
    await this.#keep(...KEPT, "people");
    await this.store.tidy(season, day.day);
    await this.reread();
  }

  /** What is left of a day that is heard now, and since when that runs: null, from the first record on. */
  #hours(day) {
    if (day.begun) return { seconds_left: day.seconds_left, begun: this.time.best() };
    // the season has not heard yet that work began
    const isGoing = this.begun && day.live && this.day?.day === day.day && this.lastRecord();
    return isGoing ? { seconds_left: this.day.seconds_left, begun: this.begun } : { seconds_left: day.seconds_left, begun: null };
  }

  /** What is left of the hours here, and since when that runs: the route of a day before has them anew, from the first record of today on. */
  #hoursHere() {
    const { begun, day } = this;
    if (!this.isOld()) return { seconds_left: day.seconds_left, begun };
    return { seconds_left: 3600 * day.robot.hours, begun: begun && this.#dayAt(begun) === this.#today() ? begun : null };
  }

  /** When work begins with the record of a plant now: at the start, or with the way to it where that is much earlier or later. */
  #begins(plant) {
    const { begins, route, robot } = this.day, now = this.time.best(), start = Date.parse(begins ?? "");
    if (!start) return now; // a server of before
    const came = now - 1000 * ((plant === route.plants[0] ? route.walk_s[0] : 0) + robot.visit_s);
    return Math.abs(came - start) > LATE_MS ? came : start;
  }

  /** See what others found meanwhile; the way stays as it is. */
  async refresh() {
    if (!this.day) return;
    const { day } = (await this.#hear((access) => fetchDay(this.ask, access, this.day.plot, this.day.plan))) ?? {};
    if (!day || day.day !== this.day.day || day.plot !== this.day.plot) return;
    // a day that came ahead, or as today, is over once it is: it does not become the day meant
    const { route, plan, live, past } = this.day, { begun, ...left } = this.isOld() ? { seconds_left: this.day.seconds_left, begun: this.begun } : this.#hours(day);
    const asked = new Set(this.asked().map((one) => one.id));
    this.#take({ ...day, ...left, route, plan, live, past, newest: day.plan });
    this.begun = begun;
    const isNew = this.asked().some((one) => !asked.has(one.id)), { ahead, draft } = this;
    if (isNew) this.ahead = this.#withAsked(ahead);
    const isOut = (one) => this.done.has(one) || this.isUnwanted(one);
    if (this.ahead.some(isOut)) this.ahead = this.ahead.filter((one) => !isOut(one));
    // the plant in large print stays until there is a tap, whoever else was there: a finger may be on its way
    if (this.plant < 0 && this.ahead.length > 0) this.draft = this.#keepDraft();
    // what is as it was may be another in another window by now
    await this.#keep("day", "begun", ...(this.ahead === ahead ? [] : ["ahead"]), ...(this.draft === draft ? [] : ["draft"]));
  }

  /** Whether what was found or taken back here changes what the season says, which it did not say yet. */
  changedHere() {
    const { heard = 0, day } = this.day ?? {}, gone = this.#gone();
    return this.back.size > 0 || this.records.some((one) => one.day === day && one.result === "found" && one.state === "kept" && one.order > heard && !gone.has(one.id));
  }

  /** Whether another plan was given out since, as when somebody else's rows are to be done, too. */
  hasNewer() {
    const { plan, newest = plan } = this.day ?? {};
    return newest != null && newest !== plan;
  }

  /** Let the full planner plan the rest. */
  async planRest() {
    if (this.isOld()) return this.load(); // the rest of a day that is over is none of the next one
    const heard = await this.#hear((access) => fetchRest(this.ask, access, this.meant(), this.secondsLeft()));
    if (!heard) return;
    const { route, plan, others = this.day.others } = heard;
    this.day = { ...this.day, route, plan, others, newest: plan };
    this.ahead = this.#withAsked(route.plants);
    this.last = null;
    this.draft = this.#keepDraft();
    await this.#keep("day", "ahead", "draft", "last");
  }

  #take(day) {
    // what of this phone the season counts in what it says
    const heard = Math.max(0, ...this.records.filter((one) => one.state === "kept").map((one) => one.order));
    this.day = { ...day, heard, chance: Uint16Array.from(day.chance),
      spots: day.hot_spots.flatMap(rings).map((ring) => ring.map((at) => metres(this.plot, at))) };
    delete this.day.hot_spots;
    this.#work();
  }

  /** What is done, by this phone and by others. */
  #work() {
    const today = this.records.filter((one) => one.day === this.day?.day);
    const gone = this.#gone(), { heard = 0 } = this.day ?? {};
    this.own = results(today.filter((one) => !gone.has(one.id)));
    // taken back here, though what the season said last still says it
    const undone = new Map(today.filter((one) => one.undoes && one.order > heard).map((one) => [one.undoes, one]));
    this.back = new Set(today.filter((one) => undone.has(one.id) && !this.own.has(one.plant)).map((one) => one.plant));
    const said = (this.day?.today ?? []).map((one) => one.plant).filter((plant) => this.said(plant).length > 0);
    this.done = new Set([...this.own.keys(), ...said]);
  }

  /** What is said of a plant today, as far as this phone did not take it back since. */
  said(plant) { return this.#stand(this.day.today ?? [], plant); }

  /** Those of what is said of a plant that this phone did not take back since. */
  #stand(some, plant) {
    const name = this.day.scout?.toLowerCase(), isBack = this.back.has(plant);
    return some.filter((one) => one.plant === plant && !(isBack && one.who.toLowerCase() === name));
  }

  /** Plants of one's own rows, or that one told of, that are said to be both clean and found today, as far as this phone did not take it back since: `{plant, said}` each. */
  contradictions() {
    const all = this.day?.contradicting ?? [], plants = [...new Set(all.map((one) => one.plant))];
    const told = plants.filter((plant) => this.inRows(plant) || this.own.has(plant)).map((plant) => ({ plant, said: this.#stand(all, plant) }));
    return told.filter(({ said }) => new Set(said.map((one) => one.result)).size > 1);
  }

  // -- what somebody took back in the season

  #gone() { return new Set(this.day?.taken_back ?? []); }

  /** Records of this phone that count no more, as the season says, and of which nobody said yet what is to come of them. */
  takenBack() {
    const gone = this.#gone(), undone = new Set(this.records.map((one) => one.undoes).filter(Boolean));
    return this.records.filter((one) => gone.has(one.id) && !undone.has(one.id) && !one.answered);
  }

  /** Of days before, how many records count no more that nobody was told of yet: `{day, n}` each. */
  takenBackBefore() {
    const said = new Set(this.saidBack), days = Object.entries(this.day?.taken_back_before ?? {});
    return days.map(([day, ids]) => ({ day, n: ids.filter((one) => !said.has(one)).length })).filter(({ n }) => n);
  }

  /** That was read: it is not said again. */
  readTakenBack() {
    const saidBack = Object.values(this.day.taken_back_before ?? {}).flat();
    return this.#step({ saidBack }, () => this.store.put({ saidBack }));
  }

  /** Tell again what was taken back, or let it go. */
  async answer(again) {
    await this.settled();
    const some = this.takenBack(), order = this.#order();
    const told = some.map(({ answered, problem, ...one }, k) => ({ ...one, id: this.id(), order: order + k, retold: true }));
    await this.store.answer(some.map((one) => one.id), again ? told : []);
    await this.reread();
    this.saidBack = [...(this.saidBack ?? []), ...some.map((one) => one.id)]; // nor is it said on another day
    await this.#keep("saidBack");
    if (!this.ahead.some((one) => this.done.has(one))) return;
    this.ahead = this.ahead.filter((one) => !this.done.has(one));
    this.draft = this.#keepDraft();
    await this.#keep("ahead", "draft");
  }

  #keep(...names) {
    const values = Object.fromEntries(names.map((name) => [name, this[name] ?? null]));
    return this.#step({}, () => this.store.put({ ...values, ...this.time.known() }));
  }

  // -- photos asked for

  /** The photos asked for that are not taken yet, those of one plant if one is named. */
  asked(plant = null) {
    const taken = new Set([...this.own.values()].filter((one) => one.photos).map((one) => one.plant));
    return (this.day?.photos_asked ?? []).filter((one) => !taken.has(one.plant) && (plant === null || one.plant === plant));
  }

  /** The plants ahead, with those among them of which a photo is asked for; `back` is one that is taken back. */
  #withAsked(plants, back = -1) {
    const isOpen = (one) => one === back || !this.done.has(one), at = back < 0 ? this.lastRecord()?.plant ?? -1 : -1;
    return withAsked(this.plot, this.day, at, plants.filter(isOpen), this.asked().map((one) => one.plant).filter((one) => isOpen(one) && !this.closedUntil(one)), this.secondsLeft());
  }

  // -- the next plant

  get plant() { return this.draft?.plant ?? -1; }

  get offRoute() { return this.plant >= 0 && !this.ahead.includes(this.plant); }

  #fresh(ahead) { return { id: this.id(), plant: ahead[0] ?? -1, open: false, photos: 0 }; }

  /** What comes after the plant in hand: what was in hand before an undo, or the next of the way. */
  #comesNext(ahead) {
    const aside = this.draft?.aside;
    return aside ? { ...aside, chosen: aside.plant !== ahead[0] } : this.#fresh(ahead);
  }

  #keepDraft() { return this.draft?.chosen === true || isNoted(this.draft) ? this.draft : this.#comesNext(this.ahead); }

  /** Go to another plant than the next; whatever was noted goes along. */
  goTo(plant) {
    const had = this.draft ?? this.#fresh([]), { aside } = had;
    const one = aside?.plant === plant && !isNoted(had) ? aside : had;
    return this.note({ ...one, aside: one.aside, plant, chosen: plant !== this.ahead[0] });
  }

  /** Back to the route. */
  goBack() { return this.goTo(this.ahead[0] ?? -1); }

  /** Note something of the plant before saying what was found. */
  note(changes) {
    const draft = { ...this.draft, ...changes };
    return this.#step({ draft }, () => this.store.put({ draft }));
  }

  /** The plant that the position offers: within its accuracy, or none. */
  offered() { return this.plot ? offered(this.plot, this.position) : -1; }

  /** Whether one stands at the next plant, as far as the position tells. */
  isThere() {
    const at = this.position;
    if (!at || this.plant < 0) return false;
    return Math.hypot(this.plot.x[this.plant] - at.x, this.plot.y[this.plant] - at.y) <= at.accuracy;
  }

  metresAway() {
    const at = this.position;
    return at && this.plant >= 0 ? Math.hypot(this.plot.x[this.plant] - at.x, this.plot.y[this.plant] - at.y) : null;
  }

  /** The phone says where it is, or that it does not know: null. */
  moved(coords) { Object.assign(this, { coords, movedAt: this.#ticks() }); }

  /** Where one is on the plot, in metres, as long as that is fresh; else null. */
  get position() {
    if (!this.plot || !this.coords || this.#ticks().some((now, k) => now - this.movedAt[k] > FRESH_MS)) return null;
    const { longitude, latitude, accuracy } = this.coords, [x, y] = metres(this.plot, [longitude, latitude]);
    return { x, y, accuracy, lon: longitude, lat: latitude };
  }

  // asleep in a pocket, one of the two may stand still
  #ticks() { return [this.time.tick(), this.clock().getTime()]; }

  #where() {
    const at = this.position;
    return at ? { lon: at.lon, lat: at.lat, accuracy_m: at.accuracy } : {};
  }

  // -- telling

  #order() { return (this.records.at(-1)?.order ?? 0) + 1; }

  #common(id) {
    return { id, season: this.season, key: this.access.key, day: this.day.day, order: this.#order(),
      at: this.clock().toISOString(), on: this.meant(), ...this.#times() };
  }

  /** Whether a find can have the pests counted: a whole number from 1, or none is said. */
  isCountable() {
    const { count } = this.draft;
    return count == null || (Number.isInteger(count) && count >= 1);
  }

  /** The season's time as far as it is known now, and the least that it can be, for where the clock is wrong or will be. */
  #times() {
    const times = { known_at: this.time.sure(), after: this.time.least() }, heard = Object.entries(times).filter(([, ms]) => ms !== null);
    return Object.fromEntries(heard.map(([name, ms]) => [name, new Date(ms).toISOString()]));
  }

  /** Say what was found at the plant: the next one is there at once; resolves when it is on the disk. */
  tell(result) {
    const { id, plant, count, stage, leaves, notes, photos } = this.draft, isGone = result === "gone";
    if (plant < 0) return Promise.resolve();
    const of = result === "found" ? { count: count ?? null, stage: stage ?? "", leaves: leaves ?? null } : {};
    const record = { ...this.#common(id), ...this.#where(), plant, ...(isGone ? GONE : { result }), ...of, notes: isGone ? goneNote(notes) : notes ?? "", off_route: this.offRoute, photos: photos ?? 0,
      // of the route that one goes by; a server of before said none
      ...(this.day.route.detects == null ? {} : { detects: this.day.route.detects }) };
    // the hours of another day run by no clock
    const runs = this.meant() === null, begun = runs ? this.#hoursHere().begun ?? this.#begins(plant) : null;
    let ahead = this.ahead.filter((one) => one !== plant);
    if (result === "found") {
      const done = new Set([...this.done, plant]);
      // a neighbour that nobody may come to yet, that plans leave out or that is gone, is none to go to
      const out = neighbours(this.plot, plant).filter((one) => this.closedUntil(one) || this.isLeftOut(one) || this.isGone(one) || !this.isOwn(one));
      const fit = afterFind(this.plot, this.day, ahead, plant, new Set([...done, ...out]), this.#secondsLeft(begun, [plant]));
      // where the hours run by the clock `inHours` leaves out what does not fit them: another day has its own
      ahead = runs ? [...fit, ...ahead.filter((one) => !fit.includes(one))] : fit;
    }
    const follows = { ahead, begun, draft: this.#comesNext(ahead), last: { id, plant, ahead: this.ahead } };
    return this.#step(follows, () => this.store.record(record, { ...follows, ...this.time.known() }), record);
  }

  /** The last record that can be taken back, or undefined; one that was told again comes before those tapped. */
  lastRecord() {
    const gone = new Set([...this.records.map((one) => one.undoes).filter(Boolean), ...this.#gone()]);
    const stand = this.records.filter((one) => one.day === this.day?.day && !one.undoes && !gone.has(one.id));
    return stand.filter((one) => !one.retold).at(-1) ?? stand.at(-1);
  }

  /** Take the last record back; nothing is deleted, and what is in hand comes again after it. */
  undo() {
    const one = this.lastRecord();
    if (!one) return Promise.resolve();
    const record = { ...this.#common(this.id()), undoes: one.id };
    const ahead = this.#withAsked(this.last?.id === one.id ? this.last.ahead : [one.plant, ...this.ahead.filter((p) => p !== one.plant)], one.plant);
    const draft = { ...this.#fresh(ahead), plant: one.plant, chosen: one.plant !== ahead[0], aside: inHand(this.draft) };
    const follows = { ahead, draft, last: null };
    return this.#step(follows, () => this.store.record(record, follows), record);
  }

  /** Begin a photo of the plant: it belongs to this plant, though the next one may be there when it is ready. */
  photoOf() {
    return { id: this.id(), finding: this.draft.id, season: this.season, key: this.access.key,
      order: this.#order(), at: this.clock().toISOString(), ...this.#where() };
  }

  /** Keep a photo that was begun; it is on the disk before it is counted. */
  async addPhoto(photo, { bytes, type }) {
    await this.store.addPhoto({ ...photo, bytes, type });
    if (this.draft?.id === photo.finding) return this.note({ photos: (this.draft.photos ?? 0) + 1 });
    this.records = this.records.map((one) => (one.id === photo.finding ? { ...one, photos: (one.photos ?? 0) + 1 } : one));
    this.#work();
  }

  async dropPhotos() {
    await this.settled();
    await this.store.dropDraft(this.draft.id);
    await this.note({ photos: 0 });
  }

  // -- how far it is

  /** How many records are on no disk yet. */
  unwritten() { return this.records.filter((one) => one.state === WRITING).length; }

  /** How many plants are done and on the disk. */
  kept() { return [...this.own.values()].filter((one) => one.state !== WRITING).length; }

  /** How many plants are done of how many, and whether and how many of those ahead fit the hours: who is quick, or finds, has more. */
  progress() {
    const done = this.kept(), left = this.inHours().length, ahead = this.ahead.length;
    return { done, left, all: done + ahead, fits: left === ahead };
  }

  /** How many plants beside the last one are ahead since, as it was found. */
  added() {
    const { last } = this, one = this.lastRecord();
    if (!one || last?.id !== one.id) return 0;
    return neighbours(this.plot, one.plant).filter((each) => this.ahead.includes(each) && !last.ahead.includes(each)).length;
  }

  /** What is left of the hours: by the clock where they run, else by what the plants told since cost, as the season counts them. */
  secondsLeft() { return this.#secondsLeft(this.#hoursHere().begun); }

  /** Whether nobody plans for whose phone it is: not of the team, and without rows; a server of before says nothing of it. */
  hasNoRoute() { return this.day?.has_route === false; }

  #secondsLeft(begun, more = []) {
    if (this.hasNoRoute()) return 0;
    if (this.meant() === null) return secondsLeft(this.#hoursHere(), begun, this.time.best());
    const { heard = 0 } = this.day, told = [...this.own.values()].sort((a, b) => a.order - b.order);
    const known = told.findLast((one) => one.order <= heard)?.plant ?? -1;
    const since = told.filter((one) => one.order > heard).map((one) => one.plant);
    return Math.max(0, this.day.seconds_left - secondsThrough(this.plot, this.day, known, [...since, ...more]));
  }

  /** The plants ahead that still fit the hours where these run by the clock, as the app cuts its route; none is forgotten: a clock may be put right. */
  inHours() {
    if (this.meant() !== null || !this.#hoursHere().begun) return this.ahead;
    const { ahead } = this, fit = fitting(this.plot, this.day, this.lastRecord()?.plant ?? -1, ahead, this.secondsLeft());
    if (fit.length === ahead.length) return ahead;
    if (this.#fit?.of !== ahead || this.#fit.plants.length !== fit.length) this.#fit = { of: ahead, plants: fit };
    return this.#fit.plants;
  }

  /** The line ahead as it is gone within the hours, metres. */
  way() {
    const from = this.lastRecord()?.plant ?? -1, known = this.#way, ahead = this.inHours();
    if (known?.ahead !== ahead || known.from !== from || known.route !== this.day.route) {
      this.#way = { ahead, from, route: this.day.route, line: wayAhead(this.plot, this.day, from, ahead) };
    }
    return this.#way.line;
  }

  secondsAhead() { return secondsAhead(this.plot, this.day, this.lastRecord()?.plant ?? -1, this.inHours()); }

  /** What is known of plants, for the map. */
  known() {
    const shown = { found: new Set(this.day.found), clean: new Set(this.day.clean), skipped: new Set(), recorded: new Set(this.day.recorded) };
    for (const plant of this.back) {
      if (this.said(plant).length === 0) for (const kind of ["found", "clean"]) shown[kind].delete(plant);
    }
    for (const [plant, one] of this.own) {
      for (const kind of ["found", "clean", "skipped", ...(one.result === "found" ? ["recorded"] : [])]) shown[kind].delete(plant);
      shown[one.result].add(plant);
    }
    return shown;
  }

  #dayAt(ms) { return dateIn(this.plot.zone, ms); }

  #today() { return this.#dayAt(this.time.best()); }

  /** Rows that nobody may enter yet, with the local time until which that is so. */
  closed() {
    const now = dateIn(this.plot.zone, this.time.best(), AS_TIME).replace(" ", "T");
    return (this.day?.closed ?? []).filter((one) => one.until > now);
  }

  /** The local time until which nobody may come to a plant, or null. */
  closedUntil(plant) {
    const row = rowOf(this.plot, plant);
    // a day loaded from an earlier version says no plants
    const isIn = ({ rows, plants }) => (plants ? plants.some((run) => within(plant, run)) : within(row, rows));
    return this.closed().filter(isIn).map((one) => one.until).sort().at(-1) ?? null;
  }

  /** How many of one's own plants plans leave out, and why. */
  leftOut() {
    const own = (this.day?.unwanted ?? []).flatMap(([low, high]) => Array.from({ length: high - low + 1 }, (_, k) => low + k)).filter((one) => this.isOwn(one));
    return [...(this.day?.left_out ?? []), { why: "unwanted", own: own.length }].filter(({ own: n }) => n);
  }

  /** Whether plans leave a plant out: nobody could inspect it last time, it was found and only flagged, or it is not wanted today. */
  isLeftOut(plant) { return this.isUnwanted(plant) || (this.day?.left_out ?? []).some(({ plants }) => plants.some((run) => within(plant, run))); }

  /** Whether a plant is not to be inspected today, as was said in the app; a server of before says none. */
  isUnwanted(plant) { return (this.day?.unwanted ?? []).some((run) => within(plant, run)); }

  /** Whether a plant is in the rows of whose phone it is; who has none has all. */
  inRows(plant) { return !this.day?.rows || within(rowOf(this.plot, plant), this.day.rows); }

  /** Whether it is there and in no aisle that others have; a server of before says none. */
  isOwn(plant) { return this.inRows(plant) && !(this.day?.others ?? []).some((run) => within(plant, run)); }

  /** Whether a plant does not stand there any more, as the season says; a server of before says none. */
  isGone(plant) { return (this.day?.gone ?? []).includes(plant); }

  /** The day that is meant where it is not today: one ahead until it comes, and one that was over as it was loaded. */
  meant() {
    const { day, live, past = true } = this.day;
    if (live || this.#today() === day) return null;
    return past || this.#today() < day ? day : null;
  }

  /** Whether the route's day is over since it was loaded. */
  isOld() {
    return Boolean(this.day) && this.meant() === null && this.#today() > this.day.day;
  }
}
