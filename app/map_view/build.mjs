// Bundle the map into one file that any browser of the last two years runs.

import { createHash } from "node:crypto";
import { readdir, readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

// what it is built from, so that a test without npm sees that it is up to date
const sources = (await readdir("src")).map((name) => `src/${name}`);
const digest = createHash("sha256");
for (const name of [...sources, "build.mjs", "package-lock.json"].sort()) {
  const text = Buffer.from((await readFile(name, "latin1")).replaceAll("\r\n", "\n"), "latin1");
  digest.update(`${name} ${text.length}\n`).update(text);
}

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
  banner: { js: `// built from ${digest.digest("hex")}` },
});

// the licence of every package whose code is in the bundle, packages of the same text together
const packages = new Map();
const folders = new Set();
for (const file of Object.keys(made.metafile.inputs)) {
  const [, folder] = file.match(/^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//) ?? [];
  if (folder) folders.add(folder);
}
for (const folder of [...folders].sort()) {
  const about = JSON.parse(await readFile(`${folder}/package.json`, "utf8"));
  let text = "";
  for (const name of ["LICENSE", "LICENSE.md", "LICENSE.txt", "license", "LICENCE"]) {
    text ||= await readFile(`${folder}/${name}`, "utf8").catch(() => "");
  }
  text = text.trim().replace(/[ \t]+$/gm, "") || `Licence: ${about.license}`;
  packages.set(text, [...(packages.get(text) ?? []), `${about.name} ${about.version}`]);
}
const parts = [...packages].map(([text, names]) => `${names.join(", ")}\n\n${text}`);
await writeFile("LICENSES.txt", `map_view.js holds code of these packages.\n\n${parts.join("\n\n---\n\n")}\n`);
