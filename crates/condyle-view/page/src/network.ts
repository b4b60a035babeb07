// The components of a joint set as a graph, from coordinates on the left to segments on the right, with what
// flows through it.

import type { Model } from "./core";

type Source = { coordinate: number } | { component: number; output: number } | { segment: number };

interface Net {
  components: { id: number; name: string; kind: string; inputs: { port: string; from: Source }[] }[];
  outputs: { segment: number; from: Source }[];
  names: string[];
}

interface Box {
  key: string;
  title: string;
  kind: string;
  column: number;
  row: number;
}

const SVG = "http://www.w3.org/2000/svg";
const WIDE = 170;
const HIGH = 40;
const GAP = { x: 46, y: 12 };

export class Network {
  readonly root = document.createElementNS(SVG, "svg");
  private values = new Map<string, SVGTextElement>();
  private model: Model | null = null;
  private set = -1;
  /** The boxes that are drawn. */
  count = 0;

  constructor() {
    this.root.setAttribute("class", "network");
    this.root.setAttribute("role", "img");
    this.root.setAttribute("tabindex", "0");
  }

  /** Shows nothing. */
  clear(): void {
    this.model = null;
    this.root.replaceChildren();
    this.count = 0;
  }

  show(model: Model, set: number): void {
    this.model = model;
    this.set = set;
    const net = model.ask<Net>("network", { set }).value;
    const boxes = new Map<string, Box>();
    const wires: { from: string; to: string; port: string }[] = [];
    const own = new Map(net.components.map((component) => [component.id, component]));
    const title = (source: Source): [key: string, title: string, kind: string] => {
      if ("coordinate" in source) return [`q${source.coordinate}`, model.about.coordinates[source.coordinate]?.key ?? "?", "coordinate"];
      if ("segment" in source) return [`s${source.segment}`, model.about.segments[source.segment]?.name ?? "?", "place of a segment"];
      const other = own.get(source.component);
      return [`c${source.component}`, net.names[source.component] ?? "?", other?.kind ?? "of another joint set"];
    };
    const put = (source: Source): string => {
      const [key, name, kind] = title(source);
      if (!boxes.has(key)) boxes.set(key, { key, title: name, kind, column: 0, row: 0 });
      return key;
    };
    for (const component of net.components) {
      const to = put({ component: component.id, output: 0 });
      for (const { port, from } of component.inputs) wires.push({ from: put(from), to, port });
    }
    for (const { segment, from } of net.outputs) {
      const to = `o${segment}`;
      boxes.set(to, { key: to, title: model.about.segments[segment]?.name ?? "?", kind: "moves", column: 0, row: 0 });
      wires.push({ from: put(from), to, port: "" });
    }
    // A box stands right of all that it reads; a wire that leads back would be a loop, which a model cannot have.
    for (let pass = 0; pass < boxes.size; pass++) {
      let moved = false;
      for (const wire of wires) {
        const [from, to] = [boxes.get(wire.from)!, boxes.get(wire.to)!];
        if (to.column <= from.column) {
          to.column = from.column + 1;
          moved = true;
        }
      }
      if (!moved) break;
    }
    const columns: Box[][] = [];
    for (const box of boxes.values()) (columns[box.column] ??= []).push(box);
    for (let k = 0; k < columns.length; k++) {
      const column = (columns[k] ??= []);
      // Each as high as what it reads, on the mean: fewer wires cross.
      const height = (box: Box) => {
        const read = wires.filter((wire) => wire.to === box.key).map((wire) => boxes.get(wire.from)!.row);
        return read.length ? read.reduce((a, b) => a + b, 0) / read.length : box.row;
      };
      if (k > 0) column.sort((a, b) => height(a) - height(b));
      column.forEach((box, row) => (box.row = row));
    }
    this.drawn(columns, boxes, wires);
    this.refresh(0);
  }

