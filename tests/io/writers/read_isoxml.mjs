// Task data as the npm package isoxml reads it: node read_isoxml.mjs FOLDER FILE...
// FOLDER is where `npm install --prefix FOLDER isoxml` was done. It fails where there is a warning.
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const [folder, ...files] = process.argv.slice(2);
const { ISOXMLManager } = createRequire(path.resolve(folder, "package.json"))("isoxml");

for (const file of files) {
  const reader = new ISOXMLManager();
  await reader.parseISOXMLFile(new Uint8Array(fs.readFileSync(file)), "application/zip");
  const [task] = reader.rootElement.attributes.Task;
  const [grid] = task.attributes.Grid ?? [];
  const zones = task.attributes.TreatmentZone.map(({ attributes }) => ({
    code: attributes.TreatmentZoneCode,
    rate: attributes.ProcessDataVariable?.[0].attributes.ProcessDataValue,
    polygons: attributes.PolygonTreatmentZoneonly?.length ?? 0,
  }));
  const cells = grid?.attributes.GridMaximumColumn * grid?.attributes.GridMaximumRow || 0;
  console.log(file, JSON.stringify({ zones, cells, bytes: grid?.binaryData?.length ?? 0 }));
  const warnings = reader.getWarnings();
  if (warnings.length) {
    console.error(warnings);
    process.exitCode = 1;
  }
}
