// Builds the bundle: node build.mjs OUT writes ali3-viewer.js (a script that defines window.ALi3Viewer), ali3-gltf.mjs
// (a program of Node) and their licences to OUT.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const page = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out) {
  console.error("usage: node build.mjs OUT");
  process.exit(2);
}

/** @type {esbuild.BuildOptions & {metafile: true}} */
const options = {
  absWorkingDir: page,
  bundle: true,
  minify: true,
  target: ["es2022"],
  charset: "ascii", // independent of the encoding of the page
  legalComments: "none", // the complete licences follow the code
  loader: { ".css": "text" },
  metafile: true,
  write: false,
};
const result = await esbuild.build({ ...options, entryPoints: ["src/main.js"], format: "iife", globalName: "ALi3Viewer" });
const gltf = await esbuild.build({ ...options, entryPoints: ["src/gltf/index.js"], format: "esm", platform: "node" });

const packages = new Set();
for (const input of [result, gltf].flatMap(({ metafile }) => Object.keys(metafile.inputs))) {
  const match = /(?:^|\/)node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input);
  if (match) packages.add(match[1]);
}
const licences = [...packages].sort().map((name) => {
  const folder = join(page, "node_modules", name);
  const { version, license, homepage } = JSON.parse(readFileSync(join(folder, "package.json"), "utf-8"));
  const text = readFileSync(join(folder, "LICENSE"), "utf-8").trim();
  return `${name} ${version} (${license}) ${homepage ?? ""}\n\n${text}\n`;
});
const notice = `Third-party software in this bundle\n\n${licences.join("\n" + "-".repeat(80) + "\n\n")}`;

mkdirSync(out, { recursive: true });
// The code must not contain the end of a script element.
const code = result.outputFiles[0].text.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");
writeFileSync(join(out, "THIRD_PARTY_LICENSES.txt"), notice);
const comment = notice.replace(/\*\//g, "* /").replace(/\u00a9/g, "(c)").replace(/[^\0-\x7f]/g, "?");
writeFileSync(join(out, "ali3-viewer.js"), `${code}/*!\n${comment}*/\n`);
writeFileSync(join(out, "ali3-gltf.mjs"), `${gltf.outputFiles[0].text}/*!\n${comment}*/\n`);
