// The rest of the route on the phone: what comes next after a find, and what still fits the hours.

import { apart, neighbours, walkSeconds } from "./geo.js";

/** Seconds that the plants ahead take from where one stands; what the server said of a leg holds. */
export function secondsAhead(plot, day, at, ahead) {
  const said = legs(day);
  let total = 0, here = at;
  for (const plant of ahead) {
    total += (said.get(`${here} ${plant}`) ?? walkSeconds(plot, day.robot, here, plant)) + day.robot.visit_s;
    here = plant;
  }
  return total;
}

function legs(day) {
  const said = new Map(), { plants, walk_s } = day.route;
  plants.forEach((plant, k) => said.set(`${k ? plants[k - 1] : -1} ${plant}`, walk_s[k]));
  return said;
}

/** What is left of the working day; it begins with the first record. */
export const secondsLeft = (day, begun, now) => Math.max(0, day.seconds_left - (begun ? (now - begun) / 1000 : 0));

/**
 * The plants ahead after a find: its neighbours come next, the nearest first, as far as the hours
 * allow; what then no longer fits at the end is left out.
 */
export function afterFind(plot, day, ahead, plant, done, left) {
  const next = [];
  let here = plant, spent = 0;
  const open = new Set(neighbours(plot, plant).filter((one) => !done.has(one)));
  while (open.size) {
    const one = [...open].sort((a, b) => apart(plot, here, a) - apart(plot, here, b) || a - b)[0];
    open.delete(one);
    const cost = walkSeconds(plot, day.robot, here, one) + day.robot.visit_s;
    if (spent + cost > left) break;
    spent += cost;
    next.push(one);
    here = one;
  }
  const rest = [...next, ...ahead.filter((one) => !next.includes(one))];
  return fitting(plot, day, plant, rest, Math.max(left, spent), next.length);
}

/** As many of the plants ahead as fit, at least `least`. */
function fitting(plot, day, at, ahead, left, least) {
  const said = legs(day);
  let total = 0, here = at, k = 0;
  for (; k < ahead.length; k++) {
    total += (said.get(`${here} ${ahead[k]}`) ?? walkSeconds(plot, day.robot, here, ahead[k])) + day.robot.visit_s;
    if (total > left && k >= least) break;
    here = ahead[k];
  }
  return ahead.slice(0, k);
}

/** Results that count, by plant: of this phone's records, the last one not taken back. */
export function results(records) {
  const gone = new Set(records.filter((one) => one.undoes).map((one) => one.undoes));
  const found = new Map();
  for (const one of records) if (!one.undoes && !gone.has(one.id)) found.set(one.plant, one);
  return found;
}
