// Golden poses: the committed WebAssembly against the native library, to 1e-12 (metres, and axes of length 1).
// A model of OpenSim and a scene come through the readers of all formats.
// node golden.mjs FOLDER, after `cargo run --example golden FOLDER`.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { evaluator, readers } from "./evaluator.mjs";

const folder = process.argv[2];
const convert = await readers();
const { core, open, doubles } = await evaluator();
const names = readdirSync(folder).filter((file) => file.endsWith(".golden.json"));
if (names.length === 0) throw new Error(`${folder}: no golden poses`);
let worst = 0;
let count = 0;
for (const file of names) {
  const name = file.replace(".golden.json", "");
  const bytes = readFileSync(join(folder, name));
  // What the evaluator does not read itself comes through the second module, as it does on the page.
  const handle = name.endsWith(".json") ? open(name, bytes) : open(`${name}.json`, convert(name, bytes).model);
  for (const { asked, within_limits, effective, places } of JSON.parse(readFileSync(join(folder, file), "utf8"))) {
    doubles(core.asked_at(handle, 0), asked.length).set(asked);
    if (core.pose(handle, 0, within_limits ? 1 : 0) !== 1) throw new Error(`${name}: a pose was not evaluated`);
    const compare = (own, native, what) => {
      native.forEach((value, i) => {
        const off = Math.abs(own[i] - value);
        worst = Math.max(worst, off);
        if (!(off <= 1e-12)) throw new Error(`${name}: ${what} ${i} is ${own[i]}, native ${value}`);
      });
      count += native.length;
    };
    compare(doubles(core.places_at(handle, 0), places.length), places, "number of the places");
    compare(doubles(core.effective_at(handle, 0), effective.length), effective, "effective number");
  }
  core.shut(handle);
}
console.log(`   ${names.length} models, ${count} numbers, at most ${worst.toExponential(1)} off`);
