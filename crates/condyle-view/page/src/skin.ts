// A skin over the bones: a corner p is at the sum of w S B p, with the places S of segments.

import {
  Bone,
  BufferAttribute,
  BufferGeometry,
  DetachedBindMode,
  DoubleSide,
  Float32BufferAttribute,
  Matrix4,
  MeshStandardMaterial,
  Skeleton,
  SkinnedMesh,
  Uint16BufferAttribute,
} from "three";
import type { Actor, Answer } from "./core";
import { linear } from "./figure";
import type { PackedSkin } from "./looks";

/** A skin that all poses of a model share. */
export class SkinShape {
  readonly geometry = new BufferGeometry();
  readonly holds: { segment: number | null; bind: Matrix4 }[];

  constructor(packed: Answer<PackedSkin>) {
    const { value } = packed;
    const set = (name: string, span: typeof value.positions, width: number) =>
      this.geometry.setAttribute(name, new Float32BufferAttribute(packed.floats(span), width));
    set("position", value.positions, 3);
    set("normal", value.normals, 3);
    set("skinWeight", value.weights, 4);
    this.geometry.setAttribute("color", new Float32BufferAttribute(linear(packed.floats(value.colours)), 3));
    this.geometry.setAttribute("skinIndex", new Uint16BufferAttribute(Uint16Array.from(packed.corners(value.carriers)), 4));
    this.geometry.setIndex(new BufferAttribute(packed.corners(value.triangles), 1));
    this.holds = value.holds.map(({ segment, bind }) => ({ segment, bind: new Matrix4().fromArray(bind) }));
  }
}

/** A skin in one pose. */
export class Skin {
  readonly mesh: SkinnedMesh;
  readonly material = new MeshStandardMaterial({ vertexColors: true, roughness: 0.8, metalness: 0, side: DoubleSide });
  private readonly skeleton: Skeleton;

  constructor(
    private readonly shape: SkinShape,
    private readonly actor: Actor,
  ) {
    this.skeleton = new Skeleton(Array.from({ length: shape.holds.length }, () => new Bone()));
    this.skeleton.computeBoneTexture();
    this.skeleton.update = () => undefined;
    this.mesh = new SkinnedMesh(shape.geometry, this.material);
    this.mesh.frustumCulled = false;
    this.mesh.bindMode = DetachedBindMode;
    this.mesh.bind(this.skeleton, new Matrix4());
    this.mesh.renderOrder = 1;
  }

  /** Takes over the pose that was evaluated last. */
  moved(): void {
    const { places } = this.actor;
    const place = new Matrix4();
    this.shape.holds.forEach(({ segment, bind }, index) => {
      // Places are row by row, matrices column by column.
      if (segment === null) place.identity();
      else place.fromArray(places, 16 * segment).transpose();
      place.multiply(bind).toArray(this.skeleton.boneMatrices!, 16 * index);
    });
    this.skeleton.boneTexture!.needsUpdate = true;
  }

  /** Whether it is seen, and whether bones are seen through it. */
  shows(on: boolean, through: boolean): void {
    this.mesh.visible = on;
    this.material.transparent = through;
    this.material.opacity = through ? 0.4 : 1;
    this.material.depthWrite = !through;
    this.material.needsUpdate = true;
  }

  dispose(): void {
    this.material.dispose();
    this.skeleton.dispose();
  }
}
