// What is selected, its network, and what motions break.

import type { App } from "./app";
import { trackAgain } from "./aside";
import type { Mark } from "./core";
import { element } from "./dom";
import { Network } from "./network";
import { SIGNS } from "./timeline";

export class Inspector {
  readonly network = new Network();
  /** What others put below. */
  readonly also: HTMLElement[] = [];
  /** Called after everything was made anew. */
  readonly onbuild: (() => void)[] = [];
  private place = element("dd");
  private error = element("dd");
  private readonly dialog = element("dialog", { class: "wide", "aria-label": "network" });

  constructor(
    private readonly app: App,
    private readonly root: HTMLElement,
  ) {
    document.body.append(this.dialog);
    this.dialog.addEventListener("close", () => this.build());
  }

  /** Makes everything anew. */
  build(): void {
    const { model, selected, set, motions, chosen } = this.app;
    if (!model) return;
    const { about } = model;
    const parts: (Node | string)[] = [];
    if (selected !== null && about.segments[selected]) {
      const segment = about.segments[selected];
      const parent = segment.parent === null ? "the world" : about.segments[segment.parent]!.name;
      parts.push(
        element("h2", {}, segment.name),
        element("dl", {}, ...pair("in", parent), ...pair("joint set", segment.set === null ? "none: it is fixed" : about.sets[segment.set]!), element("dt", {}, "origin"), this.place),
      );
    } else {
      parts.push(
        element("h2", {}, about.name),
        element("dl", {}, ...pair("segments", `${about.segments.length}`), ...pair("coordinates", `${about.coordinates.filter((c) => !c.follows).length}, and ${about.coordinates.filter((c) => c.follows).length} that follow`), ...pair("markers", `${about.markers.length}`), ...pair("loops", `${about.closures}`)),
      );
    }
    if (set !== null) {
      const name = about.sets[set] ?? "";
      parts.push(
        element("h2", {}, `network of ${name}`),
        // While it is seen large, it stays there.
        this.dialog.open ? "" : element("div", { class: "net" }, this.network.root),
        element("button", { onclick: () => this.large(name) }, "larger"),
      );
      this.network.show(model, set);
    } else this.network.clear();
    if (motions.length > 0) {
      const choice = (which: 0 | 1, none: string) => {
        const select = element("select", { "aria-label": which === 0 ? "motion" : "second motion", "data-which": which });
        select.append(element("option", { value: -1 }, none));
        if (which === 1 && motions.length > 2) select.append(element("option", { value: -2, selected: chosen[1] === -2 }, "all others"));
        motions.forEach((motion, index) => select.append(element("option", { value: index, selected: chosen[which] === index }, motion.name)));
        select.addEventListener("change", () => {
          this.app.chosen[which] = Number(select.value);
          this.app.motionsChanged();
          this.app.timed();
        });
        return select;
      };
      const beside = element("input", { type: "checkbox", checked: this.app.sideBySide });
      beside.addEventListener("change", () => {
        this.app.sideBySide = beside.checked;
        this.app.motionsChanged();
        this.app.view.look(this.app.box());
      });
      parts.push(
        element("h2", {}, "motions"),
        element("div", {}, choice(0, "none"), " with ", choice(1, "nothing"), " ", element("label", {}, beside, " side by side")),
      );
      const shown = motions[chosen[0]];
      if (shown?.markers) {
        const again = () => void this.app.attempt(() => trackAgain(this.app, shown, true));
        parts.push(element("dl", {}, element("dt", {}, "markers off by"), this.error), element("button", { id: "track-again", title: "track the markers with the model as it is now", onclick: again }, "track again"));
      }
      parts.push(this.findings());
    }
    this.root.replaceChildren(...parts, ...this.also);
    for (const call of this.onbuild) call();
    this.refresh();
  }

  /** Writes numbers that move. */
  refresh(): void {
    const { model, selected } = this.app;
    if (!model) return;
    if (selected !== null) {
      const [x, y, z] = model.actors[0]!.world(selected, [0, 0, 0]);
      this.place.textContent = [x, y, z].map((v) => (100 * v).toFixed(1)).join(", ") + " cm";
    }
    this.network.refresh(0);
  }

  /** Writes how far markers are off, once they were drawn. */
  missed(): void {
    const { error } = this.app.markers;
    this.error.textContent = error === null ? "–" : `${(1000 * error).toFixed(1)} mm on average`;
  }

  private findings(): HTMLElement {
    const { marks } = this.app;
    const section = element("section", {}, element("h2", {}, `worth a look (${marks.length})`));
    const list = element("ol", { class: "findings", id: "findings" });
    const item = (mark: Mark) => {
      const go = () => this.app.timeline.go(mark.at ?? mark.from);
      const time = element("time", {}, `${mark.from.toFixed(2)} s`);
      return element("li", {}, element("button", { onclick: go, "data-kind": mark.kind }, time, `${SIGNS[mark.kind]} ${mark.kind}: ${mark.what}`));
    };
    list.append(...marks.slice(0, 300).map(item));
    section.append(list);
    if (marks.length === 0) section.append("nothing");
    return section;
  }

  private large(name: string): void {
    const shut = element("button", { onclick: () => this.dialog.close() }, "close");
    this.dialog.replaceChildren(element("h2", {}, `network of ${name}`), element("div", { class: "net" }, this.network.root), shut);
    this.dialog.showModal();
    this.network.refresh(0);
  }
}

function pair(term: string, text: string): Node[] {
  return [element("dt", {}, term), element("dd", {}, text)];
}
