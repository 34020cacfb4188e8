// What is seen: how far apart things are on the screen, and from where a whole plot is in view.

import { WebMercatorViewport } from "@deck.gl/core";

const MOST_ZOOM = 21;

export function metresPerPixel({ latitude, zoom }) {
  return (40075016.686 * Math.cos((latitude * Math.PI) / 180)) / (512 * 2 ** zoom);
}

// Return the view that holds bounds (west, south, east, north) within what panels leave free.
export function fitted([west, south, east, north], { width, height }, padding) {
  const room = (a, b, whole) => Math.max(0, Math.min(a + b, whole - 40));
  const wide = room(padding.left, padding.right, width), tall = room(padding.top, padding.bottom, height);
  const used = {
    left: padding.left * (wide / (padding.left + padding.right || 1)),
    right: padding.right * (wide / (padding.left + padding.right || 1)),
    top: padding.top * (tall / (padding.top + padding.bottom || 1)),
    bottom: padding.bottom * (tall / (padding.top + padding.bottom || 1)),
  };
  const port = new WebMercatorViewport({ width, height, longitude: west, latitude: south, zoom: 0 });
  const least = 1e-6; // a single plant has no extent of its own
  const [x0, y0] = port.projectFlat([west - least, south - least]), [x1, y1] = port.projectFlat([east + least, north + least]);
  const free = [width - used.left - used.right, height - used.top - used.bottom];
  const zoom = Math.min(MOST_ZOOM, Math.log2(Math.min(free[0] / (x1 - x0), free[1] / (y1 - y0))));
  // what is left free has its middle elsewhere than the window (deck.gl's own fit takes it as if the
  // plot filled both ways)
  const half = 2 * 2 ** zoom;
  const middle = [(x0 + x1) / 2 + (used.right - used.left) / half, (y0 + y1) / 2 + (used.top - used.bottom) / half];
  const [longitude, latitude] = port.unprojectFlat(middle);
  return { longitude, latitude, zoom, bearing: 0, pitch: 0 };
}

// How far a word may reach into what panels and tools leave free around a plot: there is room above and
// below it, less beside it, where the panel's handle is.
const INTO = { left: 4, right: 4, top: 20, bottom: 24 };

// Return the view in which the words beside a plot are free, too: `words` are their boxes in a view.
function withWords(bounds, size, padding, words) {
  let view = fitted(bounds, size, padding);
  // farther away other words may be shown
  for (let k = 0; k < 2; k++) {
    const port = new WebMercatorViewport({ ...size, ...view }), boxes = words(port);
    if (!boxes.length) return view;
    const [left, bottom] = port.project([bounds[0], bounds[1]]), [right, top] = port.project([bounds[2], bounds[3]]);
    const most = (far) => Math.max(...boxes.map(far));
    const beyond = { left: most((b) => left - b[0]), right: most((b) => b[2] - right), top: most((b) => top - b[1]), bottom: most((b) => b[3] - bottom) };
    const more = Object.entries(beyond).map(([side, px]) => [side, padding[side] + Math.max(0, px - INTO[side])]);
    view = fitted(bounds, size, Object.fromEntries(more));
  }
  return view;
}

// Return the view that also leaves the corner free in which `box` lies, if one of the places, or a word, is behind it.
export function besideBox(bounds, size, padding, box, places, words = () => []) {
  const view = withWords(bounds, size, padding, words);
  if (!box || !covers(view, size, box, places, words)) return view;
  const side = box.left > size.width - box.right ? { right: Math.max(padding.right, size.width - box.left) }
    : { left: Math.max(padding.left, box.right) };
  const others = [side, { bottom: Math.max(padding.bottom, size.height - box.top) }];
  const views = others.map((change) => {
    const beside = withWords(bounds, size, { ...padding, ...change }, words);
    if (!covers(beside, size, box, places, words)) return beside;
    // words reach into what is left free, which is none before a box
    const farther = Object.entries(change).map(([at, px]) => [at, px + INTO[at]]);
    return withWords(bounds, size, { ...padding, ...Object.fromEntries(farther) }, words);
  });
  return views[0].zoom > views[1].zoom ? views[0] : views[1];
}

function covers(view, size, box, places, words) {
  const port = new WebMercatorViewport({ ...size, ...view });
  return places.some((place) => {
    const [x, y] = port.project(place);
    return x > box.left && x < box.right && y > box.top && y < box.bottom;
  }) || words(port).some((b) => b[2] > box.left && b[0] < box.right && b[3] > box.top && b[1] < box.bottom);
}
