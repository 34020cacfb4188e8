// Bundle the scout's page into `built`: files that the app hands out as they are.

import { copyFile, mkdir } from "node:fs/promises";
import { build } from "esbuild";

import { banner, writeLicences } from "../bundle.mjs";

await mkdir("built", { recursive: true });
const made = await build({
  entryPoints: { scout: "src/index.js", worker: "src/worker.js" },
  outdir: "built",
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  metafile: true,
  banner: { js: await banner() },
});
await build({ entryPoints: { scout: "src/style.css" }, outdir: "built", minify: true });
for (const [from, to] of [["page.html", "page.html"], ["manifest.json", "manifest.webmanifest"], ["icon.svg", "icon.svg"]]) {
  await copyFile(`src/${from}`, `built/${to}`);
}
await writeLicences(made.metafile, "built/scout.js");
