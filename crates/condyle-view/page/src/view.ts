// The picture: renderer, camera, light and ground. It draws when something has changed, never by itself.

import {
  Box3,
  Color,
  DirectionalLight,
  Fog,
  GridHelper,
  Group,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Described } from "./core";

/** Directions from which the figure is seen, as `condyle render --view` names them: azimuth and elevation in degrees. */
export const VIEWS: Record<string, [number, number]> = {
  oblique: [35, 12],
  front: [0, 0],
  back: [180, 0],
  right: [90, 0],
  left: [-90, 0],
  top: [0, 89.9],
};

/** Strength and direction of lights, as seen: right, up, toward the viewer. */
const LIGHTS: [number, number, number, number][] = [
  [0.72, -0.45, 0.65, 0.61],
  [0.22, 0.8, 0.1, 0.59],
];

export class View {
  readonly scene = new Scene();
  /** What belongs to the model that is shown. */
  readonly content = new Group();
  readonly camera = new PerspectiveCamera(30, 1, 0.01, 200);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  /** How often a picture was drawn. */
  pictures = 0;
  /** Called before each picture. */
  before: (() => void)[] = [];
  /** From all around: more from above than from below. */
  private readonly sky = new HemisphereLight(0xffffff, new Color().setScalar(0.1 / 0.26), 0.26 * Math.PI);
  private grid: GridHelper | null = null;
  private square = 0.25;
  private wanted = false;
  private up = new Vector3(0, 1, 0);
  private ahead = new Vector3(1, 0, 0);
  private box = new Box3(new Vector3(-0.5, 0, -0.5), new Vector3(0.5, 1, 0.5));

