// The evaluator: condyle compiled to WebAssembly, with the memory that it shares with the page.
// What its functions do is written in crates/condyle-wasm/src/border.rs.

import type { Goals } from "./goals";
import type { Key } from "./keys";
import { unpack } from "./unpack";

interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  prepare(length: number): number;
  take(handle: number, name: number): number;
  shipped(): void;
  shut(handle: number): void;
  ask(handle: number): number;
  pose(handle: number, actor: number, withinLimits: number): number;
  text_at(): number;
  text_length(): number;
  numbers_at(): number;
  numbers_length(): number;
  asked_at(handle: number, actor: number): number;
  effective_at(handle: number, actor: number): number;
  moves_at(handle: number, actor: number): number;
  places_at(handle: number, actor: number): number;
}

/** Where numbers are in an answer: the first byte, and how many numbers. */
export type Span = [start: number, count: number];

export interface Said {
  severity: "error" | "warning" | "note";
  text: string;
  line?: number | null;
}

/** What is wrong with something that the evaluator was given. */
export class Refused extends Error {
  constructor(readonly faults: Said[]) {
    super(faults.map((fault) => fault.text).join("\n"));
  }
}

/** An answer's text, and a copy of the numbers beside it. */
export class Answer<T> {
  constructor(
    readonly value: T,
    readonly bytes: ArrayBuffer,
  ) {}

  floats([start, count]: Span): Float32Array {
    return new Float32Array(this.bytes, start, count);
  }

  corners([start, count]: Span): Uint32Array {
    return new Uint32Array(this.bytes, start, count);
  }
}

export class Core {
  private constructor(private readonly exports: Exports) {}

  /** Unpacks and starts the evaluator. */
  static async start(packed: Uint8Array): Promise<Core> {
    const { instance } = await WebAssembly.instantiate(unpack(packed));
    return new Core(instance.exports as Exports);
  }

  /** Names of the models that come along. */
  shipped(): string[] {
    this.exports.shipped();
    return this.answer<string[]>().value;
  }

  /** Reads a file: a new model with the motion that its file holds, or a motion of `model`. */
  take(name: string, bytes: Uint8Array, model: Model | null): Taken {
    const title = new TextEncoder().encode(name);
    const at = this.exports.prepare(title.length + bytes.length);
    const input = new Uint8Array(this.exports.memory.buffer, at, title.length + bytes.length);
    input.set(title);
    input.set(bytes, title.length);
    const result = this.exports.take(model?.handle ?? 0xffffffff, title.length);
    const answer = this.answer<Faults & Omit<Taken, "model" | "motion"> & { motion: PackedMotion | null }>();
    if (result === 0) throw new Refused(answer.value.faults);
    const { motion, ...more } = answer.value;
    const read = motion && unpacked(motion, (span) => answer.floats(span));
    return { model: result > 1 ? new Model(this, result - 2) : null, motion: read, ...more };
  }

  ask<T>(handle: number, question: object): Answer<T> {
    const text = new TextEncoder().encode(JSON.stringify(question));
    const at = this.exports.prepare(text.length);
    new Uint8Array(this.exports.memory.buffer, at, text.length).set(text);
    const good = this.exports.ask(handle) === 1;
    const answer = this.answer<T & Faults>();
    if (!good) throw new Refused(answer.value.faults);
    return answer;
  }

  /** The functions and the memory, for what goes on in every frame. */
  get raw(): Exports {
    return this.exports;
  }

  private answer<T>(): Answer<T> {
    const { memory, text_at, text_length, numbers_at, numbers_length } = this.exports;
    const text = new TextDecoder().decode(new Uint8Array(memory.buffer, text_at(), text_length()));
    const start = numbers_at();
    const bytes = memory.buffer.slice(start, start + numbers_length()) as ArrayBuffer;
    return new Answer<T>(text === "" ? ({} as T) : (JSON.parse(text) as T), bytes);
  }
}

interface Faults {
  faults: Said[];
}

export interface Taken {
  model: Model | null;
  motion: Motion | null;
  /** Key poses, as their file has them. */
  keys?: Key[];
  /** Goals of a pose. */
  goals?: Goals;
  warnings: Said[];
}

/** A motion as the evaluator or a session gives it. */
export interface PackedMotion {
  name: string;
  times: number[];
  width: number;
  values: Span | string;
  markers: { names: string[]; positions: Span | string } | null;
  spans: Mark[];
}

/** A stretch of time that deserves a look. */
export interface Mark {
  kind: "violation" | "jump" | "undetermined" | "limited";
  from: number;
  to: number;
  at?: number;
  what: string;
  coordinate?: number;
}

