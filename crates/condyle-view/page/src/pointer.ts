// Pointer and keys over the picture: names on hover, selection, dragging.

import { Raycaster, Vector2, Vector3 } from "three";
import type { App } from "./app";
import { byId, element } from "./dom";
import { Drag } from "./drag";
import { VIEWS } from "./view";

export function pointer(app: App, dragging: { on: boolean }): void {
  const canvas = byId<HTMLCanvasElement>("picture");
  const hover = byId("hover");
  const caster = new Raycaster();
  let drag: Drag | null = null;
  let down: { x: number; y: number } | null = null;
  let waiting = false;

  const at = (event: PointerEvent): Vector2 => {
    const box = canvas.getBoundingClientRect();
    return new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
  };
  const hit = (event: PointerEvent) => {
    caster.setFromCamera(at(event), app.view.camera);
    return app.model ? app.hit(caster.ray) : null;
  };
  const name = (segment: number, part: string): string => {
    const { segments, sets } = app.model!.about;
    const { name: own, set } = segments[segment]!;
    return `${own}${part === own ? "" : ` (${part})`}${set === null ? "" : ` – ${sets[set]}`}`;
  };

  canvas.addEventListener(
    "pointerdown",
    (event) => {
      down = { x: event.clientX, y: event.clientY };
      if (!(dragging.on || event.altKey) || event.button !== 0) return;
      const found = hit(event);
      if (!found) return;
      const segment = found.part.segments[0];
      app.select(segment);
      drag = begin(app, segment, found.place);
      app.view.controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
      canvas.classList.add("dragging");
    },
    // Before the camera's controls.
    { capture: true },
  );
  canvas.addEventListener("pointermove", (event) => {
    if (drag) {
      drag.to(at(event), app.view);
      followed(app, drag, hover);
      return;
    }
    if (waiting || event.buttons !== 0) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const found = hit(event);
      hover.textContent = found ? name(found.part.segments[0], found.part.name) : "";
    });
  });
  const finish = (event: PointerEvent) => {
    if (drag) {
      drag.end();
      drag = null;
      app.view.controls.enabled = true;
      canvas.classList.remove("dragging");
      app.history.keep(app.model!.actors[0]!.asked);
    } else if (down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 4) {
      const found = hit(event);
      app.select(found ? found.part.segments[0] : null);
    }
    down = null;
  };
  canvas.addEventListener("pointerup", finish);
  canvas.addEventListener("pointercancel", finish);
  canvas.addEventListener("pointerleave", () => {
    if (!drag) hover.textContent = "";
  });
  keys(app, dragging, canvas, hover);
}

/** Begins to drag a place of a segment. */
function begin(app: App, segment: number, place: Vector3): Drag {
  const actor = app.model!.actors[0]!;
  const m = actor.places.slice(16 * segment, 16 * segment + 12);
  const [x, y, z] = [place.x - m[3]!, place.y - m[7]!, place.z - m[11]!];
  // Back into the segment: the inverse of its linear part, which may be scaled.
  const point = solve3([m[0]!, m[1]!, m[2]!, m[4]!, m[5]!, m[6]!, m[8]!, m[9]!, m[10]!], [x, y, z]);
  return new Drag(app.model!, 0, segment, point, place, new Vector3(), app.view);
}

function followed(app: App, drag: Drag, hover: HTMLElement): void {
  hover.textContent = `${app.model!.about.segments[drag.segment]!.name}: ${(1000 * drag.off).toFixed(1)} mm from the pointer`;
  app.posed();
}

