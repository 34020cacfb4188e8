// The plants of a plot: points from near, one picture from far, whatever their number.

import { CompositeLayer } from "@deck.gl/core";
import { BitmapLayer, ScatterplotLayer } from "@deck.gl/layers";

import { metresPerPixel } from "./view.js";

// up to so many plants are always points; of more, those in view, if they stand far enough apart
const ALL = 20000, IN_VIEW = 60000, APART_PX = 3;
const PICTURE_PX = 2048, LEVELS = 11, M_PER_DEGREE = 111320;

export class PlantsLayer extends CompositeLayer {
  static layerName = "PlantsLayer";
  static defaultProps = {
    places: { type: "object", value: null },
    ranks: { type: "object", value: null },
    table: { type: "array", value: [] },
    rim: { type: "array", value: [120, 110, 90, 140] },
    radius: 1,
    apart: 1,
    cased: false,
  };

  shouldUpdateState({ changeFlags }) {
    const far = this.props.places.n > ALL;
    return changeFlags.propsOrDataChanged || (far && changeFlags.viewportChanged);
  }

  updateState({ props, oldProps, changeFlags }) {
    const { viewport } = this.context;
    const fresh = props.places !== oldProps.places || props.ranks !== oldProps.ranks ||
      props.table !== oldProps.table || !this.state.made;
    if (props.places.n <= ALL) {
      if (fresh) this.setState({ made: true, points: pointsOf(props, null), picture: null });
      return;
    }
    const apart = props.apart / metresPerPixel(viewport);
    const seen = apart < APART_PX ? null : inView(props.places, viewport.getBounds());
    if (seen !== null) {
      this.setState({ made: true, points: pointsOf(props, seen), picture: null });
    } else {
      if (fresh || !this.levels) this.levels = [ranksOf(props)];
      const picture = this.level(metresPerPixel(viewport), props.table);
      if (picture !== this.state.picture) this.setState({ made: true, points: null, picture });
    }
  }

  // Return the picture whose pixels are one to two of the screen's: a finer one would lose plants.
  level(metres, table) {
    const own = this.levels[0].step * M_PER_DEGREE;
    const k = Math.min(LEVELS, Math.max(0, Math.ceil(Math.log2(metres / own))));
    while (this.levels.length <= k) this.levels.push(halved(this.levels.at(-1)));
    return (this.levels[k].picture ??= drawable(painted(filled(this.levels[k], this.props), table)));
  }

  renderLayers() {
    const { points, picture } = this.state;
    if (picture) {
      return new BitmapLayer(this.getSubLayerProps({ id: "picture" }), {
        image: picture.image, bounds: picture.bounds,
        textureParameters: { magFilter: "nearest", minFilter: "nearest" },
      });
    }
    if (!points) return null;
    const { radius, rim, cased } = this.props, size = { data: points, getRadius: radius, radiusMinPixels: 1.5, stroked: true };
    // over a picture of the ground, a dark rim in a white one: one of them stands out from any ground
    return [
      cased && new ScatterplotLayer(this.getSubLayerProps({ id: "halo" }), {
        ...size, filled: false, getLineColor: [255, 255, 255], getLineWidth: 0.7 * radius, lineWidthMinPixels: 1, lineWidthMaxPixels: 2.6 }),
      new ScatterplotLayer(this.getSubLayerProps({ id: "points" }), {
        ...size, ...(cased ? { getLineColor: [0, 0, 0], getLineWidth: 0.25 * radius, lineWidthMinPixels: 0.4, lineWidthMaxPixels: 1.1 }
          : { getLineColor: rim, getLineWidth: 0.05, lineWidthMinPixels: 0.5 }) }),
    ];
  }
}

// Return the points' attributes, the more important plants drawn last and so on top.
export function pointsOf({ places, ranks, table }, which) {
  const n = which ? which.length : places.n;
  const positions = new Float64Array(2 * n), colours = new Uint8Array(4 * n);
  const starts = new Uint32Array(table.length + 1);
  for (let k = 0; k < n; k++) starts[ranks[which ? which[k] : k] + 1]++;
  for (let r = 0; r < table.length; r++) starts[r + 1] += starts[r];
  for (let k = 0; k < n; k++) {
    const plant = which ? which[k] : k, at = starts[ranks[plant]]++;
    positions[2 * at] = places.lon[plant];
    positions[2 * at + 1] = places.lat[plant];
    colours.set(table[ranks[plant]], 4 * at);
  }
  return {
    length: n,
    attributes: {
      getPosition: { value: positions, size: 2 },
      getFillColor: { value: colours, size: 4, normalized: true },
    },
  };
}

