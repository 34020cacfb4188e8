// What both bundles for browsers say of themselves: what they were built from, and whose code they hold.

import { createHash } from "node:crypto";
import { readdir, readFile, writeFile } from "node:fs/promises";

// The head of a bundle, so that a test without npm sees that it is up to date: a digest of the names and
// contents of its sources, in order of the names.
export async function banner() {
  const sources = (await readdir("src")).map((name) => `src/${name}`);
  const digest = createHash("sha256");
  for (const name of [...sources, "../bundle.mjs", "build.mjs", "package-lock.json"].sort()) {
    const text = Buffer.from((await readFile(name, "latin1")).replaceAll("\r\n", "\n"), "latin1");
    digest.update(`${name} ${text.length}\n`).update(text);
  }
  return `// built from ${digest.digest("hex")}`;
}

// Write the licence of every package whose code is in a bundle, packages of the same text together.
export async function writeLicences(metafile, bundle) {
  const packages = new Map();
  const folders = new Set();
  for (const file of Object.keys(metafile.inputs)) {
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
  await writeFile("LICENSES.txt", `${bundle} holds code of these packages.\n\n${parts.join("\n\n---\n\n")}\n`);
}
