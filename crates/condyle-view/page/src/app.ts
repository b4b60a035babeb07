// The page's state: a model, its poses, what is shown of them. Everything that changes goes through here.

import { Box3, Color, Vector3 } from "three";
import { type Core, type Mark, Model, type Motion, Refused, type Said, type Taken } from "./core";
import { Curves } from "./curves";
import { byId, element } from "./dom";
import { Figure, Shape } from "./figure";
import { frames } from "./files";
import { GoalPanel } from "./goals";
import { History } from "./history";
import { Inspector } from "./inspector";
import { Keys } from "./keys";
import { Labels } from "./labels";
import type { Look, Looks } from "./looks";
import { Markers } from "./markers";
import type { Quaternions } from "./quaternions";
import { take } from "./readers";
import type { Session } from "./session";
import { type Kind, Signs } from "./signs";
import { Sliders } from "./sliders";
import { Timeline, sample } from "./timeline";
import { View } from "./view";

export class App {
  readonly view = new View(byId<HTMLCanvasElement>("picture"));
  readonly timeline = new Timeline(() => this.timed());
  readonly curves = new Curves();
  readonly signs = new Signs();
  readonly markers = new Markers();
  readonly history = new History();
  readonly labels = new Labels(byId("labels"), this.view);
  readonly sliders: Sliders;
  readonly inspector: Inspector;
  readonly keys: Keys;
  readonly goals: GoalPanel;
  model: Model | null = null;
  title = "condyle";
  quaternions: Quaternions | null = null;
  motions: Motion[] = [];
  /** Which motion drives the figure, and which the second one; -1 is none, -2 all others, each with a figure of its own. */
  chosen: [number, number] = [-1, -1];
  sideBySide = false;
  withinLimits = true;
  /** The segment that is selected. */
  selected: number | null = null;
  /** The joint set whose limits, axes and network are shown. */
  set: number | null = null;
  show = new Set<Kind>();
  /** What is seen of figures. */
  looked = new Set<Look>(["bones", "meshes", "skin"]);
  figures: Figure[] = [];
  marks: Mark[] = [];
  /** Called when anything a control shows may have changed. */
  onchange: (() => void)[] = [];
  private shape: Shape | null = null;
  private looks: Looks | null = null;
  /** Names over figures of a row, and how high over the first segment they are. */
  private names: { figure: Figure; text: string; high: number }[] = [];
  private restless = false;
  /** The middle of the figure when the camera was last told of it. */
  private stood: Vector3 | null = null;

  constructor(
    readonly core: Core,
    readonly session: Session,
  ) {
    this.sliders = new Sliders({
      changed: (done) => this.changed(done),
      chosen: (set) => this.look(set),
      curve: (index) => {
        this.curves.toggle(index);
        this.timed();
      },
    });
    this.inspector = new Inspector(this, byId("right"));
    this.keys = new Keys(this);
    this.history.parts.push({ get: () => this.keys.list, set: (list: Keys["list"]) => this.keys.restore(list) });
    byId("coordinates").before(this.keys.root);
    this.goals = new GoalPanel(this);
    byId("coordinates").append(this.sliders.root);
    byId("bottom").append(this.curves.root, this.timeline.root);
    this.view.content.add(this.signs.group, this.markers.group);
    this.view.before.push(() => this.labels.place());
    this.view.controls.addEventListener("end", () => this.signed());
    const find = byId<HTMLInputElement>("find");
    find.addEventListener("input", () => this.model && this.sliders.find(find.value, this.model.about));
  }

  /** Shows a model; motions that came with it, and the old pose where `kept` and names are the same. */
  open(model: Model, title: string, motions: Motion[], kept = false): void {
    const before = kept && this.model ? named(this.model) : null;
    // Numbers of segments and sets may be others in the new model; names say what was looked at.
    const old = kept ? this.model?.about : undefined;
    const chosen = { segment: this.selected === null ? undefined : old?.segments[this.selected]?.name, set: this.set === null ? undefined : old?.sets[this.set] };
    // Nothing asks the old model any more.
    this.inspector.network.clear();
    this.model?.close();
    this.model = model;
    this.title = title;
    this.motions = motions;
    // Three and more stand in a row.
    this.sideBySide ||= motions.length > 2;
    this.chosen = [motions.length > 0 ? 0 : -1, motions.length > 2 ? -2 : -1];
    this.looks = null;
    [this.selected, this.set] = [index(model.about.segments, chosen.segment), index(model.about.sets, chosen.set)];
    this.curves.clear();
    byId("title").textContent = title;
    document.title = `${title} – condyle`;
    this.shaped(model);
    if (before) {
      for (const c of model.about.coordinates) {
        const value = before.get(c.key);
        if (value) model.actors[0]!.asked.set(value, c.place);
      }
      model.actors[0]!.pose(this.withinLimits);
    }
    this.sliders.shows(model.about, model.actors[0]!);
    this.view.shows(model.about);
    this.view.themed();
    if (!kept) this.view.look(this.box());
    this.stood = middle(model);
    this.keys.opened(kept);
    this.goals.opened(kept);
    this.history.begin(model.actors[0]!.asked);
    byId("waiting").hidden = true;
    this.motionsChanged();
    this.posed();
    this.accented();
    if (!kept && this.motions.length > 0) this.view.look(this.box());
  }

