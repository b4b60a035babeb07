// Goals of a pose, as `condyle pose MODEL GOALS.toml` has them: listed with what each lacks, held while bones are dragged.

import { Matrix4, Quaternion } from "three";
import type { App } from "./app";
import { byId, download, element } from "./dom";
import { unitOf } from "./unit";

type Triple = [number, number, number];
/** A marker, a point of a segment, a place in the world, or where the point is at rest. */
type Place = string | { segment: string; at: Triple } | Triple;

/** A goal with the keys of its document; metres and radians. */
interface Goal {
  kind: Kind;
  name: string;
  weight?: number;
  [key: string]: unknown;
}

/** What should hold. */
export interface Goals {
  goals: Goal[];
  hold: string[];
  stiffness: [string, number][];
  limits: boolean;
}

interface Lack {
  off: number;
  angle: boolean;
  met: boolean;
}

const KINDS = ["pin", "point", "distance", "orientation", "axis", "look", "plane", "coordinate"] as const;
type Kind = Exclude<(typeof KINDS)[number], "pin">;
const NONE: Goals = { goals: [], hold: [], stiffness: [], limits: true };
/** How a field is shown: what a number is multiplied by, or something that is no number. */
const FIELDS: Record<Kind, [string, "cm" | "1" | "place" | "segment" | "side" | "turn" | "value"][]> = {
  point: [["point", "place"], ["at", "place"]],
  distance: [["points.0", "place"], ["points.1", "place"], ["distance", "cm"]],
  orientation: [["segment", "segment"], ["in", "segment"], ["quaternion", "turn"]],
  axis: [["segment", "segment"], ["axis", "1"], ["in", "segment"], ["along", "1"]],
  look: [["segment", "segment"], ["axis", "1"], ["through", "cm"], ["at", "place"]],
  plane: [["point", "place"], ["in", "segment"], ["origin", "cm"], ["normal", "1"], ["side", "side"]],
  coordinate: [["value", "value"]],
};

export class GoalPanel {
  readonly root: HTMLElement;
  /** Never changed, only replaced. */
  list: Goals = NONE;
  /** What each goal lacks now. */
  lacks: Lack[] = [];
  /** The pose to be near in place of the model's rest. */
  private near: number[] | null = null;
  private waiting = false;
  private readonly title = element("summary");
  private readonly rows = element("ol", { class: "goals" });
  private readonly said: HTMLElement[] = [];
  private readonly near0 = element("input", { type: "checkbox", id: "goals-near" });
  private readonly limits = element("input", { type: "checkbox", checked: true, id: "goals-limits" });
  private readonly names = element("datalist", { id: "goal-names" });

  constructor(private readonly app: App) {
    const kind = element("select", { "aria-label": "kind of goal", id: "goal-kind" });
    for (const name of KINDS) kind.append(element("option", { value: name }, name === "pin" ? "pin place and turn" : name));
    const press = (text: string, title: string, id: string, onclick: () => void) => element("button", { title, id, onclick }, text);
    this.near0.addEventListener("change", () => {
      this.near = this.near0.checked && app.model ? [...app.model.actors[0]!.effective] : null;
      this.change(this.list);
    });
    this.limits.addEventListener("change", () => this.change({ ...this.list, limits: this.limits.checked }));
    this.root = element(
      "details",
      { class: "panel", id: "goals" },
      this.title,
      element("div", {}, kind, " ", press("add", "a goal about the selected bone", "goal-add", () => this.add(kind.value as Kind | "pin"))),
      this.rows,
      element("div", {}, element("label", {}, this.limits, " within limits "), element("label", {}, this.near0, " near this pose")),
      press("solve", "search for the pose as condyle pose does: it takes some seconds", "goals-solve", () => this.search()),
      " ",
      press("save goals (TOML)", "the file that condyle pose reads", "save-goals", () => this.save()),
      this.names,
    );
    app.history.parts.push({ get: () => this.list, set: (list: Goals) => list !== this.list && this.put(list, "look") });
    app.onchange.push(() => this.lag());
    byId("coordinates").before(this.root);
    this.shown();
  }

