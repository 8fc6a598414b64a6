// node node_drive.mjs FMU_JS < JOB: drives as the job says.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { drive } from "./drive.js";

const { loadFmu } = await import(pathToFileURL(process.argv[2]).href);
process.stdout.write(JSON.stringify(await drive(loadFmu, JSON.parse(readFileSync(0, "utf8")))));