function keys(app: App, dragging: { on: boolean }, canvas: HTMLCanvasElement, hover: HTMLElement): void {
  const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  let drag: Drag | null = null;
  canvas.addEventListener("keydown", (event) => {
    const arrow = arrows[event.key];
    if (arrow && dragging.on && app.selected !== null) {
      if (drag?.segment !== app.selected) {
        drag?.end();
        const place = new Vector3(...app.model!.actors[0]!.world(app.selected, [0, 0, 0]));
        drag = begin(app, app.selected, place);
      }
      const step = (event.shiftKey ? 0.001 : 0.01) * Math.max(0.2, app.view.unit / 0.05);
      const right = new Vector3().setFromMatrixColumn(app.view.camera.matrixWorld, 0);
      const up = new Vector3().setFromMatrixColumn(app.view.camera.matrixWorld, 1);
      drag.by(right.multiplyScalar(step * arrow[0]).addScaledVector(up, step * arrow[1]));
      followed(app, drag, hover);
      app.history.keep(app.model!.actors[0]!.asked);
    } else if (arrow) app.view.turn(0.1 * arrow[0], 0.1 * arrow[1]);
    else if (event.key === "+" || event.key === "=") app.view.nearer(0.85);
    else if (event.key === "-") app.view.nearer(1 / 0.85);
    else return;
    event.preventDefault();
  });
  canvas.addEventListener("blur", () => {
    drag?.end();
    drag = null;
  });

  const pressed: [string, string, () => void][] = [
    ["space", "play or pause", () => app.timeline.toggle()],
    [",", "one frame back", () => app.timeline.step(-1, app.motions[app.chosen[0]] ?? null)],
    [".", "one frame on", () => app.timeline.step(1, app.motions[app.chosen[0]] ?? null)],
    ["p", "keep the pose as a key at this time", () => app.keys.set()],
    ["u", "undo", () => app.undo()],
    ["y", "redo", () => app.redo()],
    ["0", "the neutral pose", () => app.neutral()],
    ["l", "limits hold, or not", () => app.limits(!app.withinLimits)],
    ["d", "drag bones, or turn the picture", () => byId("drag").click()],
    ["f", "see all of it", () => app.view.look(app.box())],
    ["n", "names", () => app.toggle("names")],
    ["a", "axes of joints", () => app.toggle("axes")],
    ["c", "moving centres", () => app.toggle("centres")],
    ["m", "markers", () => app.toggle("markers")],
    ["k", "limits of what is looked at", () => app.toggle("limits")],
    ["j", "the next bone", () => next(app, 1)],
    ["i", "the bone before", () => next(app, -1)],
    ...Object.keys(VIEWS).map((name, k): [string, string, () => void] => [`${k + 1}`, `from: ${name}`, () => app.view.look(app.box(), name)]),
    ["/", "find a coordinate", () => byId("find").focus()],
    ["?", "this help", () => byId<HTMLDialogElement>("help").showModal()],
  ];
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (event.key === "z" && event.ctrlKey) return event.shiftKey ? app.redo() : app.undo();
    if (event.ctrlKey || event.metaKey || event.altKey || !app.model) return;
    if (target.matches("input:not([type=range]):not([type=checkbox]), select, textarea")) return;
    if (event.key === " " && target.matches("button, summary, input")) return;
    const name = event.key === " " ? "space" : event.key;
    const found = pressed.find(([key]) => key === name);
    if (!found) return;
    found[2]();
    event.preventDefault();
  });
  const help = byId<HTMLDialogElement>("help");
  help.append(
    element("h2", {}, "keys"),
    element("dl", {}, ...pressed.flatMap(([key, text]) => [element("dt", {}, element("kbd", {}, key)), element("dd", {}, text)]), element("dt", {}, element("kbd", {}, "arrows")), element("dd", {}, "in the picture: turn it; while dragging is on, move the selected bone")),
    element("button", { onclick: () => help.close() }, "close"),
  );
}

function next(app: App, step: number): void {
  const count = app.model!.about.segments.length;
  app.select(((app.selected ?? (step > 0 ? -1 : 0)) + step + count) % count);
  byId("hover").textContent = app.model!.about.segments[app.selected!]!.name;
}

/** x of A x = b by Cramer's rule. */
function solve3(a: number[], [x, y, z]: [number, number, number]): [number, number, number] {
  const column = (k: number) => new Vector3(a[k], a[3 + k], a[6 + k]);
  const [c0, c1, c2, b] = [column(0), column(1), column(2), new Vector3(x, y, z)];
  const volume = (p: Vector3, q: Vector3, r: Vector3) => p.dot(q.clone().cross(r));
  const whole = volume(c0, c1, c2);
  return [volume(b, c1, c2) / whole, volume(c0, b, c2) / whole, volume(c0, c1, b) / whole];
}