  /** Adds a goal about the selected bone, as it is now. */
  add(kind: Kind | "pin"): void {
    const { model, selected } = this.app;
    if (!model) return;
    const { segments, coordinates, sets } = model.about;
    const index = selected ?? segments.length - 1;
    const { name, parent } = segments[index]!;
    const [actor] = model.actors;
    const own = { segment: name, at: [0, 0, 0] as Triple };
    const at = actor!.world(index, [0, 0, 0]);
    const m = actor!.places.subarray(16 * index, 16 * index + 16);
    const turn = new Quaternion().setFromRotationMatrix(new Matrix4().set(...(Array.from(m) as Parameters<Matrix4["set"]>)));
    const quaternion = turn.normalize().toArray();
    const other = parent === null ? null : actor!.world(parent, [0, 0, 0]);
    const coordinate = coordinates.find((c) => c.set === this.app.set && !c.follows && c.kind !== "orientation") ?? coordinates.find((c) => !c.follows && c.kind !== "orientation");
    const make = (kind: Kind, fields: object, called = name): Goal => ({ kind, name: this.free(kind, called), ...fields });
    const made: Goal[] = [];
    if (kind === "point" || kind === "pin") made.push(make("point", { point: own, at }));
    if (kind === "orientation" || kind === "pin") made.push(make("orientation", { segment: name, quaternion }));
    if (kind === "distance") {
      const away = other ? Math.hypot(...other.map((x, i) => x - at[i]!)) : Math.hypot(...at);
      made.push(make("distance", { points: [own, parent === null ? [0, 0, 0] : { segment: segments[parent]!.name, at: [0, 0, 0] }], distance: Math.max(away, 1e-3) }));
    }
    if (kind === "axis") made.push(make("axis", { segment: name, axis: [0, 1, 0], along: [m[1]!, m[5]!, m[9]!] }));
    if (kind === "look") made.push(make("look", { segment: name, axis: [1, 0, 0], through: [0, 0, 0], at: at.map((x, i) => x + m[4 * i]!), weight: 1e-3 }));
    if (kind === "plane") made.push(make("plane", { point: own, origin: at, normal: model.about.up === "y" ? [0, 1, 0] : [0, 0, 1], side: "on" }));
    if (kind === "coordinate" && coordinate) {
      const key = coordinates.filter((c) => c.name === coordinate.name).length > 1 ? `${sets[coordinate.set]}/${coordinate.name}` : coordinate.key;
      made.push({ kind, name: key, value: actor!.effective[coordinate.place]!, ...unitNamed(coordinate.kind) });
    }
    this.change({ ...this.list, goals: [...this.list.goals, ...made] });
  }

  /** Puts other goals: the figure follows them from where it is. */
  change(list: Goals, way: "follow" | "look" = "follow"): void {
    this.put(list, way);
    const actor = this.app.model?.actors[0];
    if (actor) this.app.history.keep(actor.asked);
  }

  /** Searches for the pose that the command finds. */
  search(): void {
    this.put(this.list, "search");
    const actor = this.app.model?.actors[0];
    if (actor) this.app.history.keep(actor.asked);
  }

  private put(list: Goals, way: "search" | "follow" | "look"): void {
    const { app } = this;
    this.list = list;
    this.limits.checked = list.limits;
    const text = list.goals.length > 0 ? written(list) : "";
    this.lacks = [];
    void app.attempt(() => {
      if (!app.model) return;
      this.lacks = app.model.ask<{ goals: Lack[] }>("goals", { text, rest: this.near, actor: 0, way }).value.goals;
      if (way !== "look") app.posed();
    });
    this.shown();
  }

  /** A model was opened; of the one before, edited, goals stay. */
  opened(kept: boolean): void {
    const { model } = this.app;
    if (!kept) [this.list, this.near, this.near0.checked] = [NONE, null, false];
    if (this.near && this.near.length !== model?.about.stored) [this.near, this.near0.checked] = [null, false];
    const points = [...(model?.about.markers ?? []), ...(model?.about.segments ?? [])];
    this.names.replaceChildren(...["rest", "world", ...points.map((point) => point.name)].map((value) => element("option", { value })));
    this.put(this.list, "look");
  }