  /** Shows meshes and a skin that came with the model. */
  dress(looks: Looks | null): void {
    if (!this.model || !looks) return;
    this.looks = looks;
    this.shaped(this.model);
    this.motionsChanged();
    this.accented();
    this.posed();
  }

  /** Which looks there are to choose from. */
  get lookable(): Look[] {
    return this.shape?.has ?? [];
  }

  /** Shows one look more, or no more. */
  looksLike(look: Look): void {
    if (!this.looked.delete(look)) this.looked.add(look);
    this.relooked();
    this.signed();
    for (const call of this.onchange) call();
  }

  private relooked(): void {
    // What cannot be chosen is seen.
    const bare = this.lookable.length === 0;
    this.shape?.shows(bare ? new Set<Look>(["bones"]) : this.looked);
    for (const figure of this.figures) figure.looks(this.looked);
  }

  private shaped(model: Model): void {
    for (const figure of this.figures.splice(0)) {
      this.view.content.remove(figure.mesh);
      figure.dispose();
    }
    this.shape?.dispose();
    this.shape = new Shape(model, this.looks);
    this.figures = [new Figure(this.shape, model.actors[0]!)];
    this.view.content.add(this.figures[0]!.mesh);
    this.relooked();
  }

  /** Reads files that a person gives. */
  async take(files: Iterable<File>): Promise<void> {
    // A model first, whatever the order in which they were dropped.
    const all = await Promise.all([...files].map(async (file) => ({ file, bytes: new Uint8Array(await file.arrayBuffer()) })));
    const models = /\.(toml|osim|xml|json|urdf|skel|asf|glb|gltf|vrm|npz|bvh)$/i;
    all.sort((a, b) => Number(models.test(b.file.name)) - Number(models.test(a.file.name)));
    for (const { file, bytes } of all) {
      await this.attempt(async () => this.took(await take(this.core, file.name, bytes, this.model), file.name));
    }
  }

  /** Shows what was read. */
  took(taken: Taken, name: string): void {
    if (taken.model) {
      this.open(taken.model, name.replace(/\.[^.]*$/, ""), taken.motion ? [taken.motion] : []);
    } else if (taken.goals) {
      this.goals.change(taken.goals);
    } else if (taken.keys) {
      this.keys.change(taken.keys);
      this.timed();
    } else if (taken.motion && this.model && taken.motion.times.length === 1 && !taken.motion.markers) {
      // One frame is a pose, not a motion.
      this.chosen = [-1, -1];
      this.motionsChanged();
      this.put(Float64Array.from(taken.motion.values), true);
    } else if (taken.motion) {
      this.motions.push(taken.motion);
      this.chosen = [this.motions.length - 1, this.chosen[0]];
      if (taken.motion.markers) this.show.add("markers");
      this.motionsChanged();
      this.timed();
    }
    if (taken.warnings.length > 0) this.say(taken.warnings);
  }

