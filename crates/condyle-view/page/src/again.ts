// Motions after an edit of the model: values of coordinates are carried over by name, and what is gone is told.

import type { Described, Motion, Said } from "./core";

/** The motions that were shown, for the model as it is now; what is no longer there is said. */
export function carried(old: Motion[], from: Described, to: Described): { motions: Motion[]; said: Said[] } {
  const said: Said[] = [];
  const width = (kind: string) => (kind === "orientation" ? 4 : 1);
  const before = new Map(from.coordinates.map((c) => [c.key, c]));
  const same = from.stored === to.stored && from.coordinates.every((c, i) => c.key === to.coordinates[i]?.key && c.place === to.coordinates[i]?.place);
  const gone = from.coordinates.filter((c) => !to.coordinates.some((other) => other.key === c.key)).map((c) => c.key);
  const motions = old.filter((motion) => !motion.keyed).map((motion) => {
    if (same) return motion;
    const values = new Float32Array(motion.times.length * to.stored);
    motion.times.forEach((_, frame) => {
      for (const c of to.coordinates) {
        const own = before.get(c.key);
        const at = frame * to.stored + c.place;
        if (own && own.kind === c.kind) values.set(motion.values.subarray(frame * motion.width + own.place, frame * motion.width + own.place + width(c.kind)), at);
        else values.set(c.default, at);
      }
    });
    if (gone.length > 0) said.push({ severity: "warning", text: `${motion.name}: ${gone.length === 1 ? `the coordinate ${gone[0]} is` : `${gone.length} coordinates, such as ${gone[0]}, are`} no longer in the model` });
    return { ...motion, width: to.stored, values, spans: [] };
  });
  return { motions, said };
}
