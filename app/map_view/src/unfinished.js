// What is being typed stays where the box that it is typed into is emptied meanwhile: the emptied one takes
// its place, and Streamlit drops what was not sent yet.

// name and form of a box, how often it was emptied, and its day and season
const BOX = /^(st-key-.+?)-(\d+)-(\d{4}-\d\d-\d\d-.*)$/;

let heard = false, typing = null, watcher = null;

function placeOf(box) {
  for (let at = box; at; at = at.parentElement) {
    for (const name of at.classList ?? []) {
      const parts = BOX.exec(name);
      if (parts) return { name: parts[1], times: Number(parts[2]), of: parts[3], root: at };
    }
  }
  return null;
}

function end() {
  watcher?.disconnect();
  watcher = typing = null;
}

// Go on in the box that took the place of the one that was typed into, once it is there.
function goOn() {
  const { place, text } = typing;
  for (const root of document.querySelectorAll(`[class*="${place.name}-"]`)) {
    const box = root.querySelector("input, textarea"), now = box && placeOf(box);
    if (!now || now.name !== place.name || now.of !== place.of || now.times <= place.times) continue;
    end();
    if (box.value) return; // what is in it was said already
    box.focus();
    // as typed: the page's own script hears of it
    Object.getOwnPropertyDescriptor(Object.getPrototypeOf(box), "value").set.call(box, text);
    box.dispatchEvent(new Event("input", { bubbles: true }));
    return;
  }
}

// Keep what is being typed in boxes that are emptied, from now on.
export function keepUnfinished() {
  if (heard) return;
  heard = true;
  document.addEventListener("input", ({ target: box }) => {
    const place = box.type === "text" || box.type === "number" || box.tagName === "TEXTAREA" ? placeOf(box) : null;
    if (!place) return;
    typing = { box, place, text: box.value };
    if (watcher) return;
    watcher = new MutationObserver(() => { if (!typing.box.isConnected) goOn(); });
    watcher.observe(document.body, { childList: true, subtree: true });
  }, true);
  // left, or finished with Enter, it is sent; some browsers say of a box that goes that it was left
  const sent = ({ target: box }) => setTimeout(() => { if (typing?.box === box && box.isConnected) end(); });
  document.addEventListener("focusout", sent, true);
  document.addEventListener("keydown", (event) => { if (event.key === "Enter") sent(event); }, true);
}
