// A slider for each independent coordinate, by joint set; what follows others is shown moving.

import type { Actor, Coordinate, Described } from "./core";
import { element } from "./dom";
import { type Unit, quaternionOf, reach, shown, unitOf, vectorOf } from "./unit";

export interface Changes {
  /** A number is being changed; `done` at the end of a drag. */
  changed(done: boolean): void;
  /** A joint set is looked at. */
  chosen(set: number): void;
  /** A curve is wanted, or not any more. */
  curve(coordinate: number): void;
}

/** A row: what writes and reads one number that a person sees. */
interface Row {
  coordinate: Coordinate;
  root: HTMLElement;
  refresh(actor: Actor): void;
}

export class Sliders {
  readonly root = element("div", { class: "sliders" });
  private rows: Row[] = [];
  private groups: HTMLDetailsElement[] = [];
  private actor: Actor | null = null;

  constructor(private readonly changes: Changes) {}

  /** Makes the controls of a model. */
  shows(about: Described, actor: Actor): void {
    this.actor = actor;
    this.rows = [];
    this.groups = about.sets.map((name, set) => {
      const own = about.coordinates.map((c, index) => [c, index] as const).filter(([c]) => c.set === set);
      const free = own.filter(([c]) => !c.follows).length;
      const count = element("small", {}, free === own.length ? `${free}` : `${free} + ${own.length - free} following`);
      const group = element("details", { class: "set", "data-set": set }, element("summary", {}, name, " ", count));
      group.addEventListener("toggle", () => {
        if (!group.open) return;
        // Rows are made when they are first seen: a body has more than a hundred.
        if (group.childElementCount === 1) {
          for (const [coordinate, index] of own) {
            for (const row of this.made(coordinate, index)) {
              this.rows.push(row);
              group.append(row.root);
              row.refresh(actor);
            }
          }
        }
        this.changes.chosen(set);
      });
      return group;
    });
    this.root.replaceChildren(...this.groups.filter((_, set) => about.coordinates.some((c) => c.set === set)));
  }

  /** Opens one joint set. */
  open(set: number, about: Described): void {
    const group = this.groups[set];
    if (!group?.isConnected) return;
    if (!about.coordinates.some((c) => c.set === set)) return;
    group.open = true;
    group.scrollIntoView({ block: "nearest" });
  }

  /** Shows only sets and coordinates whose names contain some letters. */
  find(letters: string, about: Described): void {
    const wanted = letters.trim().toLowerCase();
    const fits = (text: string) => text.toLowerCase().includes(wanted);
    this.groups.forEach((group, set) => {
      const own = about.coordinates.filter((c) => c.set === set);
      group.hidden = wanted !== "" && !fits(about.sets[set] ?? "") && !own.some((c) => fits(c.key));
    });
  }

  refresh(): void {
    if (!this.actor) return;
    for (const row of this.rows) if (row.root.parentElement?.hasAttribute("open")) row.refresh(this.actor);
  }

  private made(coordinate: Coordinate, index: number): Row[] {
    if (coordinate.follows) return [this.following(coordinate, index)];
    const unit = unitOf(coordinate.kind);
    if (coordinate.kind !== "orientation") {
      const { place } = coordinate;
      const at = {
        read: (numbers: Float64Array) => numbers[place] ?? 0,
        write: (numbers: Float64Array, value: number) => void (numbers[place] = value),
      };
      return [this.slider(coordinate, index, coordinate.name, unit, at)];
    }
    return ["x", "y", "z"].map((axis, k) => {
      const four = (numbers: Float64Array) =>
        Array.from(numbers.subarray(coordinate.place, coordinate.place + 4)) as [number, number, number, number];
      const at = {
        read: (numbers: Float64Array) => vectorOf(four(numbers))[k]!,
        write: (numbers: Float64Array, value: number) => {
          const vector = vectorOf(four(numbers));
          vector[k] = value;
          numbers.set(quaternionOf(vector), coordinate.place);
        },
      };
      return this.slider(coordinate, index, `${coordinate.name} ${axis}`, unit, at);
    });
  }

