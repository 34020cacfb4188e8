// The way back: everything goes in by itself, in any order, as often as the network breaks.
// Only what the server says is on its disk is marked as such here.

import { asSent, base64 } from "./store.js";

const AT_ONCE = 100, PATIENCE_MS = 30000;

export class KeyEnded extends Error {}
/** What waits under the key of another person than the one who has the phone now. */
class Stranded extends Error {}

/** Whether two keys are the same person's: the season tells no names apart by their capitals. */
export const isOf = (people, one, other) => one === other || (people[one] !== undefined && people[one].toLowerCase() === people[other]?.toLowerCase());
export class NotNow extends Error {}
/** Another program holds the season: there is a network, and it may be tried again. */
export class Held extends NotNow {}

export class Sync {
  /** `ask` is fetch; `tell` hears how it goes. */
  constructor(store, ask = (...all) => fetch(...all), clock = () => new Date()) {
    this.store = store;
    this.ask = ask;
    this.clock = clock;
    this.stranded = new Map();
  }

  /**
   * Send what waits. Throws `KeyEnded`, or `NotNow` where it may be tried again. What cannot go as its person's
   * key was taken back, and another one has the phone, waits here: `stranded` has how much, by the persons' names.
   */
  async send() {
    this.people = (await this.store.get("people")) ?? {};
    const stranded = new Map();
    const records = await this.store.waiting("records");
    const seasons = new Map();
    for (const one of records) {
      const name = JSON.stringify([one.season, one.key]);
      seasons.set(name, [...(seasons.get(name) ?? []), one]);
    }
    let ended = null;
    for (const some of seasons.values()) {
      for (let k = 0; k < some.length; k += AT_ONCE) {
        const part = some.slice(k, k + AT_ONCE);
        ended = (await this.#unlessEnded(() => this.#records(part), stranded, part.length)) ?? ended;
      }
    }
    for (const { id } of await this.#photosWaiting()) {
      ended = (await this.#unlessEnded(() => this.#photo(id), stranded, 1)) ?? ended;
    }
    this.stranded = stranded;
    if (ended) throw ended;
  }

  // one season whose key was taken back does not hold up another
  async #unlessEnded(work, stranded, n) {
    try { await work(); } catch (error) {
      if (error instanceof KeyEnded) return error;
      if (!(error instanceof Stranded)) throw error;
      stranded.set(error.message, (stranded.get(error.message) ?? 0) + n);
    }
    return null;
  }

  // photos one by one: a day of them does not fit into a phone's memory twice
  async #photosWaiting() {
    const ids = await this.store.db.getAllKeysFromIndex("photos", "state", "waiting");
    return ids.map((id) => ({ id }));
  }

  async #records(some) {
    const body = JSON.stringify({ sent: this.clock().toISOString(), findings: some.map(asSent) });
    const answer = await this.#asked(some[0], "findings", { method: "POST", body, headers: { "content-type": "application/json" } });
    if (answer.ok) {
      const sent = new Set(some.map((one) => one.id));
      for (const one of answer.said.taken) if (sent.has(one.id)) await this.store.confirm(one.id, one.problem);
    } else if (some.length > 1) {
      // one that is refused must not hold up the others
      const half = some.length >> 1;
      await this.#records(some.slice(0, half));
      await this.#records(some.slice(half));
    } else {
      await this.store.refuse("records", some[0].id, answer.said.error);
    }
  }

  async #photo(id) {
    const photo = await this.store.db.get("photos", id);
    if (!photo) return;
    const about = new URLSearchParams({ finding: photo.finding, at: photo.at });
    for (const name of ["lon", "lat", "accuracy_m"]) if (photo[name] != null) about.set(name, photo[name]);
    const digest = base64(await crypto.subtle.digest("SHA-256", photo.bytes));
    const headers = { "content-type": photo.type, "content-digest": `sha-256=:${digest}:` };
    const answer = await this.#asked(photo, `photos/${id}?${about}`, { method: "PUT", body: photo.bytes, headers });
    if (answer.ok) {
      await this.store.confirmPhoto(id);
    } else {
      await this.store.refuse("photos", id, answer.said.error);
    }
  }

  /** Ask with the key by which a record was made, or with a newer one of the same person; never as another. */
  async #asked(one, path, request) {
    const now = (await this.store.access(one.season))?.key, isOwn = isOf(this.people, one.key, now);
    for (const key of new Set([one.key, isOwn ? now : one.key])) {
      const answer = await call(this.ask, { season: one.season, key }, path, request);
      if (answer.status !== 401) return answer;
    }
    throw isOwn ? new KeyEnded(one.season) : new Stranded(this.people[one.key] ?? "?");
  }
}

/** Ask something of a season; 2xx, 401 and lasting refusals are returned, all else is for later. */
export async function call(ask, access, path, request = {}) {
  const gone = new AbortController();
  const timer = setTimeout(() => gone.abort(), PATIENCE_MS);
  let answer, body;
  try {
    answer = await ask(`/api/v1/seasons/${encodeURIComponent(access.season)}/${path}`, {
      ...request, signal: gone.signal, credentials: "omit", cache: "no-store", referrerPolicy: "no-referrer",
      headers: { ...request.headers, authorization: `Bearer ${access.key}` },
    });
    // whole, or it is asked for again
    body = await answer.text();
  } catch (error) {
    throw new NotNow(error.message);
  } finally {
    clearTimeout(timer);
  }
  const { ok, status } = answer;
  let said;
  try { said = JSON.parse(body); } catch { // a proxy's own page is no answer of the season
    throw new NotNow(`${status}`);
  }
  if (!ok && ![401, 413, 422].includes(status)) throw said.cause === "held" ? new Held(said.error) : new NotNow(`${status}`);
  return { ok, status, said };
}

/** Bring the plot and the day; the plot only where it is another one. */
export async function fetchDay(ask, access, known, plan) {
  const query = new URLSearchParams({ ...(access.on && { on: access.on }), ...(plan && { plan }) }).toString();
  const answered = await call(ask, access, `day${query && `?${query}`}`);
  if (answered.status === 401) throw new KeyEnded(access.season);
  const day = answered.said;
  if (!answered.ok) throw new Error(day.error);
  let plot = null;
  if (known !== day.plot) {
    const answer = await call(ask, access, "plot");
    if (!answer.ok) throw new NotNow(`${answer.status}`);
    plot = answer.said;
  }
  return { day, plot };
}

/** Ask the full planner for the rest. */
export async function fetchRest(ask, access, on, secondsLeft) {
  const body = JSON.stringify({ on, seconds_left: Math.max(0, Math.min(86400, secondsLeft)) });
  const answer = await call(ask, access, "route", { method: "POST", body, headers: { "content-type": "application/json" } });
  if (answer.status === 401) throw new KeyEnded(access.season);
  if (!answer.ok) throw new Error(answer.said.error);
  return answer.said;
}
