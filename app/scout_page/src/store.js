// What the phone keeps: on its own disk before it is shown as kept, until the server has it on its disk.

import { openDB } from "idb";

export const WAITING = "waiting", KEPT = "kept", REFUSED = "refused", DRAFT = "draft";
// a relaxed write may be lost with the battery
const STRICT = { durability: "strict" };

export async function openStore(name = "fieldmon") {
  const db = await openDB(name, 1, {
    upgrade(made) {
      made.createObjectStore("kept");
      made.createObjectStore("access", { keyPath: "season" });
      for (const kind of ["records", "photos"]) {
        made.createObjectStore(kind, { keyPath: "id" }).createIndex("state", "state");
      }
    },
  });
  return new Store(db);
}

export class Store {
  constructor(db) { this.db = db; }

  get(name) { return this.db.get("kept", name); }

  /** Several values as they are at one moment, whatever another window writes. */
  async several(names) {
    const { store } = this.db.transaction("kept"), values = await Promise.all(names.map((name) => store.get(name)));
    return Object.fromEntries(names.map((name, k) => [name, values[k]]));
  }

  /** The language of the last code that said one: that of the page until somebody chooses another. */
  async languageOfCode(language) {
    if (language) await this.put({ language }).catch(() => {}); // a full phone speaks it now
    return language || this.get("language");
  }

  async put(values) {
    const change = this.db.transaction("kept", "readwrite", STRICT);
    for (const [name, value] of Object.entries(values)) change.store.put(value, name);
    await change.done;
  }

  /** Keep a record, its photos and what follows from it: all of it, or nothing. */
  async record(one, follows = {}) {
    const change = this.db.transaction(["records", "photos", "kept"], "readwrite", STRICT);
    const done = change.done;
    done.catch(() => {}); // said below
    const photos = change.objectStore("photos");
    let n = 0;
    for (let at = await photos.index("state").openCursor(DRAFT); at; at = await at.continue()) {
      if (at.value.finding === one.id) { n += 1; await at.update({ ...at.value, state: WAITING }); }
    }
    change.objectStore("records").add({ ...one, photos: n, state: WAITING });
    for (const [name, value] of Object.entries(follows)) change.objectStore("kept").put(value, name);
    await done;
  }

  records(season) {
    return this.db.getAll("records").then((all) => all.filter((one) => one.season === season)
      .sort((a, b) => a.order - b.order));
  }

  waiting(kind) {
    return this.db.getAllFromIndex(kind, "state", WAITING).then((all) => all.sort((a, b) => a.order - b.order));
  }

  /** How many records and photos the server does not have yet, and what it refused. */
  async left() {
    const [records, photos] = await Promise.all(["records", "photos"].map((kind) => this.db.countFromIndex(kind, "state", WAITING)));
    const refused = await Promise.all(["records", "photos"].map((kind) => this.db.getAllFromIndex(kind, "state", REFUSED)));
    const noted = (await this.db.getAllFromIndex("records", "state", KEPT)).filter((one) => one.problem);
    return { records, photos, refused: [...refused.flat(), ...noted] };
  }

  /** The server has a record on its disk. */
  async confirm(id, problem = "") {
    const change = this.db.transaction("records", "readwrite", STRICT), one = await change.store.get(id);
    if (one?.state === WAITING) await change.store.put({ ...one, state: KEPT, problem });
    await change.done;
  }

  /** The server has a photo on its disk: its bytes may go. */
  async confirmPhoto(id) { await this.db.delete("photos", id); }

  /** The server will never take this as it is: it stays here, and is shown. */
  async refuse(kind, id, problem) {
    const change = this.db.transaction(kind, "readwrite", STRICT), one = await change.store.get(id);
    if (one) await change.store.put({ ...one, state: REFUSED, problem });
    await change.done;
  }

  /** Let what was refused be sent again. */
  async again() {
    for (const kind of ["records", "photos"]) {
      const change = this.db.transaction(kind, "readwrite", STRICT);
      for (let at = await change.store.index("state").openCursor(REFUSED); at; at = await at.continue()) {
        await at.update({ ...at.value, state: WAITING, problem: "" });
      }
      await change.done;
    }
  }

  /** What the season took back is answered: told again as these records, or let go. All of it, or nothing. */
  async answer(ids, again = []) {
    const change = this.db.transaction("records", "readwrite", STRICT), done = change.done;
    done.catch(() => {}); // said below
    for (const id of ids) {
      const one = await change.store.get(id);
      if (one) change.store.put({ ...one, answered: true });
    }
    for (const one of again) change.store.add({ ...one, state: WAITING });
    await done;
  }

  /** Keep a photo; it waits at once where what it belongs to was told while it was made ready. */
  async addPhoto(photo) {
    const change = this.db.transaction(["records", "photos"], "readwrite", STRICT), done = change.done;
    done.catch(() => {}); // said below
    const records = change.objectStore("records"), told = await records.get(photo.finding);
    change.objectStore("photos").add({ ...photo, state: told ? WAITING : DRAFT });
    if (told) records.put({ ...told, photos: (told.photos ?? 0) + 1 });
    await done;
  }

  /** How many photos there are of what is not told yet. */
  async drafts(finding) {
    return (await this.db.getAllFromIndex("photos", "state", DRAFT)).filter((one) => one.finding === finding).length;
  }

  async dropDraft(finding) {
    const change = this.db.transaction("photos", "readwrite", STRICT);
    for (let at = await change.store.index("state").openCursor(DRAFT); at; at = await at.continue()) {
      if (at.value.finding === finding) await at.delete();
    }
    await change.done;
  }

  /** A new day has come: what the server has of other days may go from here. */
  async tidy(season, day) {
    const change = this.db.transaction("records", "readwrite", STRICT);
    for (let at = await change.store.index("state").openCursor(KEPT); at; at = await at.continue()) {
      if (at.value.season === season && at.value.day !== day) await at.delete();
    }
    await change.done;
  }

  /** The seasons that somebody scanned a code of. */
  seasons() { return this.db.getAllKeys("access"); }

  access(season) { return this.db.get("access", season); }
  async allow(access) { await this.db.put("access", access); }

  /** Everything that the server does not have, for a file: without the keys. `saved` is what the clock says, `Clock.said`. */
  async unsent(saved) {
    const all = await Promise.all(["records", "photos"].map((kind) => this.db.getAll(kind)));
    const [records, photos] = all.map((some) => some.filter((one) => one.state !== KEPT).sort((a, b) => a.order - b.order));
    const people = (await this.get("people")) ?? {}, of = (one) => ({ season: one.season, who: people[one.key] ?? "" });
    return {
      kind: "fieldmon findings",
      saved,
      findings: records.map((one) => ({ ...asSent(one), ...of(one) })),
      photos: photos.map(({ key, bytes, state, order, problem, ...one }) => ({ ...one, ...of({ key, ...one }), base64: base64(bytes) })),
    };
  }
}

const SENT = ["id", "at", "known_at", "plant", "result", "count", "stage", "leaves", "notes", "lon", "lat",
  "accuracy_m", "on", "after", "off_route", "undoes", "detects"];

/** A record as the interface describes a finding. */
export function asSent(record) {
  return Object.fromEntries(SENT.filter((name) => record[name] !== undefined).map((name) => [name, record[name]]));
}

export function base64(bytes) {
  let text = "";
  const all = new Uint8Array(bytes);
  for (let i = 0; i < all.length; i += 0x8000) text += String.fromCharCode(...all.subarray(i, i + 0x8000));
  return btoa(text);
}