  private slider(
    coordinate: Coordinate,
    index: number,
    name: string,
    unit: Unit,
    at: { read(numbers: Float64Array): number; write(numbers: Float64Array, value: number): void },
  ): Row {
    const [low, high] = reach(coordinate);
    const scaled = (x: number) => x * unit.factor;
    const limits = { min: scaled(low), max: scaled(high), step: "any" };
    const neutral = coordinate.kind === "orientation" ? 0 : (coordinate.default[0] ?? 0);
    const label = `${coordinate.key}${name === coordinate.name ? "" : name.slice(coordinate.name.length)}`;
    const slide = element("input", { type: "range", ...limits, "aria-label": label, "data-key": label });
    const number = element("input", { type: "number", step: "any", "aria-label": `${label}, requested` });
    const effective = element("output", { title: "what limits and couplings leave of it" });
    const range = `${bound(coordinate.lower, unit)} to ${bound(coordinate.upper, unit)} ${unit.sign}`;
    const title = [label, `range ${range}${coordinate.enforced ? "" : " (not enforced)"}`];
    if (coordinate.typical) title.push(`people reach ${coordinate.typical.map((x) => shown(x, unit)).join(" to ")}`);
    if (coordinate.source) title.push(coordinate.source);
    const set = (value: number, done: boolean) => {
      at.write(this.actor!.asked, value);
      this.changes.changed(done);
    };
    slide.addEventListener("input", () => set(slide.valueAsNumber / unit.factor, false));
    slide.addEventListener("change", () => this.changes.changed(true));
    number.addEventListener("change", () => {
      if (Number.isFinite(number.valueAsNumber)) set(number.valueAsNumber / unit.factor, true);
    });
    const reset = element(
      "button",
      { class: "quiet", title: `neutral: ${shown(neutral, unit)} ${unit.sign}`, "aria-label": `0: ${label} to its neutral value`, onclick: () => set(neutral, true) },
      "0",
    );
    const curve = element(
      "button",
      { class: "quiet", title: "its curve over time", "aria-label": `curve of ${label}`, onclick: () => this.changes.curve(index) },
      "~",
    );
    const mark = element("i", { class: "neutral", style: `--at:${(neutral - low) / (high - low || 1)}` });
    const root = element(
      "div",
      { class: "row", title: title.join("\n") },
      element("span", { class: "name" }, name),
      element("span", { class: "track" }, slide, mark),
      number,
      element("span", { class: "unit" }, unit.sign),
      effective,
      reset,
      curve,
    );
    const refresh = (actor: Actor) => {
      const asked = at.read(actor.asked);
      const held = at.read(actor.effective);
      if (document.activeElement !== slide || Math.abs(slide.valueAsNumber - scaled(asked)) > 1e-9) {
        slide.value = String(scaled(asked));
      }
      if (document.activeElement !== number) number.value = shown(asked, unit);
      const off = Math.abs(asked - held) * unit.factor > 0.5 * 10 ** -unit.digits;
      effective.value = off ? `→ ${shown(held, unit)}` : "";
      root.classList.toggle("held", off);
    };
    return { coordinate, root, refresh };
  }

  private following(coordinate: Coordinate, index: number): Row {
    const unit = unitOf(coordinate.kind);
    const [low, high] = reach(coordinate);
    const bar = element("i", { class: "now" });
    const value = element("output");
    const curve = element(
      "button",
      { class: "quiet", title: "its curve over time", "aria-label": `curve of ${coordinate.key}`, onclick: () => this.changes.curve(index) },
      "~",
    );
    const root = element(
      "div",
      { class: "row follows", title: `${coordinate.key} follows others` },
      element("span", { class: "name" }, coordinate.name),
      element("span", { class: "track" }, bar),
      value,
      element("span", { class: "unit" }, unit.sign),
      element("output"),
      element("span", { class: "quiet", title: "it follows others" }, "⇠"),
      curve,
    );
    const refresh = (actor: Actor) => {
      const now = actor.effective[coordinate.place] ?? 0;
      bar.style.setProperty("--at", String(Math.min(1, Math.max(0, (now - low) / (high - low || 1)))));
      value.value = shown(now, unit);
    };
    return { coordinate, root, refresh };
  }
}

function bound(value: number | null, unit: Unit): string {
  return value === null ? "any" : shown(value, unit);
}
