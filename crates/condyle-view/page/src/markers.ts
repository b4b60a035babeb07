// Markers, measured and of the model, with a line between them.

import {
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  MeshLambertMaterial,
  OctahedronGeometry,
  SphereGeometry,
} from "three";
import type { Actor, Motion } from "./core";
import { framed } from "./timeline";

export class Markers {
  readonly group = new Group();
  /** The mean distance of what is shown now, in metres; `null` where nothing is measured. */
  error: number | null = null;

  /** Draws the markers of a pose, and those measured at a time. */
  update(actor: Actor, motion: Motion | null, time: number, size: number, visible: boolean): void {
    this.clear();
    this.error = null;
    if (!visible) return;
    const { markers } = actor.model.about;
    const modelled = markers.map((marker) => actor.world(marker.segment, marker.point));
    this.balls(modelled, new SphereGeometry(1, 12, 8), 0x2fa35c, size);
    const measured = motion?.markers;
    if (!measured) return;
    const [frame] = framed(motion.times, time);
    const { names, positions } = measured;
    const places: [number, number, number][] = [];
    const lines: number[] = [];
    let sum = 0;
    let count = 0;
    const places_of = new Map(markers.map((marker, index) => [plain(marker.name), index]));
    names.forEach((name, index) => {
      const at = 3 * (frame * names.length + index);
      const place = [positions[at]!, positions[at + 1]!, positions[at + 2]!] as [number, number, number];
      if (place.some(Number.isNaN)) return;
      places.push(place);
      const own = places_of.get(plain(name));
      if (own === undefined) return;
      const model = modelled[own]!;
      lines.push(...model, ...place);
      sum += Math.hypot(...place.map((x, i) => x - model[i]!));
      count += 1;
    });
    // Another shape as well as another colour.
    this.balls(places, new OctahedronGeometry(1.25), 0xc2245c, size);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(lines, 3));
    const drawn = new LineSegments(geometry, new LineBasicMaterial({ color: 0xc2245c, depthTest: false }));
    drawn.renderOrder = 3;
    drawn.frustumCulled = false;
    this.group.add(drawn);
    this.error = count > 0 ? sum / count : null;
  }

  private balls(places: [number, number, number][], geometry: SphereGeometry | OctahedronGeometry, colour: number, size: number): void {
    const mesh = new InstancedMesh(geometry, new MeshLambertMaterial({ color: new Color(colour) }), places.length);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    const matrix = new Matrix4();
    places.forEach((place, index) => {
      mesh.setMatrixAt(index, matrix.makeScale(size, size, size).setPosition(...place));
    });
    this.group.add(mesh);
  }

  private clear(): void {
    for (const child of this.group.children) {
      const { geometry, material } = child as LineSegments<BufferGeometry, LineBasicMaterial>;
      geometry.dispose();
      material.dispose();
    }
    this.group.clear();
  }
}

/** A label without the name of its subject. */
function plain(name: string): string {
  return name.slice(name.indexOf(":") + 1).toLowerCase();
}
