// Time: play, speed, loop, and what deserves a look.

import type { Mark, Motion } from "./core";
import { element } from "./dom";

/** Signs of kinds, so that no colour alone says what a mark is. */
export const SIGNS: Record<Mark["kind"], string> = { violation: "▲", jump: "◆", undetermined: "○", limited: "▬" };

export class Timeline {
  readonly root: HTMLElement;
  time = 0;
  playing = false;
  /** Above the slider: what belongs to times. */
  readonly lane = element("div", { class: "lane", hidden: true });
  private from = 0;
  private to = 0;
  /** The ends of the slider: key poses have room around them. */
  private ends: [number, number] = [0, 0];
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
      element("div", { class: "time" }, this.lane, this.strip, this.slide),
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
    const room = timed.flatMap(({ keyed }) => (keyed ? [keyed.from, keyed.until] : []));
    this.ends = [Math.min(this.from, ...room), Math.max(this.to, ...room)];
    this.reach(this.ends[0]);
    this.marked(marks);
    this.go(Math.min(Math.max(this.time, this.ends[0]), this.ends[1]));
  }

  /** Makes the slider long enough for a time. */
  reach(time: number): void {
    if (!Number.isFinite(time)) return;
    this.ends = [Math.min(this.ends[0], time), Math.max(this.ends[1], time)];
    [this.slide.min, this.slide.max] = this.ends.map(String) as [string, string];
  }

  /** Where a time is on the slider, in percent. */
  share(time: number): number {
    return (100 * (time - this.ends[0])) / (this.ends[1] - this.ends[0] || 1);
  }

  /** The time at a place of the window. */
  timeAt(x: number): number {
    const { left, width } = this.strip.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (x - left) / (width || 1)));
    return this.ends[0] + share * (this.ends[1] - this.ends[0]);
  }

  marked(marks: Mark[]): void {
    // Of hundreds of marks only the first ones are drawn; the list has them all.
    const drawn = marks.slice(0, 400).map((mark) => {
      const style = `left:${this.share(mark.from)}%;width:max(3px,${this.share(mark.to) - this.share(mark.from)}%)`;
      return element("i", { class: mark.kind, style, title: mark.what });
    });
    this.strip.replaceChildren(...drawn);
  }

  toggle(): void {
    if (!this.playing && this.to <= this.from) return;
    this.playing = !this.playing;
    this.play.textContent = this.playing ? "❚❚" : "▶";
    if (!this.playing) return;
    if (this.time >= this.to || this.time < this.from) this.go(this.from);
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
    const one = motion?.keyed?.step ?? (this.to - this.from) / Math.max(count - 1, 1);
    this.go(Math.min(this.ends[1], Math.max(this.ends[0], this.time + frames * one)));
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
