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
  const port = new WebMercatorViewport({ width, height, longitude: west, latitude: south, zoom: 1 });
  const least = 1e-6; // a single plant has no extent of its own
  const corners = [[west - least, south - least], [east + least, north + least]];
  const { longitude, latitude, zoom } = port.fitBounds(corners, { padding: used, maxZoom: MOST_ZOOM });
  return { longitude, latitude, zoom, bearing: 0, pitch: 0 };
}
