// What a person does is one step back: the page writes its words into the address one after the other, and
// each was a step. Back led from a page to the same page.

let heard = false, acted = false;

// Who goes back goes nowhere else: what the page writes then replaces where they went.
export function wentBack() {
  acted = false;
}

// Let what the page adds to the address beside what a person did replace it, from now on.
export function keepOneStep() {
  if (heard) return;
  heard = true;
  const push = history.pushState.bind(history), replace = history.replaceState.bind(history);
  for (const kind of ["pointerdown", "keydown"]) document.addEventListener(kind, () => { acted = true; }, true);
  window.addEventListener("popstate", wentBack, true);
  history.pushState = (...to) => {
    (acted ? push : replace)(...to);
    acted = false;
  };
}
