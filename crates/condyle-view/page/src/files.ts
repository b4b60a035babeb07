// Poses, motions and pictures as files.

import type { Model, Motion } from "./core";
import { download } from "./dom";

/** A pose as `condyle fk --pose` takes it: radians and metres by the names of coordinates. */
export function poseOf(model: Model): Record<string, number | number[]> {
  const { effective } = model.actors[0]!;
  return Object.fromEntries(
    model.about.coordinates.map((c) => [
      c.key,
      c.kind === "orientation" ? Array.from(effective.subarray(c.place, c.place + 4)) : effective[c.place]!,
    ]),
  );
}

/** Frames as questions have them. */
export function frames(motion: Motion): { times: number[]; frames: number[][] } {
  const { times, width, values } = motion;
  return { times, frames: times.map((_, k) => Array.from(values.subarray(k * width, (k + 1) * width))) };
}

/** Saves the pose, or the motion where there is one, in a format of the evaluator. */
export function save(model: Model, motion: Motion | null, format: string, name: string): void {
  if (format === "json") {
    download(`${name}.json`, [JSON.stringify(poseOf(model), null, 1)], "application/json");
    return;
  }
  const moving = motion ? frames(motion) : { actor: 0 };
  const { bytes } = model.ask("save", { format, name, ...moving });
  download(`${name}.${format}`, [bytes], "application/octet-stream");
}
