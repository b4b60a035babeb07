// Readers of all formats: a second module, fetched when a file is given that the evaluator does not read.

import { type Core, type Model, type PackedMotion, Refused, type Said, type Span, type Taken, bytesOf, unpacked } from "./core";
import { unpack } from "./unpack";

interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  prepare(length: number): number;
  convert(name: number): number;
  text_at(): number;
  text_length(): number;
  numbers_at(): number;
  numbers_length(): number;
}

interface Converted {
  model: string | null;
  motion: PackedMotion | null;
  recording: boolean;
  warnings: Said[];
  faults: Said[];
}

/** Files that need them. */
const OTHERS = /\.(osim|xml|urdf|skel|asf|amc|glb|gltf|vrm|npz|jsonl|ndjson)$/i;
let readers: Promise<Exports> | null = null;

/** Reads a file of any format: what is of few is read by the evaluator itself, the rest comes to it through them. */
export async function take(core: Core, name: string, bytes: Uint8Array, model: Model | null): Promise<Taken> {
  if (!OTHERS.test(name)) return core.take(name, bytes, model);
  readers ??= fetched();
  // What could not be fetched is asked for again.
  readers.catch(() => (readers = null));
  const all = await readers;
  const title = new TextEncoder().encode(name);
  const at = all.prepare(title.length + bytes.length);
  const input = new Uint8Array(all.memory.buffer, at, title.length + bytes.length);
  input.set(title);
  input.set(bytes, title.length);
  const good = all.convert(title.length) === 1;
  const text = new TextDecoder().decode(new Uint8Array(all.memory.buffer, all.text_at(), all.text_length()));
  const converted = JSON.parse(text) as Converted;
  if (!good) throw new Refused(converted.faults);
  const start = all.numbers_at();
  const numbers = all.memory.buffer.slice(start, start + all.numbers_length()) as ArrayBuffer;
  if (converted.recording) {
    const taken = core.take(`${name}.trc`, new Uint8Array(numbers), model);
    return { ...taken, warnings: [...converted.warnings, ...taken.warnings] };
  }
  const taken = core.take(`${name}.json`, new TextEncoder().encode(converted.model ?? ""), null);
  const floats = ([start, count]: Span) => new Float32Array(numbers, start, count);
  const motion = converted.motion && unpacked(converted.motion, floats);
  return { ...taken, motion, warnings: [...converted.warnings, ...taken.warnings] };
}

async function fetched(): Promise<Exports> {
  const inside = document.getElementById("readers");
  const packed = inside ? bytesOf(inside.textContent ?? "") : await asset();
  const { instance } = await WebAssembly.instantiate(unpack(packed));
  return instance.exports as Exports;
}

async function asset(): Promise<Uint8Array> {
  const own = "this page reads .toml, .json, .bvh, .trc, .c3d, .mot, .sto and .csv; `condyle view` reads all that condyle does";
  try {
    const response = await fetch("assets/readers.wasm.lzma");
    if (response.ok) return new Uint8Array(await response.arrayBuffer());
  } catch {
    // A file of its own has nothing beside it.
  }
  throw new Error(own);
}