  /** Runs something that may be refused; what is wrong is shown. */
  async attempt(work: () => void | Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof Refused) this.say(error.faults);
      else this.say([{ severity: "error", text: error instanceof Error ? error.message : String(error) }]);
    }
  }

  /** Shows sentences over the picture until they are sent away. */
  say(said: Said[]): void {
    const box = byId("fault");
    const shut = element("button", { onclick: () => (box.hidden = true), "aria-label": "close" }, "✕");
    const line = (one: Said) => element("div", {}, `${one.severity}: ${one.line ? `line ${one.line}: ` : ""}${one.text}`);
    box.replaceChildren(shut, ...said.slice(0, 20).map(line));
    if (said.length > 20) box.append(element("div", {}, `and ${said.length - 20} more`));
    box.hidden = said.length === 0;
  }

  /** A slider or a number changed what is asked. */
  changed(done: boolean): void {
    const actor = this.model?.actors[0];
    if (!actor) return;
    actor.pose(this.withinLimits);
    if (done) this.history.keep(actor.asked);
    this.posed();
  }

  /** Puts a whole pose. */
  put(pose: Float64Array, keep: boolean): void {
    this.model?.actors[0]!.asked.set(pose);
    this.changed(keep);
  }

  undo(): void {
    const pose = this.history.undo();
    if (pose) this.put(pose, false);
  }

  redo(): void {
    const pose = this.history.redo();
    if (pose) this.put(pose, false);
  }

  neutral(): void {
    if (!this.model) return;
    const pose = new Float64Array(this.model.about.stored);
    for (const c of this.model.about.coordinates) pose.set(c.default, c.place);
    this.put(pose, true);
  }

  /** Shows everything anew after a pose was evaluated. */
  posed(): void {
    for (const figure of this.figures) figure.moved();
    this.sliders.refresh();
    this.inspector.refresh();
    this.signed();
    for (const call of this.onchange) call();
  }

  /** Draws signs anew, once for each picture. */
  signed(): void {
    if (this.restless) return;
    this.restless = true;
    requestAnimationFrame(() => {
      this.restless = false;
      this.resigned();
      this.view.draw();
    });
  }

  private resigned(): void {
    const { model, view } = this;
    if (!model) return;
    const at = this.set === null ? [] : [model.about.sets[this.set]!];
    // Limits of a whole body are hundreds of sweeps: they are drawn of what is looked at.
    const one: Kind[] = ["limits", "centres"];
    const show = [...this.show].filter((kind) => kind !== "markers" && (at.length > 0 || !one.includes(kind)));
    try {
      this.signs.update(model, { actor: 0, show, at, unit: view.unit }, view.size);
    } catch (error) {
      this.signs.clear();
      if (error instanceof Refused) this.say(error.faults);
    }
    const motion = this.motions[this.chosen[0]] ?? null;
    this.markers.update(model.actors[0]!, motion, this.timeline.time, 0.008 * Math.min(1, view.unit / 0.05), this.show.has("markers"));
    this.inspector.missed();
    const up = model.about.up === "y" ? 1 : 2;
    const named = this.names.map(({ figure, text, high }) => {
      const at = figure.actor.world(0, [0, 0, 0]);
      figure.mesh.position.toArray().forEach((by, axis) => (at[axis]! += by));
      at[up] += high;
      return { at, text, colour: 0x26_2b_33 };
    });
    this.labels.set([...named, ...this.signs.labels]);
  }

  /** A motion was added or another one is to be seen. */
  motionsChanged(): void {
    const { model } = this;
    if (!model) return;
    const count = Math.max(this.running().length, 1);
    while (this.figures.length < count) {
      const figure = new Figure(this.shape!, model.actor(this.figures.length));
      this.figures.push(figure);
      this.view.content.add(figure.mesh);
    }
    for (const figure of this.figures.splice(count)) {
      this.view.content.remove(figure.mesh);
      figure.dispose();
    }
    this.relooked();
    const wide = this.figures[0]!.box().getSize(new Vector3());
    this.figures.forEach((other, index) => {
      if (index === 0) return;
      const tint = TINTS[(index - 1) % TINTS.length]!;
      other.ghost(!this.sideBySide, tint);
      other.mesh.position.set(0, 0, 0);
      if (this.sideBySide) other.mesh.position.copy(sideways(model, index * 1.2 * Math.max(wide.x, wide.z, 0.5)));
    });
    this.names = [];
    if (this.sideBySide && count > 1) {
      const up = model.about.up;
      this.names = this.running().map((index, which) => {
        const figure = this.figures[which]!;
        const high = figure.box().max[up] + 0.04 * (wide[up] || 1) - figure.actor.world(0, [0, 0, 0])[up === "y" ? 1 : 2];
        return { figure, text: this.motions[index]?.name ?? "pose", high };
      });
    }
    const seen = this.seen();
    this.marks = seen.flatMap((motion) => motion.spans);
    this.timeline.shows(seen, this.marks);
    this.inspector.build();
    // What is broken takes a moment for long motions: the picture comes first.
    if (seen[0]) setTimeout(() => this.check(seen[0]!), 50);
    for (const call of this.onchange) call();
  }

  /** The motions that are seen. */
  seen(): Motion[] {
    return this.running().flatMap((index) => this.motions[index] ?? []);
  }

  /** The motions that are seen, by their numbers: one for each figure. */
  private running(): number[] {
    const [first, second] = this.chosen;
    const others = second === -2 ? [...this.motions.keys()].filter((index) => index !== first) : [second];
    return [first, ...others].filter((index, which) => (which === 0 && others.some((other) => other >= 0)) || index >= 0);
  }

  /** The time has changed. */
  timed(): void {
    const { model } = this;
    if (!model) return;
    this.running().forEach((index, which) => {
      const motion = this.motions[index];
      if (!motion || motion.times.length === 0) return;
      const actor = model.actor(which);
      if (motion.keyed) motion.keyed.at(this.timeline.time, which);
      else sample(motion, this.timeline.time, actor.asked);
      // A motion is shown as it is, so that what it breaks is seen.
      actor.pose(false);
    });
    this.curves.draw(model.about, this.seen(), this.timeline.time);
    this.keys.timed();
    const now = middle(model);
    if (this.stood && this.chosen[0] >= 0) this.view.along(now.clone().sub(this.stood));
    this.stood = now;
    this.posed();
  }

  private check(motion: Motion): void {
    if (!this.model || this.motions[this.chosen[0]] !== motion) return;
    void this.attempt(() => {
      const found = this.model!.ask<{ spans: Mark[] }>("check", frames(motion)).value.spans;
      const order = ["violation", "jump", "limited", "undetermined"];
      this.marks = [...found, ...this.marks].sort((a, b) => order.indexOf(a.kind) - order.indexOf(b.kind) || a.from - b.from);
      this.timeline.marked(this.marks);
      this.inspector.build();
    });
  }

  /** Selects a segment. */
  select(segment: number | null): void {
    this.selected = segment;
    const { model } = this;
    if (!model) return;
    if (segment !== null) {
      // A bone without coordinates of its own goes with its parent's.
      let at: number | null = segment;
      const has = (set: number | null | undefined) => set != null && model.about.coordinates.some((c) => c.set === set);
      while (at !== null && !has(model.about.segments[at]?.set)) at = model.about.segments[at]?.parent ?? null;
      const set = at === null ? null : (model.about.segments[at]?.set ?? null);
      if (set !== null) {
        this.set = set;
        this.sliders.open(set, model.about);
      }
    }
    this.accented();
  }

  /** Shows what is selected. */
  private accented(): void {
    const { model, selected } = this;
    const accent = new Color(model?.about.colours["accent"] ?? "#e06a2b");
    this.shape?.accent(new Set(selected === null ? [] : [selected]), accent);
    this.inspector.build();
    this.signed();
  }

  /** Looks at a joint set. */
  look(set: number): void {
    this.set = set;
    this.inspector.build();
    this.signed();
  }

  toggle(kind: Kind): void {
    if (!this.show.delete(kind)) this.show.add(kind);
    this.signed();
    for (const call of this.onchange) call();
  }

  limits(on: boolean): void {
    this.withinLimits = on;
    this.changed(false);
  }

  /** The box of all figures. */
  box(): Box3 {
    return this.figures.reduce((box, figure) => box.union(figure.box()), new Box3());
  }

  hit(ray: import("three").Ray): ReturnType<Shape["hit"]> {
    return this.shape?.hit(ray, this.model!.actors[0]!, new Vector3()) ?? null;
  }
}

