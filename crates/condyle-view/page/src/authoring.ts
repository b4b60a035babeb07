// The panel that edits the model's text: numbers of what is selected, handles, what will be written where.

import { type Said } from "./core";
import type { App } from "./app";
import { element } from "./dom";
import { Handle } from "./handle";

type Path = (string | number)[];

interface Way {
  kind: string;
  sentence: string;
}

interface Editable {
  path: Path;
  value: number;
  unit: string;
  written: string;
  origin: { kind: string; file: string; line: number; column: number };
  mirrored: Path | null;
  ways: Way[];
}

interface Fault {
  file: string;
  line: number;
  column: number;
  text: string;
  excerpt: string;
}

interface Listed {
  file: string;
  there: boolean;
  values: Editable[];
  undo: boolean;
  redo: boolean;
  fault: Fault | null;
}

interface Answered {
  line?: number;
  file?: string;
  needs?: "confirm" | "reload";
  sentence?: string;
  fault?: Fault;
  error?: string;
}

/** A number of a list that is edited, on the side that was selected. */
interface Row {
  value: Editable;
  path: Path;
}

/** Starts the panel; the server edits the file and tells changes. */
export function authoring(app: App): void {
  const panel = new Panel(app);
  app.inspector.also.push(panel.root);
  app.inspector.onbuild.push(() => panel.build());
  app.inspector.build();
  void panel.load();
}

class Panel {
  readonly root = element("section", { id: "authoring", "aria-label": "the model's text" });
  private listed: Listed | null = null;
  private all = false;
  private readonly open = new Set<string>();
  private handles = false;
  private readonly handle: Handle;
  /** Lists that are asked for and have not come. */
  private loading = 0;
  // What a person may be typing in or is on stays while the rest is built anew.
  private readonly where = element("p", { class: "soft" });
  private readonly undo = element("button", { id: "text-undo", disabled: true, onclick: () => void this.send("undo", {}) }, "undo in file");
  private readonly redo = element("button", { id: "text-redo", disabled: true, onclick: () => void this.send("redo", {}) }, "redo");
  private readonly search = element("input", { type: "search", placeholder: "find a number", "aria-label": "find a number" });
  private readonly list = element("div");
  private readonly add = element("div");
  /** What new parts are added to, when that was built. */
  private added: string | null = null;
  /** Fields that go because others take their place are not left by a person. */
  private building = false;

  constructor(private readonly app: App) {
    this.handle = new Handle(app);
    this.search.addEventListener("input", () => this.build());
    const every = element("input", { type: "checkbox" });
    every.addEventListener("change", () => {
      this.all = every.checked;
      this.build();
    });
    const handles = element("input", { type: "checkbox", id: "handles" });
    handles.addEventListener("change", () => {
      this.handles = handles.checked;
      this.build();
    });
    const first = element("div", {}, this.undo, " ", this.redo, " ", element("label", {}, every, " all of the model"), " ", element("label", {}, handles, " handles"));
    this.root.replaceChildren(element("h2", {}, "the model’s text"), this.where, first, this.search, this.list, this.add);
    this.root.hidden = true;
  }

  /** Reads the list anew; the newest answer counts. */
  async load(): Promise<void> {
    const mine = ++this.loading;
    this.root.ariaBusy = "true";
    const response = await fetch("editable.json", { cache: "no-store" });
    const listed = response.ok ? ((await response.json()) as Listed) : null;
    if (mine !== this.loading) return;
    this.root.ariaBusy = "false";
    if (!listed) return;
    this.listed = listed;
    if (listed.fault) this.app.say([said(listed.fault)]);
    this.build();
  }

  build(): void {
    const { listed } = this;
    if (!listed) return;
    const rows = this.rows(listed);
    const groups = new Map<string, Row[]>();
    for (const row of rows) {
      const name = shown(row.path.filter((step, at) => typeof step === "string" || at < row.path.length - 1));
      groups.set(name, [...(groups.get(name) ?? []), row]);
    }
    this.hold(listed);
    const most = 120;
    const typing = this.typing();
    this.building = true;
    this.list.replaceChildren(
      ...[...groups].slice(0, most).map(([name, group]) => this.group(name, group)),
      groups.size > most ? element("p", { class: "soft" }, `and ${groups.size - most} more: find them by name`) : "",
    );
    this.building = false;
    if (typing) this.type(typing);
    this.where.textContent = listed.there ? listed.file : `${listed.file} (made by the first edit)`;
    [this.undo.disabled, this.redo.disabled] = [!listed.undo, !listed.redo];
    const added = `${this.app.selected} ${this.app.set}`;
    if (added !== this.added) this.add.replaceChildren(this.adding());
    this.added = added;
    this.root.hidden = false;
  }

