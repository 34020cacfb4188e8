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

// Return the view that also leaves the corner free in which `box` lies, if one of the places is behind it.
export function besideBox(bounds, size, padding, box, places) {
  const view = fitted(bounds, size, padding);
  if (!box || !places.length || !covers(view, size, box, places)) return view;
  const side = box.left > size.width - box.right ? { right: Math.max(padding.right, size.width - box.left) }
    : { left: Math.max(padding.left, box.right) };
  const others = [side, { bottom: Math.max(padding.bottom, size.height - box.top) }];
  const views = others.map((change) => fitted(bounds, size, { ...padding, ...change }));
  return views[0].zoom > views[1].zoom ? views[0] : views[1];
}

function covers(view, size, box, places) {
  const port = new WebMercatorViewport({ ...size, ...view });
  return places.some((place) => {
    const [x, y] = port.project(place);
    return x > box.left && x < box.right && y > box.top && y < box.bottom;
  });
}
