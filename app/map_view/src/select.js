// Which plants are selected: by rows, and by lassos; told as runs of numbers.

// Return the plants of each row, by the row's number; made once a plot.
export function rowsOf(places) {
  if (!places.rows) {
    places.rows = new Map();
    for (let k = 0; k < places.n; k++) {
      const row = places.rows.get(places.row[k]);
      if (row) row.push(k);
      else places.rows.set(places.row[k], [k]);
    }
  }
  return places.rows;
}

// Return what is selected once a whole row is added, or given back if all of it was selected.
export function withRow(places, picked, row) {
  const own = rowsOf(places).get(row) ?? [], next = new Set(picked);
  const all = own.length > 0 && own.every((k) => next.has(k));
  for (const k of own) {
    if (all) next.delete(k);
    else next.add(k);
  }
  return next;
}

// Return plants as runs of numbers, [first, last] each: rows are numbered plant by plant.
export function runsOf(plants) {
  const runs = [];
  for (const k of [...plants].sort((a, b) => a - b)) {
    if (runs.length && runs.at(-1)[1] === k - 1) runs.at(-1)[1] = k;
    else if (!runs.length || runs.at(-1)[1] < k) runs.push([k, k]);
  }
  return runs;
}

// Return the plants of runs.
export function ofRuns(runs) {
  const plants = new Set();
  for (const [first, last] of runs) for (let k = first; k <= last; k++) plants.add(k);
  return plants;
}
