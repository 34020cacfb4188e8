// Bundle the scout's page into `built`: files that the app hands out as they are.

import { createHash } from "node:crypto";
import { copyFile, mkdir, readdir, readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

// what it is built from, so that a test without npm sees that it is up to date
const sources = (await readdir("src")).map((name) => `src/${name}`);
const digest = createHash("sha256");
for (const name of [...sources, "build.mjs", "package-lock.json"].sort()) {
  const text = Buffer.from((await readFile(name, "latin1")).replaceAll("\r\n", "\n"), "latin1");
  digest.update(`${name} ${text.length}\n`).update(text);
}
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
  banner: { js: `// built from ${digest.digest("hex")}` },
});
await build({ entryPoints: { scout: "src/style.css" }, outdir: "built", minify: true });
for (const [from, to] of [["page.html", "page.html"], ["manifest.json", "manifest.webmanifest"], ["icon.svg", "icon.svg"]]) {
  await copyFile(`src/${from}`, `built/${to}`);
}

const parts = [];
const folders = new Set();
for (const file of Object.keys(made.metafile.inputs)) {
  const [, folder] = file.match(/^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//) ?? [];
  if (folder) folders.add(folder);
}
for (const folder of [...folders].sort()) {
  const about = JSON.parse(await readFile(`${folder}/package.json`, "utf8"));
  const text = (await readFile(`${folder}/LICENSE`, "utf8")).trim();
  parts.push(`${about.name} ${about.version}\n\n${text}`);
}
await writeFile("LICENSES.txt", `built/scout.js holds code of these packages.\n\n${parts.join("\n\n---\n\n")}\n`);
