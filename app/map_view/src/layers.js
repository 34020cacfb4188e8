// pydeck's JSON becomes deck.gl's layers.

import { TileLayer } from "@deck.gl/geo-layers";
import { JSONConverter } from "@deck.gl/json";
import { BitmapLayer, LineLayer, PathLayer, PolygonLayer, ScatterplotLayer, TextLayer } from "@deck.gl/layers";

import { PlantsLayer } from "./plants_layer.js";

// a picture of the ground by tiles: each tile is one picture
class GroundLayer extends TileLayer {
  static layerName = "GroundLayer";

  renderSubLayers(props) {
    const [[west, south], [east, north]] = props.tile.boundingBox;
    return new BitmapLayer(props, { data: null, image: props.data, bounds: [west, south, east, north] });
  }
}

const converter = new JSONConverter({
  configuration: {
    classes: { BitmapLayer, GroundLayer, LineLayer, PathLayer, PlantsLayer, PolygonLayer, ScatterplotLayer, TextLayer },
  },
});
const made = new WeakMap();

// Return a layer's class and properties; converted once for each JSON.
function propsOf(json) {
  if (!made.has(json)) {
    const { places, ranks, values, tip, data, ...rest } = json;
    const [layer] = converter.convert({ layers: [{ ...rest, data: [] }] }).layers;
    made.set(json, { Kind: layer.constructor, props: { ...layer.props, data: data ?? [], places, ranks, values } });
  }
  return made.get(json);
}

// Return deck.gl's layers; `hidden` names those that are switched off, `opacity` is the plants'.
export function layersOf(jsons, hidden, opacity) {
  return jsons.map((json) => {
    const { Kind, props } = propsOf(json);
    const own = json["@@type"] === "PlantsLayer" ? { opacity } : {};
    return new Kind({ ...props, ...own, id: json.id, visible: !hidden.has(json.id), pickable: false });
  });
}
