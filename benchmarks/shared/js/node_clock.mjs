// node node_clock.mjs FMU_JS < JOB: prints the times that clock.js measures.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { clock } from "./clock.js";

const { loadFmu } = await import(pathToFileURL(process.argv[2]).href);
process.stdout.write(JSON.stringify(await clock(loadFmu, JSON.parse(readFileSync(0, "utf8")))));
