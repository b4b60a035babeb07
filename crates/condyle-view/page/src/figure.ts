// The bones of one pose: a surface at the defaults, moved by the evaluator's matrices.

import {
  Bone,
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DetachedBindMode,
  DoubleSide,
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
import type { Actor, Answer, Model, Span } from "./core";
import type { Look, Looks, Packed, Part } from "./looks";
import { Skin, SkinShape } from "./skin";

/** A surface that all poses of a model share. */
export class Shape {
  readonly geometry = new BufferGeometry();
  readonly parts: Part[];
  readonly triangles: Uint32Array;
  readonly positions: Float32Array;
  private readonly colours: Float32Array;
  private readonly spheres: Sphere[];
  readonly skin: SkinShape | null;
  /** Segments that have a mesh of a file. */
  private readonly meshed = new Set<number>();
  private look: ReadonlySet<Look> = new Set();

  constructor(model: Model, looks: Looks | null = null) {
    const packed = model.ask<Packed>("bones");
    const all = looks?.meshes ? [packed, looks.meshes] : [packed];
    const floats = (of: (value: Packed) => Span) => joined(all, of);
    this.parts = packed.value.parts.slice();
    this.positions = floats((value) => value.positions);
    this.colours = linear(floats((value) => value.colours));
    let triangles = packed.corners(packed.value.triangles);
    if (looks?.meshes) {
      const { value } = looks.meshes;
      const [corners, before] = [packed.value.positions[1] / 3, triangles.length / 3];
      const more = looks.meshes.corners(value.triangles).map((corner) => corner + corners);
      const both = new Uint32Array(triangles.length + more.length);
      both.set(triangles);
      both.set(more, triangles.length);
      triangles = both;
      const moved = ([from, to]: [number, number], by: number): [number, number] => [from + by, to + by];
      for (const part of value.parts) {
        this.meshed.add(part.segments[0]);
        this.parts.push({ ...part, mesh: true, corners: moved(part.corners, corners), triangles: moved(part.triangles, before) });
      }
    }
    this.triangles = triangles;
    this.skin = looks?.skin ? new SkinShape(looks.skin) : null;
    const carriers = floats((value) => value.carriers);
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
    this.geometry.setAttribute("normal", new Float32BufferAttribute(floats((value) => value.normals), 3));
    this.geometry.setAttribute("color", new Float32BufferAttribute(this.colours.slice(), 3));
    this.geometry.setAttribute("skinIndex", new Uint16BufferAttribute(index, 4));
    this.geometry.setAttribute("skinWeight", new Float32BufferAttribute(weight, 4));
    this.shows(new Set(["bones", "meshes"]));
    this.spheres = this.parts.map(({ corners: [from, to] }) => {
      const box = new Box3().setFromArray(this.positions.subarray(3 * from, 3 * to));
      return box.getBoundingSphere(new Sphere());
    });
  }

  /** Which of the looks there are. */
  get has(): Look[] {
    const more: Look[] = [];
    if (this.meshed.size > 0) more.push("meshes");
    if (this.skin) more.push("skin");
    return more.length > 0 ? ["bones", ...more] : [];
  }

  /** Whether a part is seen: a mesh in place of the bone of its segment, or that bone. */
  seen(part: Part): boolean {
    const [a, b] = part.segments;
    if (part.mesh) return this.look.has("meshes");
    return this.look.has("bones") && !(a === b && this.look.has("meshes") && this.meshed.has(a));
  }

  /** Draws the parts that are to be seen. */
  shows(look: ReadonlySet<Look>): void {
    this.look = look;
    const seen = this.parts.filter((part) => this.seen(part)).map(({ triangles: [from, to] }) => this.triangles.subarray(3 * from, 3 * to));
    const index = new Uint32Array(seen.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of seen) {
      index.set(part, at);
      at += part.length;
    }
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }

  dispose(): void {
    this.geometry.dispose();
    this.skin?.geometry.dispose();
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
    // Where a skin hides everything, its bones are met.
    const none = !this.parts.some((part) => this.seen(part));
    for (const [index, part] of this.parts.entries()) {
      if (!none && !this.seen(part)) continue;
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
  readonly skin: Skin | null = null;

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
    // Files do not always say which side is outside.
    if (shape.has.length > 0) this.material.side = DoubleSide;
    this.mesh = new SkinnedMesh(shape.geometry, this.material);
    this.mesh.frustumCulled = false;
    // Matrices are of the world: the place of the mesh comes on top of them.
    this.mesh.bindMode = DetachedBindMode;
    this.mesh.bind(this.skeleton, new Matrix4());
    if (shape.skin) {
      this.skin = new Skin(shape.skin, actor);
      this.mesh.add(this.skin.mesh);
    }
    this.moved();
  }

  /** What is seen of it. */
  looks(look: ReadonlySet<Look>): void {
    this.skin?.shows(look.has("skin"), this.shape.parts.some((part) => this.shape.seen(part)));
  }

  /** Takes over the pose that was evaluated last. */
  moved(): void {
    this.skeleton.boneMatrices!.set(this.actor.moves);
    this.skeleton.boneTexture!.needsUpdate = true;
    this.skin?.moved();
  }

  /** Whether other things are seen through it, and a colour laid over it. */
  ghost(on: boolean, colour = on ? 0x86b4ff : 0xffffff): void {
    this.material.transparent = on;
    this.material.opacity = on ? 0.45 : 1;
    this.material.depthWrite = !on;
    this.material.color.set(colour);
    this.skin?.material.color.set(colour);
    this.material.needsUpdate = true;
  }

  /** The box of all its corners. */
  box(): Box3 {
    const box = new Box3();
    const [matrix, corner] = [new Matrix4(), new Vector3()];
    const moves = this.actor.moves;
    const none = !this.shape.parts.some((part) => this.shape.seen(part));
    for (const part of this.shape.parts) {
      if (!none && !this.shape.seen(part)) continue;
      matrix.fromArray(moves, 16 * part.segments[0]);
      const [from, to] = part.corners;
      for (let i = from; i < to; i += to - from > 400 ? 4 : 1) {
        box.expandByPoint(corner.fromArray(this.shape.positions, 3 * i).applyMatrix4(matrix));
      }
    }
    if (box.isEmpty()) box.set(new Vector3(-0.5, -0.5, -0.5), new Vector3(0.5, 0.5, 0.5));
    return box.translate(this.mesh.position);
  }

  dispose(): void {
    this.material.dispose();
    this.skeleton.dispose();
    this.skin?.dispose();
  }
}

/** Numbers of several answers, one after the other. */
function joined(all: Answer<Packed>[], of: (value: Packed) => Span): Float32Array {
  const parts = all.map((answer) => answer.floats(of(answer.value)));
  const out = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}

/** Colours of a screen as light. */
export function linear(colours: Float32Array): Float32Array {
  return colours.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
}
