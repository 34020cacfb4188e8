// pydeck's JSON becomes deck.gl's layers.

import { TileLayer } from "@deck.gl/geo-layers";
import { JSONConverter } from "@deck.gl/json";
import { BitmapLayer, LineLayer, PathLayer, PolygonLayer, ScatterplotLayer, TextLayer } from "@deck.gl/layers";

import { PlantsLayer } from "./plants_layer.js";
import { askerAt } from "./web_map.js";

const NONE_THERE = [204, 404];

// Return the picture of a tile, or null where the map has none.
export async function pictureAt({ url, signal }) {
  const answer = await fetch(url, { signal });
  if (NONE_THERE.includes(answer.status)) return null;
  if (!answer.ok) throw new Error(`${url}: ${answer.status}`);
  return createImageBitmap(await answer.blob());
}

const fetchers = new Map();

// Return what does the same for a map of another server, by the worker that may ask it.
function throughWorker(address) {
  if (!fetchers.has(address)) {
    fetchers.set(address, async ({ url, signal }) => {
      const { status, blob } = await askerAt(address)({ url, signal });
      if (NONE_THERE.includes(status)) return null;
      if (!(status >= 200 && status < 300)) throw new Error(`${url}: ${status}`);
      return createImageBitmap(blob);
    });
  }
  return fetchers.get(address);
}

// a picture of the ground by tiles: each tile is one picture
class GroundLayer extends TileLayer {
  static layerName = "GroundLayer";
  static defaultProps = { getTileData: { type: "function", value: pictureAt }, maxCacheSize: 400 };

  renderSubLayers(props) {
    const [[west, south], [east, north]] = props.tile.boundingBox;
    return props.data && new BitmapLayer(props, { data: null, image: props.data, bounds: [west, south, east, north] });
  }
}

const converter = new JSONConverter({
  configuration: {
    classes: { BitmapLayer, GroundLayer, LineLayer, PathLayer, PlantsLayer, PolygonLayer, ScatterplotLayer, TextLayer },
  },
});
const made = new WeakMap();
// what comes beside a layer's JSON, and is not to be read as such
const ARRAYS = ["places", "ranks", "values", "notes", "image"];

// Return a layer's class and properties; converted once for each JSON.
function propsOf(json) {
  if (!made.has(json)) {
    const { tip, data, ...rest } = json, arrays = {};
    for (const name of ARRAYS) {
      if (rest[name] === undefined) continue;
      arrays[name] = rest[name];
      delete rest[name];
    }
    const [layer] = converter.convert({ layers: [{ ...rest, data: [] }] }).layers;
    made.set(json, { Kind: layer.constructor, props: { ...layer.props, data: data ?? [], ...arrays } });
  }
  return made.get(json);
}

const WHITE = [255, 255, 255], INK = [0, 0, 0];
const WEB_MAP = "ground-map";
// lines and rings that have a casing of their own, or lie on one that has
const CASED = new Set(["casing", "route", "trail", "arrows", "aisles", "rows-ground", "hatch"]);
const FILLS = new Set(["headland", "rows-ground", "aisles", "no-go"]);
const RINGED = new Set(["records", "picked", "truth"]);

// Return the colour that stands out from a colour: on it, one of the two stands out from any ground.
export function against([red, green, blue]) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 110 ? INK : WHITE;
}

// Return the layer that a line or a ring needs below it over a picture of the ground, in JSON; or null.
export function casingOf(json) {
  if (json["@@type"] === "PathLayer" && !CASED.has(json.id) && Array.isArray(json.getColor)) {
    const colour = against(json.getColor);
    return { ...json, id: `${json.id}-casing`, getColor: colour, getWidth: 2.5 * (json.getWidth ?? 0.4),
      widthMinPixels: (json.widthMinPixels ?? 1) + 3, pickable: false };
  }
  if (json["@@type"] === "ScatterplotLayer" && RINGED.has(json.id)) {
    const colour = against(json.getLineColor ?? json.getFillColor ?? [0, 0, 0]);
    return { ...json, id: `${json.id}-casing`, filled: false, stroked: true, getLineColor: colour,
      lineWidthMinPixels: (json.lineWidthMinPixels ?? 1) + 3 };
  }
  return null;
}

const casings = new WeakMap();

function cased(json) {
  if (!casings.has(json)) casings.set(json, casingOf(json));
  const below = casings.get(json);
  return below ? [below, json] : [json];
}

// Return deck.gl's layers.
//
// `hidden` names those that are switched off, `opacity` is the plants', `ground` says what lies below:
// {ids, opacity, picture: whether it may have any colour, failed: called where it cannot be fetched,
// worker: the address of what may ask another server for it}.
export function layersOf(jsons, hidden, opacity, ground = {}) {
  const below = new Set(ground.ids ?? []), isOff = (json) => hidden.has(json.id.replace(/-casing$/, ""));
  // to draw a map in tiles is to ask for it: one that is switched off is not there
  const overGround = [...below].some((id) => !hidden.has(id)), overPicture = ground.picture && overGround;
  // and the ground itself is not covered by its plan
  const shown = jsons.filter((json) => !(json["@@type"] === "GroundLayer" && hidden.has(json.id)) && !(overGround && FILLS.has(json.id)));
  return shown.flatMap((json) => (overPicture ? cased(json) : [json])).map((json) => {
    const { Kind, props } = propsOf(json);
    const own = {};
    if (json["@@type"] === "PlantsLayer") Object.assign(own, { opacity, cased: Boolean(overPicture) });
    if (below.has(json.id)) own.opacity = ground.opacity ?? 1;
    if (json["@@type"] === "GroundLayer") own.onTileError = () => ground.failed?.();
    if (json.id === WEB_MAP && ground.worker) own.getTileData = throughWorker(ground.worker);
    return new Kind({ ...props, ...own, id: json.id, visible: !isOff(json), pickable: false });
  });
}
