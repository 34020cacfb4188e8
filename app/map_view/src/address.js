// What a person does is one step back: the page writes its words into the address one after the other, and
// each was a step. Back led from a room to the same room.

let heard = false;

// Let what the page adds to the address beside what a person did replace it, from now on.
export function keepOneStep() {
  if (heard) return;
  heard = true;
  const push = history.pushState.bind(history), replace = history.replaceState.bind(history);
  let acted = false;
  for (const kind of ["pointerdown", "keydown"]) document.addEventListener(kind, () => { acted = true; }, true);
  window.addEventListener("popstate", () => { acted = false; }, true); // who goes back goes nowhere else
  history.pushState = (...to) => {
    (acted ? push : replace)(...to);
    acted = false;
  };
}