  /** What goals lack after the pose has changed: not more often than it can be read. */
  private lag(): void {
    if (this.waiting || this.list.goals.length === 0) return;
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      const { model } = this.app;
      if (!model || this.list.goals.length === 0) return;
      this.lacks = model.ask<Lack[]>("lacking", { actor: 0 }).value;
      this.told();
    }, 120);
  }

  save(): void {
    download(`${this.app.title}-goals.toml`, [written(this.list)], "text/plain");
  }

  private free(kind: Kind, name: string): string {
    const taken = new Set(this.list.goals.filter((goal) => goal.kind === kind).map((goal) => goal.name));
    let found = name;
    for (let k = 2; taken.has(found); k++) found = `${name}_${k}`;
    return found;
  }

  /** Writes what goals lack beside them. */
  private told(): void {
    const missed = this.lacks.filter((lack) => !near(lack)).length;
    const count = this.list.goals.length;
    this.title.textContent = count === 0 ? "goals (0)" : `goals (${count}, ${missed === 0 ? "all reached" : `${missed} not reached`})`;
    this.said.forEach((output, index) => {
      const lack = this.lacks[index];
      output.textContent = lack ? `${near(lack) ? "✓" : "✗"} ${lack.angle ? `${((180 / Math.PI) * lack.off).toFixed(2)}°` : `${(1000 * lack.off).toFixed(2)} mm`}` : "";
      output.className = lack && !near(lack) ? "missed" : "";
    });
  }

  private shown(): void {
    this.said.length = 0;
    this.rows.replaceChildren(...this.list.goals.map((goal, index) => this.row(goal, index)));
    if (this.list.goals.length === 0) this.rows.append(element("li", {}, "none: select a bone, and add one"));
    this.told();
  }

  private row(goal: Goal, index: number): HTMLElement {
    const replace = (next: Goal | null) => this.change({ ...this.list, goals: this.list.goals.flatMap((other) => (other !== goal ? other : (next ?? []))) }, next ? "follow" : "look");
    const said = element("output", { "data-goal": index });
    this.said.push(said);
    const weight = element("input", { type: "number", step: "any", min: 0, value: goal.weight ?? "", placeholder: "exact", "aria-label": `weight of ${goal.name}` });
    weight.addEventListener("change", () => {
      const { weight: _, ...rest } = goal;
      replace(weight.valueAsNumber > 0 ? { ...goal, weight: weight.valueAsNumber } : (rest as Goal));
    });
    const fields = FIELDS[goal.kind].map(([key, how]) => element("div", { class: "field" }, element("span", {}, key.replace(".0", " 1").replace(".1", " 2")), ...this.field(goal, key, how, replace)));
    return element(
      "li",
      {},
      element("div", { class: "goal" }, element("b", {}, `${goal.kind} ${goal.name}`), said, element("button", { class: "quiet", "aria-label": `delete ${goal.kind} ${goal.name}`, title: "delete", onclick: () => replace(null) }, "✕")),
      ...fields,
      element("div", { class: "field" }, element("span", {}, "weight"), weight),
    );
  }

  /** What a field of a goal is edited by. */
  private field(goal: Goal, key: string, how: string, replace: (next: Goal) => void): (Node | string)[] {
    const [name, part] = key.split(".") as [string, string | undefined];
    const value = part === undefined ? goal[name] : (goal[name] as unknown[])[Number(part)];
    const set = (next: unknown) => {
      if (part === undefined) return replace(next === undefined ? without(goal, name) : { ...goal, [name]: next });
      replace({ ...goal, [name]: (goal[name] as unknown[]).map((old, i) => (i === Number(part) ? next : old)) });
    };
    const label = `${key} of ${goal.kind} ${goal.name}`;
    const numbers = (list: number[], factor: number, done: (next: number[]) => void): Node[] =>
      list.map((number, i) => {
        const input = element("input", { type: "number", step: "any", value: Number((number * factor).toFixed(factor === 1 ? 4 : 2)), "aria-label": `${label}${list.length > 1 ? `, ${"xyzw"[i]}` : ""}` });
        input.addEventListener("change", () => Number.isFinite(input.valueAsNumber) && done(list.map((old, k) => (k === i ? input.valueAsNumber / factor : old))));
        return input;
      });
    const text = (now: string, done: (next: string) => void, list: boolean): Node => {
      const input = element("input", { type: "text", value: now, "aria-label": label, ...(list && { list: "goal-names" }) });
      input.addEventListener("change", () => done(input.value.trim()));
      return input;
    };
    const segments = this.app.model?.about.segments ?? [];
    if (how === "segment") return [text(String(value ?? ""), (next) => set(next === "" ? undefined : next), true)];
    if (how === "side") {
      const select = element("select", { "aria-label": label });
      for (const side of ["on", "above"]) select.append(element("option", { value: side, selected: value === side }, side));
      select.addEventListener("change", () => set(select.value));
      return [select];
    }
    if (how === "turn") {
      if (goal["turn"] === "rest") return ["as at rest"];
      return numbers(value as number[], 1, set);
    }
    if (how === "value") {
      const unit = unitOf(goal["unit"] === "rad" ? "rotation" : goal["unit"] === "m" ? "translation" : "other");
      return [...numbers([Number(value)], unit.factor, ([next]) => set(next)), ` ${unit.sign}`];
    }
    if (how === "place") {
      const place = value as Place;
      const named = typeof place === "string" ? place : Array.isArray(place) ? "world" : place.segment;
      const chosen = (next: string) => {
        if (next === "world") set(Array.isArray(place) ? place : this.where(place));
        else set(segments.some((segment) => segment.name === next) && !this.app.model!.about.markers.some((m) => m.name === next) ? { segment: next, at: [0, 0, 0] } : next);
      };
      const box = text(named, chosen, true);
      if (typeof place === "string") return [box];
      const at = Array.isArray(place) ? place : place.at;
      return [box, ...numbers(at, 100, (next) => set(Array.isArray(place) ? next : { ...place, at: next })), " cm"];
    }
    const list = Array.isArray(value) ? (value as number[]) : [Number(value)];
    return [...numbers(list, how === "cm" ? 100 : 1, (next) => set(Array.isArray(value) ? next : next[0])), how === "cm" ? " cm" : ""];
  }

  /** Where a point of the model is now. */
  private where(place: Exclude<Place, Triple>): Triple {
    const model = this.app.model!;
    const marker = model.about.markers.find((m) => m.name === place);
    const [actor] = model.actors;
    if (typeof place === "string") return marker ? actor!.world(marker.segment, marker.point) : [0, 0, 0];
    return actor!.world(model.about.segments.findIndex((s) => s.name === place.segment), place.at);
  }
}

