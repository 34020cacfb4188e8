// Bundle the map into one file that any browser of the last two years runs.

import { build } from "esbuild";

import { banner, writeLicences } from "../bundle.mjs";

const made = await build({
  entryPoints: ["src/index.js"],
  outfile: "map_view.js",
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2023",
  legalComments: "none",
  loader: { ".css": "text" },
  define: { "process.env.NODE_ENV": '"production"' },
  metafile: true,
  banner: { js: await banner() },
});
await writeLicences(made.metafile, "map_view.js");
