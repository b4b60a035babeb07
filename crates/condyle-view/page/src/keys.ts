// Key poses on the timeline: set, chosen, moved, deleted. What is between them is asked of the evaluator, the same code
// as that of `condyle convert KEYS.json OUT --rate N`.

import type { App } from "./app";
import type { Motion } from "./core";
import { download, element } from "./dom";

type Way = "spline" | "linear";

/** A key pose as its file has it: a time in seconds, and values by the names of coordinates. */
export interface Key {
  time: number;
  /** How coordinates leave it; without it on a spline. */
  between?: Way;
  [coordinate: string]: unknown;
}

/** Times that are nearer than this are the same, in seconds. */
const SAME = 5e-4;
/** How much time there is on the timeline after the last key, in seconds. */
const ROOM = 1;

export class Keys {
  readonly root: HTMLElement;
  /** In the order of time; a change makes a new list. */
  list: readonly Key[] = [];
  /** The key that is chosen. */
  chosen: Key | null = null;
  /** Frames a second of what is saved. */
  rate = 60;
  private motion: Motion | null = null;
  private readonly rows = element("ol", { class: "keys" });
  private readonly title = element("summary");
  private readonly now = element("input", { type: "number", step: 0.1, "aria-label": "time in seconds", id: "key-time" });
  private readonly way = element("select", { "aria-label": "how all keys are left", id: "key-way" });

  constructor(private readonly app: App) {
    for (const way of ["spline", "linear"]) this.way.append(element("option", { value: way }, way));
    this.way.addEventListener("change", () => this.change(this.list.map((key) => left(key, this.way.value as Way))));
    const rate = element("input", { type: "number", min: 1, value: this.rate, "aria-label": "frames a second", id: "key-rate" });
    rate.addEventListener("change", () => {
      if (rate.valueAsNumber > 0) this.rate = rate.valueAsNumber;
      this.change(this.list);
    });
    this.now.addEventListener("change", () => Number.isFinite(this.now.valueAsNumber) && this.go(this.now.valueAsNumber));
    const press = (text: string, title: string, id: string, onclick: () => void) => element("button", { title, id, onclick }, text);
    this.root = element(
      "details",
      { class: "panel", id: "keys" },
      this.title,
      element("div", {}, "at ", this.now, " s ", press("set key", "keep the pose as a key at this time (p)", "set-key", () => this.set())),
      this.rows,
      element("div", {}, "all: ", this.way, " ", rate, " a second "),
      press("save keys (JSON)", "the file that condyle convert --rate reads", "save-keys", () => this.save()),
    );
    this.shown();
  }

  /** Keeps the present pose as a key at a time, in place of one that is there. */
  set(time = this.app.timeline.time): void {
    const { model } = this.app;
    if (!model) return;
    time = Math.round(time * 1e3) / 1e3;
    const { effective } = model.actors[0]!;
    const own = model.about.coordinates.filter((c) => !c.follows);
    const values = own.map((c) => [c.key, c.kind === "orientation" ? [...effective.subarray(c.place, c.place + 4)] : effective[c.place]!]);
    const old = this.list.find((key) => same(key.time, time));
    const before = old ?? this.list.findLast((key) => key.time < time);
    const key: Key = { time, ...(before?.between && { between: before.between }), ...Object.fromEntries(values) };
    this.chosen = key;
    this.change([...this.list.filter((other) => other !== old), key]);
    this.go(time);
  }

  /** Moves a key to another time, if no other is there. */
  move(key: Key, time: number): void {
    time = Math.round(time * 1e3) / 1e3;
    if (!Number.isFinite(time) || this.list.some((other) => other !== key && same(other.time, time))) return this.shown();
    const moved = { ...key, time };
    this.chosen = moved;
    this.change(this.list.map((other) => (other === key ? moved : other)));
    this.go(time);
  }

  delete(key: Key): void {
    this.chosen = null;
    this.change(this.list.filter((other) => other !== key));
  }

  choose(key: Key): void {
    this.chosen = key;
    this.go(key.time);
  }

  /** Puts other keys on the timeline, and shows their motion. */
  change(list: readonly Key[]): void {
    const { app } = this;
    list = [...list].sort((a, b) => a.time - b.time);
    void app.attempt(() => {
      this.take(list);
      if (app.model) app.history.keep(app.model.actors[0]!.asked);
    });
    this.shown();
  }

  /** The motion of keys in the place of that of others; keys that are wrong are refused, and nothing changes. */
  private take(list: readonly Key[]): void {
    const { app } = this;
    const { model } = app;
    if (!model) return;
    const motion = list.length > 0 ? this.between(list) : null;
    this.list = list;
    if (!this.chosen || !list.includes(this.chosen)) this.chosen = null;
    const index = this.motion ? app.motions.indexOf(this.motion) : -1;
    this.motion = motion;
    if (motion) {
      const at = index < 0 ? app.motions.length : index;
      app.motions[at] = motion;
      if (app.chosen[0] !== at) app.chosen = [at, app.chosen[1] === at ? -1 : app.chosen[1]];
    } else if (index >= 0) {
      app.motions.splice(index, 1);
      app.chosen = [0, 1].map((which) => (app.chosen[which] === index ? -1 : app.chosen[which]! - Number(app.chosen[which]! > index))) as [number, number];
    }
    app.motionsChanged();
  }