/** Whether a goal is reached as far as one sees: to a tenth of a millimetre, or to a hundredth of a degree. */
function near(lack: Lack): boolean {
  return lack.met || lack.off < (lack.angle ? 2e-4 : 1e-4);
}

function without(goal: Goal, key: string): Goal {
  const { [key]: _, ...rest } = goal;
  return rest as Goal;
}

function unitNamed(kind: string): { unit?: string } {
  return kind === "rotation" ? { unit: "rad" } : kind === "translation" ? { unit: "m" } : {};
}

/** The document of goals. */
export function written(list: Goals): string {
  const value = (v: unknown): string => {
    if (Array.isArray(v)) return `[${v.map(value).join(", ")}]`;
    if (typeof v === "object" && v !== null) return `{ ${Object.entries(v).map(([key, inner]) => `${key} = ${value(inner)}`).join(", ")} }`;
    return JSON.stringify(v);
  };
  const lines = ["condyle = 1", 'kind = "goals"'];
  if (list.hold.length > 0) lines.push(`hold = ${value(list.hold)}`);
  if (!list.limits) lines.push("limits = false");
  for (const { kind, name, ...fields } of list.goals) {
    lines.push("", `[${kind}.${JSON.stringify(name)}]`);
    for (const [key, inner] of Object.entries(fields)) lines.push(`${key} = ${value(inner)}`);
  }
  if (list.stiffness.length > 0) lines.push("", "[stiffness]", ...list.stiffness.map(([name, number]) => `${JSON.stringify(name)} = ${value(number)}`));
  return `${lines.join("\n")}\n`;
}