// Return the plants within bounds, or null where there are too many to draw each.
export function inView(places, [west, south, east, north]) {
  const which = [];
  for (let k = 0; k < places.n; k++) {
    const lon = places.lon[k], lat = places.lat[k];
    if (lon < west || lon > east || lat < south || lat > north) continue;
    if (which.length === IN_VIEW) return null;
    which.push(k);
  }
  return which;
}

// Return all plants as one picture: the most important plant of a pixel gives it its colour.
export function pictureOf(props) {
  return painted(ranksOf(props), props.table);
}

// Return the highest rank on each pixel, from 1; 0 where no plant is.
export function ranksOf({ places, ranks }) {
  const [west, south, east, north] = places.bounds;
  const flat = Math.cos((((south + north) / 2) * Math.PI) / 180);
  const step = Math.max(places.step, (east - west) * flat / PICTURE_PX, (north - south) / PICTURE_PX);
  const width = Math.max(1, Math.ceil(((east - west) * flat) / step));
  const height = Math.max(1, Math.ceil((north - south) / step));
  const top = new Uint8Array(width * height);
  for (let k = 0; k < places.n; k++) {
    const x = Math.min(width - 1, Math.floor(((places.lon[k] - west) * flat) / step));
    const y = Math.min(height - 1, Math.floor((north - places.lat[k]) / step));
    const at = y * width + x;
    if (ranks[k] + 1 > top[at]) top[at] = ranks[k] + 1;
  }
  return { top, width, height, step, flat, west, north };
}

// Return the same on pixels twice as large each way: the highest rank of four stays.
export function halved({ top, width, height, step, ...rest }) {
  const wide = Math.ceil(width / 2), high = Math.ceil(height / 2), less = new Uint8Array(wide * high);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const at = (y >> 1) * wide + (x >> 1);
      if (top[y * width + x] > less[at]) less[at] = top[y * width + x];
    }
  }
  return { top: less, width: wide, height: high, step: 2 * step, ...rest };
}

// Return the same with plants on all the ground that is theirs, where pixels are nearly as wide: between two
// plants one pixel here and there held neither, and looked like a missing plant.
export function filled(level, { places, ranks, apart }) {
  const { top, width, height, step, flat, west, north } = level, wide = apart / M_PER_DEGREE / step;
  if (wide > 2) return level;
  const full = top.slice(), reach = (wide + 1) / 2 - 1e-6;
  for (let k = 0; k < places.n; k++) {
    const px = ((places.lon[k] - west) * flat) / step - 0.5, py = (north - places.lat[k]) / step - 0.5;
    for (let y = Math.max(0, Math.ceil(py - reach)); y <= Math.min(height - 1, py + reach); y++) {
      for (let x = Math.max(0, Math.ceil(px - reach)); x <= Math.min(width - 1, px + reach); x++) {
        const at = y * width + x;
        if (!top[at] && ranks[k] + 1 > full[at]) full[at] = ranks[k] + 1;
      }
    }
  }
  return { ...level, top: full };
}

// Return a picture as deck.gl takes it: of a bare object it does not know the size, and draws all black.
export function drawable({ image: { width, height, data }, bounds }) {
  return { image: new ImageData(data, width, height), bounds };
}

// Return the picture of the ranks, and where it lies.
export function painted({ top, width, height, step, flat, west, north }, table) {
  const data = new Uint8ClampedArray(4 * width * height);
  for (let at = 0; at < top.length; at++) if (top[at]) data.set(table[top[at] - 1], 4 * at);
  // whole pixels: stretched over the plot alone, plants would stand up to a pixel beside their places
  return { image: { width, height, data }, bounds: [west, north - height * step, west + (width * step) / flat, north] };
}
