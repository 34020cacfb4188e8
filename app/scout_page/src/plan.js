// The rest of the route on the phone: what comes next after a find, and what still fits the hours.

import { apart, metres, metresOut, neighbours, walkSeconds } from "./geo.js";

const legsSaid = new WeakMap();

/** Seconds that the plants ahead take from where one stands, the way back included; what the server said of a leg holds. */
export function secondsAhead(plot, day, at, ahead) {
  return secondsThrough(plot, day, at, ahead) + (ahead.length ? secondsBack(plot, day, ahead.at(-1)) : 0);
}

/** Seconds that plants in turn take from where one stands, without the way back. */
export function secondsThrough(plot, day, at, plants) {
  const leg = legs(plot, day);
  return plants.reduce((total, plant, k) => total + leg(k ? plants[k - 1] : at, plant) + day.robot.visit_s, 0);
}

/** Seconds of the way back from a plant: as the server said of its last one, else to where its line ends, or to the gate. */
function secondsBack(plot, day, plant) {
  const { plants, walk_s, end_s, line } = day.route, { returns, speed_m_s, visit_s } = day.robot;
  if (!returns) return 0;
  if (plant === plants.at(-1)) return Math.max(0, end_s - walk_s.reduce((a, b) => a + b, plants.length * visit_s));
  const gate = line.length ? metres(plot, line.at(-1)) : plot.gate;
  return gate ? metresOut(plot, plant, gate) / speed_m_s : 0;
}

/** Returns what tells the seconds of a way between two plants. */
function legs(plot, day) {
  if (!legsSaid.has(day.route)) {
    const said = new Map(), { plants, walk_s } = day.route;
    plants.forEach((plant, k) => said.set(`${k ? plants[k - 1] : -1} ${plant}`, walk_s[k]));
    legsSaid.set(day.route, said);
  }
  const said = legsSaid.get(day.route);
  return (a, b) => said.get(`${a} ${b}`) ?? walkSeconds(plot, day.robot, a, b);
}

/**
 * The plants ahead with those of which a photo is asked for, each where it is the least way round.
 * Where the hours do not do, what nobody asked for is left out at the end.
 */
export function withAsked(plot, day, at, ahead, asked, left) {
  const leg = legs(plot, day), all = [...ahead], wanted = new Set(asked);
  for (const plant of wanted) {
    if (all.includes(plant)) continue;
    let least = Infinity, place = 0;
    // where nobody knows where the way begins, it begins as it did
    for (let k = at < 0 && all.length ? 1 : 0; k <= all.length; k++) {
      const before = k ? all[k - 1] : at, after = all[k];
      const more = leg(before, plant) + (after === undefined ? 0 : leg(plant, after) - leg(before, after));
      if (more < least) { least = more; place = k; }
    }
    all.splice(place, 0, plant);
  }
  if (all.length === ahead.length) return all;
  const most = Math.max(left, secondsAhead(plot, day, at, ahead));
  while (secondsAhead(plot, day, at, all) > most) {
    const out = all.findLastIndex((plant) => !wanted.has(plant));
    if (out < 0) break;
    all.splice(out, 1);
  }
  return all;
}

/** What is left of the working day: so much was left at `begun`, or is until the first record. */
export const secondsLeft = (day, begun, now) => Math.max(0, day.seconds_left - (begun ? Math.max(0, now - begun) / 1000 : 0));

/**
 * The plants ahead after a find: its neighbours come next, the nearest first, as far as the hours
 * allow; what then no longer fits at the end is left out.
 */
export function afterFind(plot, day, ahead, plant, done, left) {
  const next = [];
  let here = plant, spent = 0;
  const open = new Set(neighbours(plot, plant).filter((one) => !done.has(one)));
  // the other face is in the same place, but round the row's end
  const far = (a, b) => (plot.face ? walkSeconds(plot, day.robot, a, b) : apart(plot, a, b));
  while (open.size) {
    const one = [...open].sort((a, b) => far(here, a) - far(here, b) || a - b)[0];
    open.delete(one);
    const cost = walkSeconds(plot, day.robot, here, one) + day.robot.visit_s;
    if (spent + cost + secondsBack(plot, day, one) > left) break;
    spent += cost;
    next.push(one);
    here = one;
  }
  const rest = [...next, ...ahead.filter((one) => !next.includes(one))];
  return fitting(plot, day, plant, rest, Math.max(left, spent), next.length);
}

/** As many of the plants ahead as fit with the way back, at least `least`. */
export function fitting(plot, day, at, ahead, left, least = 0) {
  const leg = legs(plot, day);
  let total = 0, here = at, fit = least;
  for (let k = 0; k < ahead.length; k++) {
    total += leg(here, ahead[k]) + day.robot.visit_s;
    here = ahead[k];
    if (total + secondsBack(plot, day, here) <= left) fit = Math.max(fit, k + 1);
  }
  return ahead.slice(0, fit);
}

/** Results that count, by plant: of this phone's records, the last one not taken back. */
export function results(records) {
  const gone = new Set(records.filter((one) => one.undoes).map((one) => one.undoes));
  const found = new Map();
  for (const one of records) if (!one.undoes && !gone.has(one.id)) found.set(one.plant, one);
  return found;
}
