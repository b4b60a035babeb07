// The rotations of a joint in the space of quaternions: what limits them, from what that was learned, and the pose in it.

import { AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { App } from "./app";
import { element } from "./dom";
import { type Packed, Signs } from "./signs";

/** A colour of the legend, how it is drawn, and what it is. */
const LEGEND: [string, string, string][] = [
  ["limit", "▣", "boundary of what is allowed"],
  ["leader", "·", "recorded rotations"],
  ["axis_z", "•", "the outermost of them"],
  ["value", "●", "this pose"],
  ["gap_broken", "●", "this pose, outside"],
  ["gap", "●", "the nearest that is allowed"],
  ["motion", "—", "the motion"],
  ["gap_broken", "▬", "the motion, outside"],
];

export class Quaternions {
  readonly root = element("section", { id: "quaternions", hidden: true });
  /** What is drawn of the limit and the motion, and of the pose. */
  readonly still = new Signs();
  readonly pose = new Signs();
  private readonly canvas = element("canvas", {
    tabindex: 0,
    role: "img",
    "aria-label": "rotations in the space of quaternions; arrow keys turn it, plus and minus come nearer and go away",
  });
  private readonly said = element("p", { role: "status" });
  private readonly title = element("h2");
  private readonly legend = element("ul", { class: "legend" });
  private readonly box = element("div");
  private readonly dialog = element("dialog", { class: "wide", "aria-label": "rotations" });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(30, 1, 0.1, 50);
  private renderer: WebGLRenderer | null = null;
  private controls: OrbitControls | null = null;
  private key: unknown[] = [];
  private wanted = false;

  constructor(private readonly app: App) {
    this.box.append(this.canvas, this.said, this.legend);
    const larger = element("button", { onclick: () => this.large() }, "larger");
    this.root.append(this.title, this.box, larger);
    document.body.append(this.dialog);
    this.dialog.addEventListener("close", () => {
      this.root.insertBefore(this.box, larger);
      this.draw();
    });
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-0.5, 0.8, 1);
    this.camera.add(sun);
    this.camera.position.set(2.4, 1.6, 3.2);
    this.scene.add(new AmbientLight(0xffffff, 1.1), this.camera, this.still.group, this.pose.group);
    this.canvas.addEventListener("keydown", (event) => this.keyed(event));
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    app.inspector.also.push(this.root);
    app.inspector.onbuild.push(() => this.update());
    app.onchange.push(() => this.update());
  }

  /** Draws what is looked at: the limit where that or the motion changed, the pose always. */
  private update(): void {
    const { model, set, motions, chosen } = this.app;
    if (!model || set === null) {
      this.root.hidden = true;
      this.key = [];
      return;
    }
    const motion = motions[chosen[0]] ?? null;
    const key = [model, set, motion];
    if (key.some((part, i) => part !== this.key[i])) {
      this.key = key;
      const frames = motion ? motion.times.map((_, i) => [...motion.values.subarray(i * motion.width, (i + 1) * motion.width)]) : [];
      const answer = model.ask<Packed>("rotations", { set, frames });
      this.root.hidden = answer.value.title === null;
      this.still.show(answer, this.size);
      this.title.textContent = `rotations of ${answer.value.title}`;
      const clouds = (answer.value.clouds ?? []).some((cloud) => cloud.points[1] > 0);
      const entries = LEGEND.filter(([name, sign]) => (clouds || !(name === "leader" || name === "axis_z")) && (motion || (name !== "motion" && sign !== "▬")));
      this.legend.replaceChildren(
        ...entries.map(([name, sign, text]) => element("li", {}, element("i", { style: `color: ${model.about.colours[name]}` }, sign), ` ${text}`)),
      );
    }
    if (this.root.hidden) return;
    this.pose.show(model.ask<Packed>("rotations", { set, actor: 0 }), this.size);
    this.said.textContent = this.pose.labels[0]?.text ?? "";
    this.draw();
  }

  private get size(): Vector2 {
    return new Vector2(this.canvas.clientWidth || 300, this.canvas.clientHeight || 240);
  }

  private draw(): void {
    if (this.wanted || this.root.hidden) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      // A picture of its own: many pages have no use for it.
      this.renderer ??= new WebGLRenderer({ canvas: this.canvas, antialias: true, preserveDrawingBuffer: true });
      if (!this.controls) {
        this.controls = new OrbitControls(this.camera, this.canvas);
        this.controls.enablePan = false;
        this.controls.addEventListener("change", () => this.draw());
      }
      const size = this.size;
      this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
      this.renderer.setSize(size.x, size.y, false);
      this.camera.aspect = size.x / size.y;
      this.camera.updateProjectionMatrix();
      this.still.resized(size);
      this.pose.resized(size);
      this.scene.background = new Color(getComputedStyle(document.documentElement).getPropertyValue("--background").trim());
      this.renderer.render(this.scene, this.camera);
    });
  }

  private keyed(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const turn = turns[event.key];
    const at = this.camera.position;
    if (turn) {
      const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
      const up = new Vector3(0, 1, 0);
      const angle = at.angleTo(up);
      const tilt = Math.min(Math.max(0.1 * turn[1], 0.05 - angle), Math.PI - 0.05 - angle);
      at.applyAxisAngle(right, tilt).applyAxisAngle(up, 0.1 * turn[0]);
    } else if (event.key === "+" || event.key === "-") {
      at.multiplyScalar(event.key === "+" ? 1 / 1.15 : 1.15).clampLength(1.2, 12);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    this.camera.lookAt(0, 0, 0);
    this.controls?.update();
    this.draw();
  }

  private large(): void {
    this.dialog.replaceChildren(this.title.cloneNode(true), this.box, element("button", { onclick: () => this.dialog.close() }, "close"));
    this.dialog.showModal();
    this.draw();
  }
}