  /** Writes what flows now. */
  refresh(actor: number): void {
    if (!this.model || !this.root.isConnected) return;
    const live = this.model.ask<Record<string, number[]>>("live", { actor, set: this.set }).value;
    const { effective } = this.model.actor(actor);
    for (const [key, text] of this.values) {
      const number = Number(key.slice(1));
      if (key.startsWith("c")) text.textContent = listed(live[number] ?? []);
      else if (key.startsWith("q")) {
        const { place, kind } = this.model.about.coordinates[number]!;
        const count = kind === "orientation" ? 4 : 1;
        text.textContent = listed(Array.from(effective.subarray(place, place + count)));
      }
    }
  }

  private drawn(columns: Box[][], boxes: Map<string, Box>, wires: { from: string; to: string; port: string }[]): void {
    const rows = Math.max(1, ...columns.map((column) => column.length));
    const wide = columns.length * (WIDE + GAP.x) + GAP.x;
    const high = rows * (HIGH + GAP.y) + GAP.y;
    this.root.replaceChildren();
    this.root.setAttribute("viewBox", `0 0 ${wide} ${high}`);
    this.root.style.width = `${wide}px`;
    this.values.clear();
    this.count = boxes.size;
    const x = (box: Box) => GAP.x / 2 + box.column * (WIDE + GAP.x);
    const y = (box: Box) => GAP.y + box.row * (HIGH + GAP.y) + ((rows - (columns[box.column]?.length ?? 1)) * (HIGH + GAP.y)) / 2;
    for (const { from, to, port } of wires) {
      const [a, b] = [boxes.get(from)!, boxes.get(to)!];
      const [x1, y1, x2, y2] = [x(a) + WIDE, y(a) + HIGH / 2, x(b), y(b) + HIGH / 2];
      const bend = Math.max(20, (x2 - x1) / 2);
      const path = made("path", { d: `M${x1} ${y1}C${x1 + bend} ${y1} ${x2 - bend} ${y2} ${x2} ${y2}`, class: "wire" });
      path.append(words("title", {}, port ? `${a.title} → ${b.title}.${port}` : `${a.title} moves ${b.title}`));
      this.root.append(path);
    }
    for (const box of boxes.values()) {
      const shape = made("rect", { x: x(box), y: y(box), width: WIDE, height: HIGH, rx: box.key.startsWith("c") ? 3 : HIGH / 2 });
      const group = made("g", { class: `box ${box.key.charAt(0)}` });
      group.append(
        shape,
        words("text", { x: x(box) + 10, y: y(box) + 15, class: "title" }, cut(box.title, box.key.startsWith("c") ? 26 - box.kind.length : 24)),
        words("text", { x: x(box) + WIDE - 10, y: y(box) + 15, class: "kind" }, box.key.startsWith("c") ? box.kind : ""),
        words("title", {}, `${box.title}: ${box.kind}`),
      );
      const value = words("text", { x: x(box) + 10, y: y(box) + 31, class: "value" }, box.kind === "moves" ? "moves" : "");
      this.values.set(box.key, value as SVGTextElement);
      group.append(value);
      this.root.append(group);
    }
    this.root.setAttribute("aria-label", `network of ${boxes.size} boxes and ${wires.length} wires`);
  }
}

function made(tag: string, attributes: Record<string, string | number>): SVGElement {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

function words(tag: string, attributes: Record<string, string | number>, text: string): SVGElement {
  const element = made(tag, attributes);
  element.textContent = text;
  return element;
}

function cut(text: string, most: number): string {
  return text.length > most ? `${text.slice(0, most - 1)}…` : text;
}

/** Numbers as far as there is room for them. */
function listed(values: number[]): string {
  if (values.length < 4) return values.map(short).join("  ");
  const first = values.slice(0, 4).map((value) => value.toFixed(2));
  return first.join("  ") + (values.length > 4 ? " …" : "");
}

function short(value: number): string {
  return Math.abs(value) >= 100 ? value.toFixed(1) : value.toFixed(4);
}
