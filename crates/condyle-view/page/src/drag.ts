// A bone that is dragged: the body follows, within its limits, loops closed.

import { Plane, Raycaster, Vector2, Vector3 } from "three";
import type { Model } from "./core";
import type { View } from "./view";

/** A point of a segment that follows the pointer. */
export class Drag {
  private readonly plane: Plane;
  /** Where the point should be. */
  readonly target: Vector3;
  /** How far off it is, in metres. */
  off = 0;

  constructor(
    private readonly model: Model,
    private readonly actor: number,
    readonly segment: number,
    private readonly point: [number, number, number],
    start: Vector3,
    private readonly shift: Vector3,
    view: View,
  ) {
    this.target = start.clone();
    this.plane = new Plane().setFromNormalAndCoplanarPoint(view.camera.getWorldDirection(new Vector3()), start);
  }

  /** Follows the pointer over the picture. */
  to(pointer: Vector2, view: View): void {
    const caster = new Raycaster();
    caster.setFromCamera(pointer, view.camera);
    if (caster.ray.intersectPlane(this.plane, this.target)) this.solve();
  }

  /** Moves the target, as keys do. */
  by(step: Vector3): void {
    this.target.add(step);
    this.solve();
  }

  end(): void {
    this.model.ask("drop");
  }

  private solve(): void {
    const { x, y, z } = this.target.clone().sub(this.shift);
    const answer = this.model.ask<{ off: number }>("drag", {
      actor: this.actor,
      segment: this.segment,
      point: this.point,
      target: [x, y, z],
      hold: held(this.model, this.segment),
    });
    this.off = answer.value.off;
  }
}

/** What carries the whole body stays, unless nothing else moves what is dragged. */
function held(model: Model, segment: number): number[] {
  const { coordinates, segments } = model.about;
  if (segments[segment]?.parent === null) return [];
  return coordinates.flatMap((c, index) => (c.moves !== null && segments[c.moves]?.parent === null ? [index] : []));
}