  constructor(private readonly canvas: HTMLCanvasElement) {
    // The buffer is kept, so that pictures can be saved and tests can read pixels.
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene.add(this.content, this.sky, this.camera);
    // The lights of `condyle render`, which go with the viewer; three.js divides by pi.
    for (const [strength, right, up, toward] of LIGHTS) {
      const light = new DirectionalLight(0xffffff, strength * Math.PI);
      light.position.set(right, up, toward);
      this.camera.add(light, light.target);
    }
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.resized()).observe(canvas.parentElement!);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.themed());
    this.resized();
  }

  /** Asks for a picture. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.now();
    });
  }

  /** Draws at once. */
  now(): void {
    for (const call of this.before) call();
    this.renderer.render(this.scene, this.camera);
    this.pictures += 1;
  }

  /** Prepares for a model. */
  shows(about: Described): void {
    this.up.set(0, about.up === "y" ? 1 : 0, about.up === "y" ? 0 : 1);
    this.ahead.set(...about.ahead);
    this.camera.up.copy(this.up);
    this.sky.position.copy(this.up);
    // The controls take the axis from the camera where they are made; this is what they keep of it.
    const controls = this.controls as unknown as { _quat: import("three").Quaternion; _quatInverse: import("three").Quaternion };
    controls._quat.setFromUnitVectors(this.up, new Vector3(0, 1, 0));
    controls._quatInverse.copy(controls._quat).invert();
  }

  /** Looks at all of a box, from a direction. */
  look(box: Box3, from = "oblique"): void {
    this.box = box;
    const [azimuth, elevation] = VIEWS[from] ?? VIEWS["oblique"]!;
    // Azimuth turns to the right side of the figure.
    const forward = this.ahead.clone().addScaledVector(this.up, -this.ahead.dot(this.up)).normalize();
    const right = forward.clone().cross(this.up);
    const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
    const to = forward.multiplyScalar(Math.cos(a)).addScaledVector(right, Math.sin(a));
    to.multiplyScalar(Math.cos(e)).addScaledVector(this.up, Math.sin(e));
    const middle = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    const radius = 0.5 * size.length();
    const tall = Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect);
    const distance = (1.08 * radius) / tall;
    this.camera.position.copy(middle).addScaledVector(to, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.update();
    this.ground(size.length());
    this.draw();
  }

  /** Goes along over the ground, so that what walks stays in the picture. */
  along(by: Vector3): void {
    const over = by.clone().addScaledVector(this.up, -by.dot(this.up));
    if (over.lengthSq() < 1e-12) return;
    this.camera.position.add(over);
    this.controls.target.add(over);
    this.box.translate(over);
    if (this.grid) this.lay(this.grid);
    this.controls.update();
  }

  /** Turns the camera about what it looks at, by radians to the side and up. */
  turn(side: number, rise: number): void {
    const off = this.camera.position.clone().sub(this.controls.target);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const angle = off.angleTo(this.up);
    const tilt = Math.min(Math.max(rise, angle - Math.PI + 0.05), angle - 0.05);
    off.applyAxisAngle(right, -tilt).applyAxisAngle(this.up, side);
    this.camera.position.copy(this.controls.target).add(off);
    this.controls.update();
    this.draw();
  }

  /** Comes nearer by a factor below 1, or goes away. */
  nearer(factor: number): void {
    const off = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(off);
    this.controls.update();
    this.draw();
  }

  /** A length that suits signs beside bones: a share of what the picture shows. */
  get unit(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return 0.05 * 2 * distance * Math.tan((this.camera.fov * Math.PI) / 360);
  }

  /** Where a place is in the picture, in CSS pixels; `null` behind the camera. */
  project(place: readonly [number, number, number]): [number, number] | null {
    // Where the camera is now, not where it was in the last picture.
    this.camera.updateMatrixWorld();
    const at = new Vector3(...place).project(this.camera);
    if (at.z > 1) return null;
    const { clientWidth: wide, clientHeight: high } = this.canvas;
    return [(0.5 + 0.5 * at.x) * wide, (0.5 - 0.5 * at.y) * high];
  }

  /** Width and height in CSS pixels. */
  get size(): Vector2 {
    return this.renderer.getSize(new Vector2());
  }

  /** Colours of the page, as its style has them. */
  themed(): void {
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => new Color(style.getPropertyValue(name).trim());
    const background = colour("--background");
    this.scene.background = background;
    const far = this.camera.position.distanceTo(this.controls.target);
    this.scene.fog = new Fog(background, far * 1.2, far * 3);
    this.ground(this.box.getSize(new Vector3()).length());
    this.draw();
  }

  private ground(size: number): void {
    if (this.grid) {
      this.scene.remove(this.grid);
      this.grid.dispose();
    }
    const style = getComputedStyle(document.documentElement);
    const line = new Color(style.getPropertyValue("--grid").trim());
    // Squares of 10 cm for what is smaller than half a metre, else of a metre's quarter.
    this.square = size < 0.6 ? 0.05 : 0.25;
    const count = 2 * Math.ceil((size * 3) / this.square);
    this.grid = new GridHelper(count * this.square, count, line, line);
    if (this.up.z === 1) this.grid.rotation.x = Math.PI / 2;
    this.lay(this.grid);
    const far = this.camera.position.distanceTo(this.controls.target);
    if (this.scene.fog instanceof Fog) Object.assign(this.scene.fog, { near: far * 1.2, far: far * 3 });
    this.scene.add(this.grid);
  }

  /** Puts the grid under what is seen. */
  private lay(grid: GridHelper): void {
    const { up, square } = this;
    const low = this.box.min.dot(up);
    const high = this.box.max.dot(up);
    const stands = low > -0.08 * (high - low) && low < 0.6 * (high - low);
    const middle = this.box.getCenter(new Vector3());
    // Lines stay at whole squares, however the figure stands.
    const whole = (x: number) => Math.round(x / square) * square;
    grid.position.set(whole(middle.x), whole(middle.y), whole(middle.z));
    grid.position.addScaledVector(up, (stands ? 0 : low) - grid.position.dot(up));
  }

  private resized(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    const [wide, high] = [Math.max(clientWidth, 1), Math.max(clientHeight, 1)];
    this.renderer.setSize(wide, high);
    this.camera.aspect = wide / high;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
