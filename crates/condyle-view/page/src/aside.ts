// What takes long, in a worker with an evaluator of its own: recordings are tracked there, and the page stays alive.

import type { App } from "./app";
import { Answer, type Model, type Motion, Refused, type Said, type Taken, read } from "./core";
import { byId, element } from "./dom";

/** What a worker is asked: to read a file, or to answer a question. */
type Task = { file: { name: string; bytes: Uint8Array } } | { question: object };
interface Given {
  module: WebAssembly.Module;
  model: { name: string; bytes: Uint8Array };
  file?: { name: string; bytes: Uint8Array };
  question?: string;
}
type Told = { done: number; of: number } | { good: boolean; text: string; numbers: ArrayBuffer } | { error: string };

/** As long as this, in seconds, is done without being asked. */
const SHORT = 2;
/** How to end what goes on. */
let end: (() => void) | null = null;

/** Runs in the worker: it must name nothing outside. */
function work(): void {
  const port = self as unknown as { onmessage: (event: MessageEvent<Given>) => void; postMessage(told: Told, transfer?: Transferable[]): void };
  port.onmessage = ({ data: { module, model, file, question } }) => {
    const progress = (done: number, of: number) => port.postMessage({ done, of });
    WebAssembly.instantiate(module, { page: { progress } })
      .then(({ exports }) => {
        const core = exports as unknown as { memory: WebAssembly.Memory } & Record<string, (...numbers: number[]) => number>;
        const put = (...parts: Uint8Array[]) => {
          const length = parts.reduce((sum, part) => sum + part.length, 0);
          let at = core["prepare"]!(length);
          for (const part of parts) {
            new Uint8Array(core.memory.buffer).set(part, at);
            at += part.length;
          }
        };
        const taken = (handle: number, name: string, bytes: Uint8Array): number => {
          const title = new TextEncoder().encode(name);
          put(title, bytes);
          return core["take"]!(handle, title.length);
        };
        const bytes = (what: string): ArrayBuffer => {
          const start = core[`${what}_at`]!();
          return core.memory.buffer.slice(start, start + core[`${what}_length`]!()) as ArrayBuffer;
        };
        let result = taken(0xffffffff, model.name, model.bytes);
        if (result > 1) {
          const handle = result - 2;
          if (file) result = taken(handle, file.name, file.bytes);
          else {
            put(new TextEncoder().encode(question));
            result = core["ask"]!(handle);
          }
        }
        const numbers = bytes("numbers");
        port.postMessage({ good: result > 0, text: new TextDecoder().decode(bytes("text")), numbers }, [numbers]);
      })
      .catch((error: unknown) => port.postMessage({ error: String(error) }));
  };
}

/** Does a task beside the page, with a bar; null where it was ended. What takes longer than `most` seconds is ended, and told. */
async function aside<T>(model: Model, task: Task, name: string, most: number, late: (seconds: number) => void): Promise<Answer<T> | null> {
  end?.();
  const address = URL.createObjectURL(new Blob([`(${work})()`], { type: "text/javascript" }));
  const worker = new Worker(address);
  const box = byId("tracking");
  const bar = element("progress", { value: 0, max: 1, "aria-label": `tracking ${name}` });
  const start = performance.now();
  try {
    return await new Promise<Answer<T> | null>((done, failed) => {
      const stopped = () => done(null);
      end = stopped;
      box.replaceChildren(`tracking ${name} `, bar, " ", element("button", { onclick: stopped }, "stop"));
      worker.onerror = (event) => failed(new Error(event.message));
      worker.onmessage = ({ data }: MessageEvent<Told>) => {
        if ("error" in data) failed(new Error(data.error));
        else if ("done" in data) {
          bar.value = data.done / Math.max(data.of, 1);
          const seconds = (performance.now() - start) / 1000;
          const whole = (seconds * data.of) / Math.max(data.done, 1);
          if (seconds > 0.5 && whole > most) {
            done(null);
            late(whole);
          }
        } else if (data.good) done(new Answer<T>(JSON.parse(data.text) as T, data.numbers));
        else failed(new Refused((JSON.parse(data.text) as { faults: Said[] }).faults));
      };
      const { module } = model.core;
      const rest = "file" in task ? task : { question: JSON.stringify(task.question) };
      worker.postMessage({ module, model: model.file, ...rest } satisfies Given);
    });
  } finally {
    worker.terminate();
    URL.revokeObjectURL(address);
    if (box.contains(bar)) box.replaceChildren();
  }
}

/** Whether a file is a recording, which is tracked. */
export function isRecording(name: string): boolean {
  return /\.(trc|c3d)$/i.test(name);
}

/** Reads and tracks a recording. */
export async function tracked(model: Model, name: string, bytes: Uint8Array): Promise<Taken> {
  const answer = await aside<Parameters<typeof read>[0]["value"]>(model, { file: { name, bytes } }, name, Infinity, () => {});
  return answer ? read(answer) : { model: null, motion: null, warnings: [] };
}

/** Tracks the markers of a motion with the model as it is now; without `asked` only if that does not take long. */
export async function trackAgain(app: App, motion: Motion, asked: boolean): Promise<void> {
  const { model } = app;
  if (!model || !motion.markers) return;
  const { names, positions } = motion.markers;
  const places = Array.from(positions, (x) => (Number.isNaN(x) ? null : x));
  const question = { ask: "track", names, times: motion.times, positions: places };
  const late = (seconds: number) => {
    const go = element("button", { id: "track-now", onclick: () => void app.attempt(() => trackAgain(app, motion, true)) }, "track again");
    const leave = element("button", { onclick: () => byId("tracking").replaceChildren() }, "leave it");
    setTimeout(() => byId("tracking").replaceChildren(`${motion.name} was tracked with the model as it was: `, go, ` (about ${Math.ceil(seconds)} s) `, leave));
  };
  const answer = await aside<Parameters<typeof read>[0]["value"]>(model, { question }, motion.name, asked ? Infinity : SHORT, late);
  const found = answer && read(answer).motion;
  const at = app.motions.indexOf(motion);
  if (!found || app.model !== model || at < 0) return;
  app.motions[at] = { ...motion, width: found.width, values: found.values, spans: found.spans };
  app.motionsChanged();
  app.timed();
}
