// What a scout does in the field. Every step is on the phone's disk before it is shown as done.

import { laidOut, metres, offered, rings } from "./geo.js";
import { afterFind, results, secondsAhead, secondsLeft } from "./plan.js";
import { fetchDay, fetchRest } from "./sync.js";

export class Field {
  constructor(store, { ask = (...all) => fetch(...all), clock = () => new Date(), id = () => crypto.randomUUID() } = {}) {
    Object.assign(this, { store, ask, clock, id });
    this.position = null;
  }

  /** Bring back what was there when the page was closed, or killed. */
  async open(access) {
    const names = ["season", "plot", "day", "ahead", "draft", "begun", "last"];
    const kept = await Promise.all(names.map((name) => this.store.get(name)));
    Object.assign(this, Object.fromEntries(names.map((name, k) => [name, kept[k]])));
    if (access) {
      await this.store.allow(access);
      if (access.season !== this.season) this.#empty(access.season);
    }
    this.access = this.season ? await this.store.access(this.season) : null;
    await this.reread();
  }

  #empty(season) {
    Object.assign(this, { season, plot: null, day: null, ahead: [], draft: null, begun: null, last: null });
  }

  async reread() {
    this.records = this.season ? await this.store.records(this.season) : [];
    this.#work();
  }

  /** Load plot, plants, route, chances and hot spots, while there is a network. */
  async load() {
    const { day, plot } = await fetchDay(this.ask, this.access, this.plot?.digest);
    if (plot) this.plot = laidOut(plot, day.plot);
    if (this.coords) this.moved(this.coords);
    this.#take(day);
    this.ahead = day.route.plants.filter((one) => !this.done.has(one));
    this.begun = null;
    this.last = null;
    this.draft = this.#keepDraft();
    await this.#keep("season", "plot", "day", "ahead", "draft", "begun", "last");
    await this.store.tidy(this.season, day.day);
    await this.reread();
  }

  /** See what others found meanwhile; the way stays as it is. */
  async refresh() {
    if (!this.day) return;
    const { day } = await fetchDay(this.ask, this.access, this.day.plot);
    if (day.day !== this.day.day || day.plot !== this.day.plot) return;
    const { route, seconds_left } = this.day;
    this.#take({ ...day, route, seconds_left });
    this.ahead = this.ahead.filter((one) => !this.done.has(one));
    this.draft = this.#keepDraft();
    await this.#keep("day", "ahead", "draft");
  }

  /** Let the full planner plan the rest. */
  async planRest() {
    const on = this.day.live ? null : this.day.day;
    const route = await fetchRest(this.ask, this.access, on, this.secondsLeft());
    this.day = { ...this.day, route };
    this.ahead = route.plants.filter((one) => !this.done.has(one));
    this.last = null;
    this.draft = this.#keepDraft();
    await this.#keep("day", "ahead", "draft", "last");
  }

  #take(day) {
    this.day = { ...day, chance: Uint16Array.from(day.chance),
      spots: day.hot_spots.flatMap(rings).map((ring) => ring.map((at) => metres(this.plot, at))) };
    delete this.day.hot_spots;
    this.#work();
  }

  /** What is done, by this phone and by others. */
  #work() {
    const today = this.records.filter((one) => one.day === this.day?.day);
    this.own = results(today);
    this.done = new Set([...this.own.keys(), ...(this.day?.today ?? []).map((one) => one.plant)]);
    // taken back here, though the server may still say it
    for (const one of today) {
      const gone = one.undoes && today.find((other) => other.id === one.undoes);
      if (gone && !this.own.has(gone.plant)) this.done.delete(gone.plant);
    }
  }

  #keep(...names) {
    return this.store.put(Object.fromEntries(names.map((name) => [name, this[name] ?? null])));
  }

  // -- the next plant

  get plant() { return this.draft?.plant ?? -1; }

  get offRoute() { return this.plant >= 0 && !this.ahead.includes(this.plant); }

  #fresh(ahead) { return { id: this.id(), plant: ahead[0] ?? -1, open: false, photos: 0 }; }

  #keepDraft() {
    const had = this.draft;
    if (!had || (had.chosen !== true && !had.open && !had.photos && !had.notes)) return this.#fresh(this.ahead);
    return had;
  }

  /** Go to another plant than the next; whatever was noted goes along. */
  async goTo(plant) {
    this.draft = { ...(this.draft ?? this.#fresh([])), plant, chosen: plant !== this.ahead[0] };
    await this.#keep("draft");
  }

  /** Back to the route. */
  goBack() { return this.goTo(this.ahead[0] ?? -1); }

  /** Note something of the plant before saying what was found. */
  async note(changes) {
    this.draft = { ...this.draft, ...changes };
    await this.#keep("draft");
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

  /** The phone says where it is; before there is a plot, that is kept for later. */
  moved(coords) {
    this.coords = coords;
    if (!this.plot) return;
    const { longitude, latitude, accuracy } = coords;
    const [x, y] = metres(this.plot, [longitude, latitude]);
    this.position = { x, y, accuracy, lon: longitude, lat: latitude };
  }

  #where() {
    const at = this.position;
    return at ? { lon: at.lon, lat: at.lat, accuracy_m: at.accuracy } : {};
  }

  // -- telling

  #order() { return (this.records.at(-1)?.order ?? 0) + 1; }

  #common(id) {
    return { id, season: this.season, key: this.access.key, day: this.day.day, order: this.#order(),
      at: this.clock().toISOString(), on: this.day.live ? null : this.day.day };
  }

  /** Say what was found at the plant; resolves once it is on the disk. */
  async tell(result) {
    const { id, plant, count, stage, leaves, notes } = this.draft;
    if (plant < 0) return;
    const of = result === "found" ? { count: count ?? null, stage: stage ?? "", leaves: leaves ?? null } : {};
    const record = { ...this.#common(id), ...this.#where(), plant, result, ...of, notes: notes ?? "", off_route: this.offRoute };
    const begun = this.begun ?? this.clock().getTime();
    let ahead = this.ahead.filter((one) => one !== plant);
    if (result === "found") {
      const done = new Set([...this.done, plant]);
      ahead = afterFind(this.plot, this.day, ahead, plant, done, secondsLeft(this.day, begun, this.clock().getTime()));
    }
    const follows = { ahead, begun, draft: this.#fresh(ahead), last: { id, plant, ahead: this.ahead } };
    await this.store.record(record, follows);
    Object.assign(this, follows);
    this.records.push({ ...record, state: "waiting" });
    this.#work();
  }

  /** The last record that can be taken back, or undefined. */
  lastRecord() {
    const gone = new Set(this.records.map((one) => one.undoes).filter(Boolean));
    return this.records.filter((one) => one.day === this.day?.day && !one.undoes && !gone.has(one.id)).at(-1);
  }

  /** Take the last record back; nothing is deleted. */
  async undo() {
    const one = this.lastRecord();
    if (!one) return;
    const record = { ...this.#common(this.id()), undoes: one.id };
    const ahead = this.last?.id === one.id ? this.last.ahead : [one.plant, ...this.ahead.filter((p) => p !== one.plant)];
    const draft = { ...this.#fresh(ahead), plant: one.plant, chosen: one.plant !== ahead[0] };
    const follows = { ahead, draft, last: null };
    await this.store.record(record, follows);
    Object.assign(this, follows);
    this.records.push({ ...record, state: "waiting" });
    this.#work();
  }

  async addPhoto({ bytes, type }) {
    const photo = { id: this.id(), finding: this.draft.id, season: this.season, key: this.access.key,
      order: this.#order(), at: this.clock().toISOString(), ...this.#where(), bytes, type };
    await this.store.addPhoto(photo);
    await this.note({ photos: (this.draft.photos ?? 0) + 1 });
  }

  async dropPhotos() {
    await this.store.dropDraft(this.draft.id);
    await this.note({ photos: 0 });
  }

  // -- how far it is

  secondsLeft() { return secondsLeft(this.day, this.begun, this.clock().getTime()); }

  secondsAhead() { return secondsAhead(this.plot, this.day, this.lastRecord()?.plant ?? -1, this.ahead); }

  /** What is known of plants, for the map. */
  known() {
    const shown = { found: new Set(this.day.found), clean: new Set(this.day.clean), skipped: new Set() };
    for (const [plant, one] of this.own) {
      for (const kind of ["found", "clean", "skipped"]) shown[kind].delete(plant);
      shown[one.result].add(plant);
    }
    return shown;
  }

  /** Whether the route is of another day than it is on the plot now. */
  isOld() {
    if (!this.day?.live) return false;
    const today = new Intl.DateTimeFormat("sv-SE", this.plot.zone ? { timeZone: this.plot.zone } : {}).format(this.clock());
    return today !== this.day.day;
  }
}

