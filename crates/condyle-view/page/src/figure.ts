// The bones of one pose: a surface at the defaults, moved by the evaluator's matrices.

import {
  Bone,
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DetachedBindMode,
  Float32BufferAttribute,
  Matrix4,
  MeshStandardMaterial,
  type Ray,
  Skeleton,
  SkinnedMesh,
  Sphere,
  Uint16BufferAttribute,
  Vector3,
} from "three";
import type { Actor, Model, Span } from "./core";

interface Packed {
  positions: Span;
  normals: Span;
  colours: Span;
  carriers: Span;
  triangles: Span;
  parts: Part[];
}

/** A bone, or what hangs between two. */
interface Part {
  name: string;
  segments: [number, number];
  corners: [number, number];
  triangles: [number, number];
}

/** A surface that all poses of a model share. */
export class Shape {
  readonly geometry = new BufferGeometry();
  readonly parts: Part[];
  readonly triangles: Uint32Array;
  readonly positions: Float32Array;
  private readonly colours: Float32Array;
  private readonly spheres: Sphere[];

  constructor(model: Model) {
    const packed = model.ask<Packed>("bones");
    const { value } = packed;
    this.parts = value.parts;
    this.positions = packed.floats(value.positions);
    this.triangles = packed.corners(value.triangles);
    this.colours = linear(packed.floats(value.colours));
    const carriers = packed.floats(value.carriers);
    const corners = this.positions.length / 3;
    const index = new Uint16Array(4 * corners);
    const weight = new Float32Array(4 * corners);
    for (let corner = 0; corner < corners; corner++) {
      const share = carriers[3 * corner + 2]!;
      index[4 * corner] = carriers[3 * corner]!;
      index[4 * corner + 1] = carriers[3 * corner + 1]!;
      weight[4 * corner] = 1 - share;
      weight[4 * corner + 1] = share;
    }
    this.geometry.setAttribute("position", new Float32BufferAttribute(this.positions, 3));
    this.geometry.setAttribute("normal", new Float32BufferAttribute(packed.floats(value.normals), 3));
    this.geometry.setAttribute("color", new Float32BufferAttribute(this.colours.slice(), 3));
    this.geometry.setAttribute("skinIndex", new Uint16BufferAttribute(index, 4));
    this.geometry.setAttribute("skinWeight", new Float32BufferAttribute(weight, 4));
    this.geometry.setIndex(new BufferAttribute(this.triangles, 1));
    this.spheres = this.parts.map(({ corners: [from, to] }) => {
      const box = new Box3().setFromArray(this.positions.subarray(3 * from, 3 * to));
      return box.getBoundingSphere(new Sphere());
    });
  }

  /** Colours the parts of segments in an accent, the others as they are. */
  accent(segments: ReadonlySet<number>, colour: Color): void {
    const attribute = this.geometry.getAttribute("color") as Float32BufferAttribute;
    const out = attribute.array as Float32Array;
    out.set(this.colours);
    for (const part of this.parts) {
      if (!segments.has(part.segments[0])) continue;
      for (let corner = part.corners[0]; corner < part.corners[1]; corner++) {
        colour.toArray(out, 3 * corner);
      }
    }
    attribute.needsUpdate = true;
  }

  /** The nearest part that a ray meets in a pose, with the place. */
  hit(ray: Ray, actor: Actor, shift: Vector3): { part: Part; place: Vector3; own: Vector3 } | null {
    const moves = actor.moves;
    let best: { part: Part; place: Vector3; own: Vector3 } | null = null;
    let nearest = Infinity;
    const [matrix, local] = [new Matrix4(), ray.clone()];
    const corners = [new Vector3(), new Vector3(), new Vector3()] as const;
    const found = new Vector3();
    for (const [index, part] of this.parts.entries()) {
      matrix.fromArray(moves, 16 * part.segments[0]);
      matrix.setPosition(
        matrix.elements[12]! + shift.x,
        matrix.elements[13]! + shift.y,
        matrix.elements[14]! + shift.z,
      );
      local.copy(ray).applyMatrix4(matrix.clone().invert());
      if (!local.intersectsSphere(this.spheres[index]!)) continue;
      for (let triangle = part.triangles[0]; triangle < part.triangles[1]; triangle++) {
        corners.forEach((corner, i) => corner.fromArray(this.positions, 3 * this.triangles[3 * triangle + i]!));
        if (!local.intersectTriangle(...corners, false, found)) continue;
        const place = found.clone().applyMatrix4(matrix);
        const distance = place.distanceTo(ray.origin);
        if (distance < nearest) {
          nearest = distance;
          best = { part, place, own: found.clone() };
        }
      }
    }
    return best;
  }
}

/** A pose as it is drawn. */
export class Figure {
  readonly mesh: SkinnedMesh;
  private readonly skeleton: Skeleton;
  private readonly material: MeshStandardMaterial;

  constructor(
    readonly shape: Shape,
    readonly actor: Actor,
  ) {
    const count = actor.model.about.segments.length;
    this.skeleton = new Skeleton(Array.from({ length: count }, () => new Bone()));
    this.skeleton.computeBoneTexture();
    // The evaluator gives the matrices.
    this.skeleton.update = () => undefined;
    this.material = new MeshStandardMaterial({ vertexColors: true, roughness: 0.75, metalness: 0 });
    this.mesh = new SkinnedMesh(shape.geometry, this.material);
    this.mesh.frustumCulled = false;
    // Matrices are of the world: the place of the mesh comes on top of them.
    this.mesh.bindMode = DetachedBindMode;
    this.mesh.bind(this.skeleton, new Matrix4());
    this.moved();
  }

  /** Takes over the pose that was evaluated last. */
  moved(): void {
    this.skeleton.boneMatrices!.set(this.actor.moves);
    this.skeleton.boneTexture!.needsUpdate = true;
  }

  /** Whether other things are seen through it, and a colour laid over it. */
  ghost(on: boolean): void {
    this.material.transparent = on;
    this.material.opacity = on ? 0.45 : 1;
    this.material.depthWrite = !on;
    this.material.color.set(on ? 0x86b4ff : 0xffffff);
    this.material.needsUpdate = true;
  }

  /** The box of all its corners. */
  box(): Box3 {
    const box = new Box3();
    const [matrix, corner] = [new Matrix4(), new Vector3()];
    const moves = this.actor.moves;
    for (const part of this.shape.parts) {
      matrix.fromArray(moves, 16 * part.segments[0]);
      for (let i = part.corners[0]; i < part.corners[1]; i += 4) {
        box.expandByPoint(corner.fromArray(this.shape.positions, 3 * i).applyMatrix4(matrix));
      }
    }
    if (box.isEmpty()) box.set(new Vector3(-0.5, -0.5, -0.5), new Vector3(0.5, 0.5, 0.5));
    return box.translate(this.mesh.position);
  }

  dispose(): void {
    this.material.dispose();
    this.skeleton.dispose();
  }
}

/** Colours of a screen as light. */
function linear(colours: Float32Array): Float32Array {
  return colours.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
}