  /** The number that a person is typing. */
  private typing(): { name: string; text: string } | null {
    const at = document.activeElement;
    const name = at instanceof HTMLInputElement && this.list.contains(at) ? at.dataset["number"] : undefined;
    return name === undefined ? null : { name, text: (at as HTMLInputElement).value };
  }

  private type({ name, text }: { name: string; text: string }): void {
    const field = [...this.list.querySelectorAll("input")].find((field) => field.dataset["number"] === name);
    if (!field) return;
    field.value = text;
    field.focus({ preventScroll: true });
  }

  /** Shows handles of the selected segment’s place in its parent, if its text gives one. */
  private hold(listed: Listed): void {
    const segment = this.app.selected === null ? null : this.app.model?.about.segments[this.app.selected];
    const numbers = [0, 1, 2].map((axis) => listed.values.find(({ path }) => path.length === 4 && path[0] === "segment" && path[1] === segment?.name && path[2] === "at" && path[3] === axis));
    const [x, y, z] = numbers;
    if (!this.handles || !segment || !x || !y || !z) return this.handle.hold(null);
    const moved = (axis: number, value: number) => void this.set(numbers[axis]!.path, value);
    this.handle.hold({ frame: segment.parent, at: [x.value, y.value, z.value], moved });
  }

  /** The numbers of what is selected: of the segment, of its joint set, of markers and shapes on it. */
  private rows(listed: Listed): Row[] {
    const { model, selected, set } = this.app;
    const segment = selected === null ? null : (model?.about.segments[selected]?.name ?? null);
    const joints = set === null ? null : (model?.about.sets[set] ?? null);
    const found: Row[] = [];
    const find = this.search.value;
    for (const value of listed.values) {
      for (const path of value.mirrored ? [value.path, value.mirrored] : [value.path]) {
        const [family, name] = path;
        const mine =
          (family === "segment" && name === segment) ||
          ((family === "joint" || family === "joint_set") && name === joints) ||
          (segment === null && joints === null && family === "constants");
        const named = find !== "" && shown(path).includes(find);
        if (find === "" ? mine || (this.all && path === value.path) : named) found.push({ value, path });
      }
    }
    return found;
  }

  private group(name: string, rows: Row[]): HTMLElement {
    const fields = rows.map((row) => this.field(row));
    const many = rows.length > 4;
    const unit = rows[0]!.value.unit;
    const first = rows[0]!.value.origin;
    const sign = first.kind === "plain" ? "" : `, ${first.kind}`;
    const head = element("span", { class: "soft" }, ` ${unit}${sign}, line ${first.line}`);
    if (!many) return element("fieldset", { "data-path": name }, element("legend", {}, name, head), ...fields, this.nudges(rows));
    const details = element("details", { "data-path": name, open: this.open.has(name) }, element("summary", {}, name, head), ...fields);
    details.addEventListener("toggle", () => (details.open ? this.open.add(name) : this.open.delete(name)));
    return details;
  }

  private field({ value, path }: Row): HTMLElement {
    const name = shown(path);
    const field = element("input", { type: "number", step: "any", value: String(rounded(value.value)), "aria-label": `${name} in ${value.unit || "its unit"}`, "data-number": name });
    field.title = value.written;
    if (value.ways.length < 2) {
      // Asked for once, whether it is by the key or by leaving: a field that was built anew under what is typed fires
      // no change.
      let asked = rounded(value.value);
      const changed = () => {
        const typed = Number(field.value);
        if (field.value === "" || !Number.isFinite(typed)) field.value = String(asked);
        else if (typed !== asked) void this.set(path, (asked = typed));
      };
      field.addEventListener("keydown", (event) => event.key === "Enter" && changed());
      field.addEventListener("blur", () => !this.building && changed());
      return element("span", {}, field);
    }
    const way = element("select", { "aria-label": `how ${name} is changed` });
    value.ways.forEach((one, index) => way.append(element("option", { value: one.kind, selected: index === 0 }, one.kind)));
    way.title = value.ways.map((one) => `${one.kind}: ${one.sentence}`).join("\n");
    const changed = () => void this.set(path, Number(field.value), way.value);
    field.addEventListener("keydown", (event) => event.key === "Enter" && changed());
    return element("span", {}, field, way, element("button", { onclick: changed, "aria-label": `write ${name}` }, "write"));
  }

  /** Small steps for points and turns, as a handle for those who use keys: a millimetre or a degree. */
  private nudges(rows: Row[]): HTMLElement | string {
    const unit = rows[0]!.value.unit;
    if (rows.length !== 3 || !["m", "deg"].includes(unit) || typeof rows[0]!.path.at(-1) !== "number") return "";
    const step = unit === "m" ? 0.001 : 1;
    const buttons = rows.flatMap((row, axis) =>
      [-1, 1].map((sign) => {
        const label = `${"xyz"[axis]} ${sign > 0 ? "+" : "−"}`;
        const move = () => void this.set(row.path, rounded(row.value.value + sign * step));
        return element("button", { onclick: move, "aria-label": `${shown(row.path)} ${sign * step} ${unit}` }, label);
      }),
    );
    return element("div", { class: "nudges" }, ...buttons);
  }

