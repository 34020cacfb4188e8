// What a key does on the map: the map moves under a cross in its middle, which points as a finger does.

export const STEP_PX = 90, FINE_PX = 15;

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

// Return what a key asks for: {move: [dx, dy]}, {zoom: by}, {whole}, {press}, {finish}, {back}, {leave}; or null.
//
// `mode` is the kind of what is drawn or selected, or null.
export function asked({ key, shiftKey, ctrlKey, metaKey, altKey }, mode) {
  if (ctrlKey || metaKey || altKey) return null;
  if (ARROWS[key]) {
    const step = shiftKey ? FINE_PX : STEP_PX;
    return { move: ARROWS[key].map((way) => way * step) };
  }
  if (key === "+" || key === "=") return { zoom: 1 };
  if (key === "-" || key === "_") return { zoom: -1 };
  if (key === "0" || key === "Home") return { whole: true };
  if (key === "Escape") return { leave: true };
  if (mode && key === "Backspace") return { back: true };
  if (["line", "area", "lasso", "outline"].includes(mode)) {
    // corners are set by the space bar; Enter ends them, as it does for who draws with a mouse
    if (key === " ") return { press: true };
    if (key === "Enter") return { finish: true };
    return null;
  }
  return key === "Enter" || key === " " ? { press: true } : null;
}

// Return the view moved by pixels.
export function moved(viewport, [dx, dy]) {
  const [longitude, latitude] = viewport.unproject([viewport.width / 2 + dx, viewport.height / 2 + dy]);
  return { longitude, latitude, zoom: viewport.zoom, bearing: viewport.bearing ?? 0, pitch: viewport.pitch ?? 0 };
}
