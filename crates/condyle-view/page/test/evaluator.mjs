// The committed evaluator in Node, as the page has it.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

async function started(name) {
  const packed = fileURLToPath(new URL(`../dist/assets/${name}.wasm.lzma`, import.meta.url));
  const module = execFileSync("xz", ["--format=lzma", "--decompress", "--stdout", packed], { maxBuffer: 1 << 28 });
  const { instance } = await WebAssembly.instantiate(module);
  return instance.exports;
}

/** What the readers of all formats make of a file. */
export async function readers() {
  const all = await started("readers");
  return (name, content) => {
    const input = Buffer.concat([Buffer.from(name), Buffer.from(content)]);
    const at = all.prepare(input.length);
    new Uint8Array(all.memory.buffer).set(input, at);
    const good = all.convert(Buffer.byteLength(name)) === 1;
    const text = new TextDecoder().decode(new Uint8Array(all.memory.buffer, all.text_at(), all.text_length()));
    if (!good) throw new Error(`${name}: ${text}`);
    return JSON.parse(text);
  };
}

export async function evaluator() {
  const core = await started("core");
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