/** Stored numbers of all coordinates over time, and what was measured. */
export interface Motion {
  name: string;
  times: number[];
  width: number;
  values: Float32Array | Float64Array;
  markers: { names: string[]; positions: Float32Array } | null;
  spans: Mark[];
  /** Of key poses: the pose of an actor at any time, the room on the timeline in seconds, and the time of one step. */
  keyed?: { at(time: number, actor: number): void; from: number; until: number; step: number };
}

export function unpacked(motion: PackedMotion, floats: (span: Span) => Float32Array): Motion {
  const numbers = (from: Span | string): Float32Array =>
    typeof from === "string" ? new Float32Array(bytesOf(from).buffer) : floats(from);
  const markers = motion.markers && {
    names: motion.markers.names,
    positions: numbers(motion.markers.positions),
  };
  return { ...motion, values: numbers(motion.values), markers };
}

/** Bytes of a text in base64. */
export function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(base64), (sign) => sign.charCodeAt(0));
}

export interface Coordinate {
  key: string;
  name: string;
  set: number;
  kind: "rotation" | "translation" | "scale" | "other" | "orientation";
  place: number;
  lower: number | null;
  upper: number | null;
  enforced: boolean;
  typical: [number, number] | null;
  default: number[];
  follows: boolean;
  locked: boolean;
  drives: string | null;
  source: string | null;
  moves: number | null;
}

export interface Segment {
  name: string;
  parent: number | null;
  set: number | null;
  joint: [number, number, number];
}

export interface Described {
  name: string;
  up: "y" | "z";
  ahead: [number, number, number];
  stored: number;
  segments: Segment[];
  sets: string[];
  coordinates: Coordinate[];
  markers: { name: string; segment: number | null; point: [number, number, number] }[];
  closures: number;
  colours: Record<string, string>;
}

/** A model that the evaluator holds. */
export class Model {
  readonly about: Described;
  readonly actors: Actor[] = [];

  constructor(
    readonly core: Core,
    readonly handle: number,
  ) {
    this.about = this.ask<Described>("describe").value;
    this.actors.push(new Actor(this, 0));
  }

  ask<T>(what: string, more: object = {}): Answer<T> {
    return this.core.ask<T>(this.handle, { ask: what, ...more });
  }

  /** The pose of a number, made where it is not there yet. */
  actor(number: number): Actor {
    while (this.actors.length <= number) {
      this.ask("actor");
      this.actors.push(new Actor(this, this.actors.length));
    }
    return this.actors[number]!;
  }

  close(): void {
    this.core.raw.shut(this.handle);
  }
}

/** One pose of a model, in the evaluator's memory. */
export class Actor {
  private readonly at: { asked: number; effective: number; moves: number; places: number };
  /** How often it was posed, and how long that took in all, in milliseconds. */
  posed = 0;
  spent = 0;

  constructor(
    readonly model: Model,
    readonly number: number,
  ) {
    const { raw } = model.core;
    const { handle } = model;
    this.at = {
      asked: raw.asked_at(handle, number),
      effective: raw.effective_at(handle, number),
      moves: raw.moves_at(handle, number),
      places: raw.places_at(handle, number),
    };
  }

  /** What is asked for; write here and then `pose`. */
  get asked(): Float64Array {
    return this.doubles(this.at.asked, this.model.about.stored);
  }

  /** What limits and couplings leave of it. */
  get effective(): Float64Array {
    return this.doubles(this.at.effective, this.model.about.stored);
  }

  /** Matrices that move surfaces from the defaults, column by column. */
  get moves(): Float32Array {
    const count = 16 * this.model.about.segments.length;
    return new Float32Array(this.model.core.raw.memory.buffer, this.at.moves, count);
  }

  /** Places of segments, row by row. */
  get places(): Float64Array {
    return this.doubles(this.at.places, 16 * this.model.about.segments.length);
  }

  /** Evaluates; whether it could be. */
  pose(withinLimits: boolean): boolean {
    const start = performance.now();
    const good = this.model.core.raw.pose(this.model.handle, this.number, withinLimits ? 1 : 0);
    this.spent += performance.now() - start;
    this.posed += 1;
    return good === 1;
  }

  /** A point of a segment in the world. */
  world(segment: number | null, [x, y, z]: readonly [number, number, number]): [number, number, number] {
    if (segment === null) return [x, y, z];
    const m = this.places.subarray(16 * segment, 16 * segment + 12);
    const row = (i: number) => m[4 * i]! * x + m[4 * i + 1]! * y + m[4 * i + 2]! * z + m[4 * i + 3]!;
    return [row(0), row(1), row(2)];
  }

  private doubles(at: number, count: number): Float64Array {
    return new Float64Array(this.model.core.raw.memory.buffer, at, count);
  }
}
