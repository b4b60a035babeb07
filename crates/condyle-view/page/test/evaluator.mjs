// The committed evaluator in Node, as the page has it.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

export async function evaluator() {
  const packed = fileURLToPath(new URL("../dist/assets/core.wasm.lzma", import.meta.url));
  const bytes = execFileSync("xz", ["--format=lzma", "--decompress", "--stdout", packed], { maxBuffer: 1 << 28 });
  const { instance } = await WebAssembly.instantiate(bytes);
  const core = instance.exports;
  const bytes = () => new Uint8Array(core.memory.buffer);
  const answer = () => new TextDecoder().decode(bytes().slice(core.text_at(), core.text_at() + core.text_length()));
  const put = (...parts) => {
    const all = Buffer.concat(parts.map((part) => Buffer.from(part)));
    const at = core.prepare(all.length);
    bytes().set(all, at);
  };
  return {
    core,
    /** The handle of a model in a file. */
    open(name, content) {
      put(name, content);
      const result = core.take(0xffffffff, Buffer.byteLength(name));
      if (result < 2) throw new Error(`${name}: ${answer()}`);
      return result - 2;
    },
    ask(handle, question) {
      put(JSON.stringify(question));
      const good = core.ask(handle) === 1;
      if (!good) throw new Error(answer());
      return JSON.parse(answer() || "null");
    },
    doubles: (at, count) => new Float64Array(core.memory.buffer, at, count),
  };
}