  /** A new segment, component or wire. */
  private adding(): HTMLElement {
    const { model, selected, set } = this.app;
    const input = (label: string, value: string) => element("input", { "aria-label": label, placeholder: label, value });
    const parent = selected === null ? "" : (model?.about.segments[selected]?.name ?? "");
    const [name, place] = [input("name of a segment", ""), input("at x, y, z in m", "0, 0, 0")];
    const segment = () => {
      const at = place.value.split(",").map(Number);
      void this.send("add", { kind: "segment", name: name.value, parent: parent || null, at });
    };
    const joints = set === null ? "" : (model?.about.sets[set] ?? "");
    const [component, kind, values] = [input("name of a component", ""), input("its kind", "rotate"), input("its values, as JSON", '{"angle": "", "axis": [0, 0, 1]}')];
    const [end, from] = [input("port (component.kind.port), or output.segment", ""), input("comes from", "")];
    const made = element(
      "details",
      { id: "adding", open: this.open.has("adding") },
      element("summary", {}, "add"),
      element("div", {}, `on ${parent || "the world"}: `, name, place, element("button", { onclick: segment }, "add segment")),
      joints === ""
        ? ""
        : element(
            "div",
            {},
            `in ${joints}: `,
            component,
            kind,
            values,
            element("button", { onclick: () => this.component(joints, component.value, kind.value, values.value) }, "add component"),
            element("br"),
            end,
            from,
            element("button", { onclick: () => this.wire(joints, end.value, from.value) }, "add wire"),
          ),
    );
    made.addEventListener("toggle", () => (made.open ? this.open.add("adding") : this.open.delete("adding")));
    return made;
  }

  private component(set: string, name: string, component: string, values: string): void {
    try {
      void this.send("add", { kind: "component", set, name, component, values: JSON.parse(values) as unknown });
    } catch (error) {
      this.app.say([{ severity: "error", text: `the values: ${String(error)}` }]);
    }
  }

  private wire(set: string, end: string, from: string): void {
    const parts = end.split(".");
    const path = parts[0] === "output" ? ["joint_set", set, ...parts] : ["joint_set", set, "component", ...parts];
    const names = from.split(",").map((name) => name.trim());
    void this.send("add", { kind: "wire", path, value: names.length === 1 ? names[0] : names });
  }

  /** Gives a number another value. */
  async set(path: Path, value: number, way?: string): Promise<void> {
    await this.send("edit", { path, value, way: way ?? null });
  }

  /** Asks the server, and the person where the server wants that. */
  private async send(what: "edit" | "add" | "undo" | "redo", message: object): Promise<void> {
    const response = await fetch(what, { method: "POST", body: JSON.stringify(message) });
    const answer = (await response.json()) as Answered;
    if (answer.needs === "confirm" && answer.sentence !== undefined) {
      if (await this.asked(answer.sentence)) return this.send(what, { ...message, confirm: true });
    } else if (answer.fault) {
      this.app.say([said(answer.fault)]);
    } else if (answer.error !== undefined || answer.sentence !== undefined) {
      this.app.say([{ severity: "error", text: answer.error ?? answer.sentence ?? "" }]);
    } else {
      this.app.say([]);
    }
    await this.load();
  }

  /** Shows what will be written where; whether the person agrees. */
  private asked(sentence: string): Promise<boolean> {
    return new Promise((resolve) => {
      const dialog = element("dialog", { id: "confirm", "aria-label": "what will be written" });
      const yes = element("button", { id: "confirm-yes", value: "yes" }, "write");
      const form = element("form", { method: "dialog" }, element("p", {}, `This ${sentence}.`.replace("This `", "`")), yes, " ", element("button", { value: "no" }, "do not"));
      dialog.append(form);
      dialog.addEventListener("close", () => {
        dialog.remove();
        resolve(dialog.returnValue === "yes");
      });
      document.body.append(dialog);
      dialog.showModal();
      yes.focus();
    });
  }
}

function said(fault: Fault): Said {
  return { severity: "error", text: `${fault.file}: ${fault.text}\n${fault.excerpt}`, line: fault.line };
}

/** `segment.shank.at[1]`. */
function shown(path: Path): string {
  return path.map((step, at) => (typeof step === "number" ? `[${step}]` : at === 0 ? step : `.${step}`)).join("");
}

/** Without the noise of adding decimal numbers. */
function rounded(value: number): number {
  return Number(value.toPrecision(12));
}
