// Handles of a point that is edited: an arrow along each axis of the frame in which its numbers are, drawn over the picture.

import type { App } from "./app";
import { byId } from "./dom";

type Place = [number, number, number];

/** A point whose three numbers are edited. */
export interface Held {
  /** The segment in whose frame it is; `null` for the world. */
  frame: number | null;
  at: Place;
  /** Told when it was moved along an axis, by its new number. */
  moved: (axis: number, value: number) => void;
}

const AXES = ["x", "y", "z"];
/** How long arrows are, in CSS pixels. */
const LONG = 46;

export class Handle {
  private readonly root = svg("svg", { class: "handle" });
  private readonly arrows = AXES.map((name, axis) => new Arrow(name, (x, y, done) => this.dragged(axis, x, y, done)));
  private held: Held | null = null;
  /** How far the point is drawn from where it is, while it is dragged. */
  private by: Place = [0, 0, 0];

  constructor(private readonly app: App) {
    // Over the canvas; only the ends of the arrows take the pointer.
    Object.assign(this.root.style, { position: "absolute", inset: "0", width: "100%", height: "100%", pointerEvents: "none" });
    this.root.append(...this.arrows.map((arrow) => arrow.root));
    byId("stage").append(this.root);
    app.view.before.push(() => this.draw());
  }

  /** Shows the handles of a point, or none. */
  hold(held: Held | null): void {
    this.held = held;
    this.by = [0, 0, 0];
    this.app.view.draw();
  }

  private world(point: Place): Place {
    const actor = this.app.model?.actors[0];
    const frame = this.held?.frame ?? null;
    if (!actor || frame === null) return point;
    const [x, y, z] = actor.world(frame, point);
    return [x!, y!, z!];
  }

  /** Where the point is in the picture, and by how many pixels a metre along an axis moves it. */
  private seen(axis: number): { from: [number, number]; along: [number, number] } | null {
    if (!this.held) return null;
    const at = this.held.at.map((value, i) => value + this.by[i]!) as Place;
    const step = 0.01;
    const further = at.map((value, i) => value + (i === axis ? step : 0)) as Place;
    const [from, to] = [this.app.view.project(this.world(at)), this.app.view.project(this.world(further))];
    if (!from || !to) return null;
    return { from, along: [(to[0] - from[0]) / step, (to[1] - from[1]) / step] };
  }

  private draw(): void {
    for (const [axis, arrow] of this.arrows.entries()) arrow.draw(this.seen(axis));
  }

  private dragged(axis: number, x: number, y: number, done: boolean): void {
    const seen = this.seen(axis);
    const { held } = this;
    if (!seen || !held) return;
    const [a, b] = seen.along;
    const size = a * a + b * b;
    // An axis that points at the camera cannot be dragged.
    const moved = size < 1 ? 0 : (x * a + y * b) / size;
    // To the tenth of a millimetre: nobody sees less.
    const value = Math.round((held.at[axis]! + this.by[axis]! + moved) * 1e4) / 1e4;
    if (done) {
      this.by = [0, 0, 0];
      if (value !== held.at[axis]) held.moved(axis, value);
    } else {
      this.by[axis] = this.by[axis]! + moved;
      byId("hover").textContent = `${AXES[axis]}: ${value.toFixed(4)} m`;
    }
    this.app.view.draw();
  }
}

/** An arrow along an axis, with an end that is dragged. */
class Arrow {
  readonly root: SVGElement;
  private readonly line = svg("line", { stroke: "currentColor", "stroke-width": "2" });
  private readonly end: SVGElement;
  private readonly name: SVGElement;

  constructor(name: string, moved: (x: number, y: number, done: boolean) => void) {
    this.end = svg("circle", { r: "7", fill: "var(--accent)", stroke: "var(--panel)", "data-handle": name });
    this.name = svg("text", { "font-size": "12", fill: "currentColor" });
    this.name.textContent = name;
    this.root = svg("g", {});
    this.root.append(this.line, this.end, this.name);
    Object.assign(this.end.style, { pointerEvents: "all", cursor: "grab", touchAction: "none" });
    let last: [number, number] | null = null;
    this.end.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      this.end.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    this.end.addEventListener("pointermove", (event) => {
      if (!last) return;
      moved(event.clientX - last[0], event.clientY - last[1], false);
      last = [event.clientX, event.clientY];
    });
    const finish = () => {
      if (last) moved(0, 0, true);
      last = null;
    };
    this.end.addEventListener("pointerup", finish);
    this.end.addEventListener("pointercancel", finish);
  }

  draw(seen: { from: [number, number]; along: [number, number] } | null): void {
    this.root.toggleAttribute("hidden", !seen);
    this.root.style.display = seen ? "" : "none";
    if (!seen) return;
    const [a, b] = seen.along;
    const long = Math.hypot(a, b);
    const [x, y] = seen.from;
    const [u, v] = long < 1 ? [0, 0] : [x + (LONG * a) / long, y + (LONG * b) / long];
    const set = (of: SVGElement, names: Record<string, number>) => Object.entries(names).forEach(([name, value]) => of.setAttribute(name, value.toFixed(1)));
    set(this.line, { x1: x, y1: y, x2: u, y2: v });
    set(this.end, { cx: u, cy: v });
    set(this.name, { x: u + 9, y: v + 4 });
  }
}

function svg(tag: string, attributes: Record<string, string>): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag) as SVGElement;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