/** Where something of a name is in a list. */
function index(list: readonly (string | { name: string })[], name: string | undefined): number | null {
  const at = name === undefined ? -1 : list.findIndex((one) => (typeof one === "string" ? one : one.name) === name);
  return at < 0 ? null : at;
}

/** The asked values of a model by name. */
function named(model: Model): Map<string, Float64Array> {
  const { asked } = model.actors[0]!;
  const value = (place: number, kind: string) => asked.slice(place, place + (kind === "orientation" ? 4 : 1));
  return new Map(model.about.coordinates.map((c) => [c.key, value(c.place, c.kind)]));
}

/** Colours that are laid over figures beside the first one. */
const TINTS = [0x86b4ff, 0xffb877, 0x9fdc8c, 0xd9a8ff, 0xff9fae, 0x7fd8d8];

/** The mean of the origins of all segments. */
function middle(model: Model): Vector3 {
  const { places } = model.actors[0]!;
  const sum = new Vector3();
  for (let at = 0; at < places.length; at += 16) sum.add(new Vector3(places[at + 3], places[at + 7], places[at + 11]));
  return sum.multiplyScalar(16 / Math.max(places.length, 16));
}

function sideways(model: Model, by: number): Vector3 {
  const up = model.about.up === "y" ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
  return new Vector3(...model.about.ahead).cross(up).normalize().multiplyScalar(by);
}