  /** What the evaluator makes of keys. */
  private between(list: readonly Key[]): Motion {
    const { model } = this.app;
    const answer = model!.ask<{ times: number[] }>("keys", { poses: list, rate: this.rate, between: "spline" });
    const at = (time: number, actor: number) => void model!.ask("keyed", { actor, time });
    const until = Math.max(list.at(-1)!.time + ROOM, 2);
    const keyed = { at, from: Math.min(0, list[0]!.time), until, step: 1 / this.rate };
    return { name: "key poses", times: answer.value.times, width: model!.about.stored, values: new Float64Array(answer.bytes), markers: null, spans: [], keyed };
  }

  /** A model was opened; `kept` where it is the one before, edited. */
  opened(kept: boolean): void {
    const { list } = this;
    [this.motion, this.list] = [null, []];
    // Keys of an edited model that are still its own stay.
    if (kept && list.length > 0) void this.app.attempt(() => this.take(list));
    this.shown();
  }

  /** What an undo brings back. */
  restore(list: readonly Key[]): void {
    if (list !== this.list) void this.app.attempt(() => this.take(list));
    this.shown();
  }

  /** Goes to a time, also beyond the keys. */
  private go(time: number): void {
    const { timeline } = this.app;
    timeline.reach(time);
    timeline.go(time);
    this.shown();
  }

  /** Writes the time into its field. */
  timed(): void {
    if (document.activeElement !== this.now) this.now.value = this.app.timeline.time.toFixed(3).replace(/\.?0+$/, "");
  }

  save(): void {
    if (this.list.length > 0) download(`${this.app.title}-keys.json`, [`[\n${this.list.map((key) => JSON.stringify(key)).join(",\n")}\n]\n`], "application/json");
  }

  /** Shows the list, and the keys above the timeline. */
  private shown(): void {
    const { app, list } = this;
    this.title.textContent = `key poses (${list.length})`;
    const focused = document.activeElement?.getAttribute("data-key") ?? null;
    const lane = document.activeElement?.parentElement === app.timeline.lane;
    this.rows.replaceChildren(...list.map((key, index) => this.row(key, index)));
    if (list.length === 0) this.rows.append(element("li", {}, "none: pose the figure, and set one"));
    const ways = new Set(list.map((key) => key.between ?? "spline"));
    this.way.value = ways.size === 1 ? [...ways][0]! : list.length === 0 ? "spline" : "";
    app.timeline.lane.replaceChildren(...list.map((key, index) => this.mark(key, index)));
    app.timeline.lane.hidden = list.length === 0;
    if (focused !== null && this.chosen) {
      const at = `[data-key="${list.indexOf(this.chosen)}"]`;
      (lane ? app.timeline.lane : this.rows).querySelector<HTMLElement>(at)?.focus();
    }
    this.timed();
  }

  private row(key: Key, index: number): HTMLElement {
    const time = element("input", { type: "number", step: 0.1, value: key.time, "aria-label": `time of key ${index + 1} in seconds` });
    time.addEventListener("change", () => this.move(key, time.valueAsNumber));
    const way = element("select", { "aria-label": `how key ${index + 1} is left` });
    for (const name of ["spline", "linear"]) way.append(element("option", { value: name, selected: (key.between ?? "spline") === name }, name));
    way.addEventListener("change", () => this.change(this.list.map((other) => (other === key ? left(key, way.value as Way) : other))));
    const pressed = key === this.chosen;
    return element(
      "li",
      {},
      element("button", { "data-key": index, "aria-pressed": `${pressed}`, title: "go there", onclick: () => this.choose(key) }, `${index + 1}`),
      time,
      " s ",
      way,
      element("button", { class: "quiet", "aria-label": `delete key ${index + 1}`, title: "delete", onclick: () => this.delete(key) }, "✕"),
    );
  }

  /** A key above the timeline: it is dragged in time, or moved by arrows. */
  private mark(key: Key, index: number): HTMLElement {
    const { timeline } = this.app;
    const attributes = { class: "key", "data-key": index, "aria-pressed": `${key === this.chosen}`, "aria-label": `key ${index + 1} at ${key.time} s`, title: `key ${index + 1}: ${key.time} s (arrows move it, Delete deletes it)`, style: `left:${timeline.share(key.time)}%` };
    const mark = element("button", attributes);
    let time: number | null = null;
    mark.addEventListener("pointerdown", (event) => mark.setPointerCapture(event.pointerId));
    mark.addEventListener("pointermove", (event) => {
      if (!mark.hasPointerCapture(event.pointerId)) return;
      const to = Math.round(timeline.timeAt(event.clientX) * 100) / 100;
      if (time === null && Math.abs(to - key.time) < 0.02) return;
      time = to;
      mark.style.left = `${timeline.share(time)}%`;
      mark.title = `${time.toFixed(2)} s`;
    });
    mark.addEventListener("pointerup", () => {
      if (time === null) this.choose(key);
      else this.move(key, time);
    });
    mark.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (steps) this.move(key, key.time + (steps * (event.shiftKey ? 10 : 1)) / 100);
      else if (event.key === "Delete" || event.key === "Backspace") this.delete(key);
      else if (event.key === "Enter" || event.key === " ") this.choose(key);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    return mark;
  }
}

function same(a: number, b: number): boolean {
  return Math.abs(a - b) < SAME;
}

/** A key that is left in a way. */
function left(key: Key, between: Way): Key {
  const { time, between: _, ...values } = key;
  return between === "spline" ? { time, ...values } : { time, between, ...values };
}
