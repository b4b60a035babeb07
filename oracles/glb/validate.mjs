// What the glTF validator of Khronos says: node validate.mjs SCENE.glb...   (npm install gltf-validator)
import { readFileSync } from "node:fs";
import { validateBytes } from "gltf-validator";

for (const path of process.argv.slice(2)) {
  const report = await validateBytes(new Uint8Array(readFileSync(path)));
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(path, "errors", numErrors, "warnings", numWarnings);
  for (const m of messages.filter((m) => m.severity < 2).slice(0, 5)) console.log(" ", m.code, m.pointer, m.message);
}
