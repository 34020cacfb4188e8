// What was done is said over the panel, wherever it is scrolled, until the next press: who goes on has
// read it. Where that press asks nothing of the server, as of a tab, the message stayed over the boxes.

const NOTICE = ".st-key-panel_notice", PANEL = ".st-key-panel";
// these draw the page anew: what they have to say is said over it again
const ASKS = "button:not([role=tab])";

let heard = false;

// Let a message lie over nothing any more once something else was pressed, from now on.
export function letNoticesGo() {
  if (heard) return;
  heard = true;
  document.addEventListener("pointerdown", ({ target }) => {
    const notice = document.querySelector(NOTICE);
    if (!notice || notice.contains(target) || !target.closest?.(PANEL)) return;
    notice.parentElement.style.position = target.closest(ASKS) ? "" : "static";
  }, true);
}
