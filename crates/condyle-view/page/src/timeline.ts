// Time: play, speed, loop, and what deserves a look.

import type { Mark, Motion } from "./core";
import { element } from "./dom";

/** Signs of kinds, so that no colour alone says what a mark is. */
export const SIGNS: Record<Mark["kind"], string> = { violation: "▲", jump: "◆", undetermined: "○", limited: "▬" };

export class Timeline {
  readonly root: HTMLElement;
  time = 0;
  playing = false;
  private from = 0;
  private to = 0;
  private last = 0;
  private readonly play = element("button", { class: "play", title: "play or pause (space)" }, "▶");
  private readonly slide = element("input", { type: "range", step: "any", "aria-label": "time in seconds", id: "time" });
  private readonly clock = element("output");
  private readonly loop = element("input", { type: "checkbox", checked: true });
  private readonly speed = element("select", { "aria-label": "speed" });
  private readonly strip = element("div", { class: "strip" });

  /** `moved` is called whenever the time changes. */
  constructor(private readonly moved: () => void) {
    for (const speed of [0.1, 0.25, 0.5, 1, 2, 4]) {
      this.speed.append(element("option", { value: speed, selected: speed === 1 }, `${speed}×`));
    }
    this.play.addEventListener("click", () => this.toggle());
    this.slide.addEventListener("input", () => this.go(this.slide.valueAsNumber));
    this.root = element(
      "div",
      { class: "timeline", hidden: true },
      this.play,
      this.speed,
      element("label", {}, this.loop, " loop"),
      element("div", { class: "time" }, this.strip, this.slide),
      this.clock,
    );
  }

  /** The time of some motions, and their marks. */
  shows(motions: Motion[], marks: Mark[]): void {
    const timed = motions.filter((motion) => motion.times.length > 0);
    this.root.hidden = timed.length === 0;
    this.from = Math.min(...timed.map((motion) => motion.times[0]!));
    this.to = Math.max(...timed.map((motion) => motion.times.at(-1)!));
    if (timed.length === 0) [this.from, this.to] = [0, 0];
    this.slide.min = String(this.from);
    this.slide.max = String(this.to);
    this.marked(marks);
    this.go(Math.min(Math.max(this.time, this.from), this.to));
  }

  marked(marks: Mark[]): void {
    const share = (time: number) => (100 * (time - this.from)) / (this.to - this.from || 1);
    // Of hundreds of marks only the first ones are drawn; the list has them all.
    const drawn = marks.slice(0, 400).map((mark) => {
      const style = `left:${share(mark.from)}%;width:max(3px,${share(mark.to) - share(mark.from)}%)`;
      return element("i", { class: mark.kind, style, title: mark.what });
    });
    this.strip.replaceChildren(...drawn);
  }

  toggle(): void {
    this.playing = !this.playing;
    this.play.textContent = this.playing ? "❚❚" : "▶";
    if (!this.playing) return;
    if (this.time >= this.to) this.go(this.from);
    this.last = performance.now();
    const step = (now: number) => {
      if (!this.playing) return;
      let next = this.time + ((now - this.last) / 1000) * Number(this.speed.value);
      this.last = now;
      if (next > this.to) {
        if (this.loop.checked) next = this.from + ((next - this.from) % (this.to - this.from || 1));
        else {
          next = this.to;
          this.toggle();
        }
      }
      this.go(next);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** A share of the whole forward or back. */
  step(frames: number, motion: Motion | null): void {
    const count = motion?.times.length ?? 100;
    const one = (this.to - this.from) / Math.max(count - 1, 1);
    this.go(Math.min(this.to, Math.max(this.from, this.time + frames * one)));
  }

  go(time: number): void {
    this.time = time;
    this.slide.value = String(time);
    this.clock.value = `${time.toFixed(3)} s`;
    this.moved();
  }
}

/** Writes the stored numbers of a motion at a time; between frames, numbers go evenly. */
export function sample(motion: Motion, time: number, out: Float64Array): void {
  const { times, width, values } = motion;
  if (width !== out.length || times.length === 0) return;
  const [frame, share] = framed(times, time);
  for (let i = 0; i < width; i++) {
    const here = values[frame * width + i]!;
    out[i] = share === 0 ? here : here + share * (values[(frame + 1) * width + i]! - here);
  }
}

/** The frame before a time, and how far it is to the next. */
export function framed(times: number[], time: number): [number, number] {
  let [low, high] = [0, times.length - 1];
  if (high <= 0 || time <= times[0]!) return [0, 0];
  if (time >= times[high]!) return [high, 0];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle;
  }
  return [low, (time - times[low]!) / (times[high]! - times[low]! || 1)];
}
