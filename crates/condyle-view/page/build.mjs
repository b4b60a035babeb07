// Builds the page into dist/: index.html with its style, the program, and the evaluator packed by LZMA.
// `cargo xtask page --bless` builds the evaluator and the readers first and gives their places as arguments.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const file = (name) => fileURLToPath(new URL(name, import.meta.url));
mkdirSync(file("dist/assets"), { recursive: true });
const options = { bundle: true, format: "esm", target: "es2022", legalComments: "none" };
const licence = "/* three.js: MIT licence, (c) three.js authors; condyle: MIT OR Apache-2.0 */";
const built = await build({
  ...options,
  entryPoints: [file("src/main.ts")],
  minify: true,
  banner: { js: licence },
  outfile: file("dist/assets/page.js"),
});
if (built.warnings.length > 0) process.exit(1);
const style = readFileSync(file("src/style.css"), "utf8");
const html = readFileSync(file("src/index.html"), "utf8");
writeFileSync(file("dist/index.html"), html.replace("/* style */", () => style));

// The evaluator, and the readers of all formats.
for (const [at, name] of [[2, "core"], [3, "readers"]]) {
  const module = process.argv[at];
  if (!module) continue;
  const bytes = readFileSync(module);
  const packed = withLength(execFileSync("xz", ["--format=lzma", "-9e", "--stdout", "--keep", module], { maxBuffer: 1 << 28 }), bytes.length);
  // What the page will unpack has to be what was packed.
  const unpacker = await build({ ...options, entryPoints: [file("src/unpack.ts")], write: false });
  const source = `data:text/javascript,${encodeURIComponent(unpacker.outputFiles[0].text)}`;
  const { unpack } = await import(source);
  const start = performance.now();
  if (Buffer.compare(unpack(packed), bytes) !== 0) throw new Error("unpacking gives something else");
  console.log(`${name}: ${bytes.length} bytes, packed ${packed.length}, unpacked in ${(performance.now() - start).toFixed(0)} ms`);
  writeFileSync(file(`dist/assets/${name}.wasm.lzma`), packed);
}

/** `xz` leaves the length open, and marks the end; a page wants to know it before. */
function withLength(packed, length) {
  packed.writeBigUInt64LE(BigInt(length), 5);
  return packed;
}
