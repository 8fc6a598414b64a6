// Validates glTF files by the validator of Khronos; one line of JSON a file: its report.
import fs from "node:fs";
import validator from "gltf-validator";

for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: file });
  console.log(JSON.stringify(report));
}
