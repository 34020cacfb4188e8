// Fractions in boxes of numbers, as the page's language writes them. A browser in another language drops
// a comma without a word: 2,5 litres became 25.

// Return the sign of fractions in a language.
function markOf(language) {
  return new Intl.NumberFormat(language || "en").formatToParts(0.5).find(({ type }) => type === "decimal").value;
}

// Return what is to be written instead of what was typed or pasted; null: nothing else.
export function written(typed, step, language) {
  // a box of whole numbers has no fractions: 1,320 is one thousand there
  if (!typed || (step && Number.isInteger(Number(step)))) return null;
  const number = /^(\d*)([,٫])(\d*)$/.exec(typed);
  return number && (number[2] === "٫" || markOf(language) === ",") ? `${number[1]}.${number[3]}` : null;
}

let heard = false;

// Let commas be taken from now on, in all boxes of the page.
export function takeCommas() {
  if (heard) return;
  heard = true;
  document.addEventListener("beforeinput", (event) => {
    const { target: box, data } = event;
    const instead = box?.type === "number" ? written(data, box.step, document.documentElement.lang) : null;
    if (instead === null) return;
    event.preventDefault();
    document.execCommand("insertText", false, instead); // as if typed: undo and the page's own script hear of it
  });
}
