// The tools above the picture.

import type { App } from "./app";
import { byId, element } from "./dom";
import { save } from "./files";
import { LOOKS } from "./looks";
import { KINDS } from "./signs";
import { VIEWS } from "./view";

export function tools(app: App, dragging: { on: boolean }): void {
  const bar = byId("tools");
  const button = (text: string, title: string, onclick: () => void, attributes = {}) =>
    element("button", { title, onclick, ...attributes }, text);
  const menu = (name: string, ...children: Node[]) => element("details", { class: "menu" }, element("summary", {}, name), element("div", {}, ...children));

  const file = element("input", { type: "file", multiple: true, hidden: true });
  file.addEventListener("change", () => void app.take(file.files ?? []));
  const open = button("open …", "open a model, a motion or a recording", () => file.click());

  const shipped = element("select", { "aria-label": "a model that comes along", id: "shipped" }, element("option", { value: "" }, "models"));
  for (const name of app.core.shipped()) shipped.append(element("option", { value: name }, name));
  shipped.addEventListener("change", () => {
    if (shipped.value) void app.attempt(() => app.took(app.core.take(shipped.value, new Uint8Array(), null), shipped.value));
  });

  const view = element("select", { "aria-label": "from where", id: "from" });
  for (const name of Object.keys(VIEWS)) view.append(element("option", { value: name }, name));
  view.addEventListener("change", () => app.view.look(app.box(), view.value));

  const kinds = KINDS.map((kind) => {
    const box = element("input", { type: "checkbox", "data-show": kind });
    box.addEventListener("change", () => app.toggle(kind));
    app.onchange.push(() => (box.checked = app.show.has(kind)));
    return element("label", {}, box, ` ${kind}`);
  });

  // What a file brings along is seen or not; without such, bones alone are there.
  const looks = LOOKS.map((look) => {
    const box = element("input", { type: "checkbox", "data-show": look });
    box.addEventListener("change", () => app.looksLike(look));
    const label = element("label", {}, box, ` ${look}`);
    app.onchange.push(() => {
      box.checked = app.looked.has(look);
      label.hidden = !app.lookable.includes(look);
    });
    return label;
  });

  const limits = button("limits hold", "whether limits hold what is asked (l)", () => app.limits(!app.withinLimits), { id: "limits" });
  const drag = button("drag", "drag bones: the body follows (d)", () => {
    dragging.on = !dragging.on;
    app.onchange.forEach((call) => call());
  }, { id: "drag" });
  app.onchange.push(() => {
    limits.setAttribute("aria-pressed", String(app.withinLimits));
    drag.setAttribute("aria-pressed", String(dragging.on));
    byId("picture").classList.toggle("drags", dragging.on);
  });

  const saves: [string, string][] = [
    ["json", "pose (JSON)"],
    ["glb", "scene (GLB)"],
    ["bvh", "skeleton (BVH)"],
    ["mot", "motion (MOT)"],
    ["csv", "motion (CSV)"],
  ];
  const saved = saves.map(([format, text]) =>
    button(text, `save as ${format}`, () => void app.attempt(() => { if (app.model) save(app.model, app.motions[app.chosen[0]] ?? null, format, app.title); }), { "data-save": format }),
  );
  saved.push(
    button("picture (PNG)", "save the picture", () => {
      app.view.now();
      element("a", { href: byId<HTMLCanvasElement>("picture").toDataURL("image/png"), download: `${app.title}.png` }).click();
    }, { "data-save": "png" }),
  );

  bar.append(
    file,
    open,
    shipped,
    view,
    menu("show", ...looks, ...kinds),
    limits,
    drag,
    button("key", "keep the pose as a key at the timeline's time (p)", () => app.keys.set(), { id: "key" }),
    button("undo", "undo (u, ctrl z)", () => app.undo(), { id: "undo" }),
    button("redo", "redo (y)", () => app.redo(), { id: "redo" }),
    button("neutral", "the neutral pose (0)", () => app.neutral(), { id: "neutral" }),
    menu("save", ...saved),
    button("help", "keys (?)", () => byId<HTMLDialogElement>("help").showModal()),
  );
  // A menu shuts when the pointer or the focus goes elsewhere.
  document.addEventListener("pointerdown", (event) => {
    for (const open of bar.querySelectorAll<HTMLDetailsElement>("details.menu[open]")) {
      if (!open.contains(event.target as Node)) open.open = false;
    }
  });
}
