// Curves of coordinates over time.

import type { Described, Motion } from "./core";
import { element } from "./dom";
import { type Unit, shown, unitOf } from "./unit";

const DASHES = [[], [6, 3], [2, 3], [10, 3, 2, 3]];

export class Curves {
  readonly root = element("section", { class: "curves", hidden: true });
  private readonly canvas = element("canvas", { role: "img", "aria-label": "curves of coordinates over time" });
  private readonly legend = element("ul");
  private wanted = new Set<number>();

  constructor() {
    this.root.append(this.canvas, this.legend);
  }

  toggle(coordinate: number): void {
    if (!this.wanted.delete(coordinate)) this.wanted.add(coordinate);
  }

  clear(): void {
    this.wanted.clear();
  }

  draw(about: Described, motions: Motion[], time: number): void {
    const wanted = [...this.wanted].filter((index) => about.coordinates[index]);
    this.root.hidden = wanted.length === 0 || motions.length === 0;
    if (this.root.hidden) return;
    const style = getComputedStyle(document.documentElement);
    const scale = window.devicePixelRatio;
    const [wide, high] = [this.canvas.clientWidth, this.canvas.clientHeight];
    this.canvas.width = wide * scale;
    this.canvas.height = high * scale;
    const pen = this.canvas.getContext("2d")!;
    pen.scale(scale, scale);
    const from = Math.min(...motions.map((m) => m.times[0] ?? 0));
    const to = Math.max(...motions.map((m) => m.times.at(-1) ?? 1));
    const values = wanted.flatMap((index) => motions.map((motion) => series(motion, about.coordinates[index]!.place, unitOf(about.coordinates[index]!.kind))));
    let low = Infinity;
    let top = -Infinity;
    for (const list of values) for (const v of list) [low, top] = [Math.min(low, v), Math.max(top, v)];
    if (!(top > low)) [low, top] = [low - 1, low + 1];
    const left = 46;
    const x = (t: number) => left + ((t - from) / (to - from || 1)) * (wide - left - 6);
    const y = (v: number) => 6 + (1 - (v - low) / (top - low)) * (high - 12);
    pen.fillStyle = style.getPropertyValue("--text");
    pen.font = "11px system-ui, sans-serif";
    pen.fillText(top.toFixed(1), 2, 14);
    pen.fillText(low.toFixed(1), 2, high - 6);
    const colours = ["--curve-1", "--curve-2", "--curve-3", "--curve-4"].map((n) => style.getPropertyValue(n));
    let k = 0;
    wanted.forEach((_, place) => {
      motions.forEach((motion, which) => {
        const list = values[k++]!;
        pen.beginPath();
        pen.strokeStyle = colours[place % colours.length]!;
        pen.lineWidth = which === 0 ? 2 : 1;
        pen.setLineDash(DASHES[(Math.floor(place / colours.length) + which) % DASHES.length]!);
        list.forEach((v, i) => (i === 0 ? pen.moveTo(x(motion.times[i]!), y(v)) : pen.lineTo(x(motion.times[i]!), y(v))));
        pen.stroke();
      });
    });
    pen.setLineDash([]);
    pen.lineWidth = 1;
    pen.strokeStyle = style.getPropertyValue("--text");
    pen.beginPath();
    pen.moveTo(x(time), 0);
    pen.lineTo(x(time), high);
    pen.stroke();
    this.legend.replaceChildren(
      ...wanted.map((index, place) => {
        const c = about.coordinates[index]!;
        const now = motions[0] ? nearest(motions[0], time, c.place) : 0;
        const unit = unitOf(c.kind);
        return element("li", { style: `--ink:var(--curve-${(place % 4) + 1})` }, `${c.key} ${shown(now, unit)} ${unit.sign}`);
      }),
    );
  }
}

function series(motion: Motion, place: number, unit: Unit): number[] {
  return motion.times.map((_, frame) => (motion.values[frame * motion.width + place] ?? 0) * unit.factor);
}

function nearest(motion: Motion, time: number, place: number): number {
  let frame = motion.times.findIndex((t) => t >= time);
  if (frame < 0) frame = motion.times.length - 1;
  return motion.values[frame * motion.width + place] ?? 0;
}
