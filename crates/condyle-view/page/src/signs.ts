// Signs beside the bones: axes, centres, limits, contacts, as the evaluator draws them for `condyle render`.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshLambertMaterial,
  Points,
  PointsMaterial,
  type Vector2,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Answer, Model, Span } from "./core";

export interface Packed {
  surfaces: { positions: Span; normals: Span; triangles: Span; colour: number; opacity: number }[];
  lines: { points: Span; width: number; colour: number; opacity: number; through: number }[];
  labels: Label[];
  clouds?: { points: Span; colour: number; size: number }[];
  title?: string | null;
}

export interface Label {
  at: [number, number, number];
  text: string;
  colour: number;
}

export const KINDS = ["frames", "axes", "centres", "limits", "contacts", "markers", "names"] as const;
export type Kind = (typeof KINDS)[number];

export interface Asked {
  actor: number;
  show: Kind[];
  at: string[];
  unit: number;
}

/** Lines alike, drawn at once. */
interface Batch {
  places: number[];
  colours: number[];
  width: number;
  opacity: number;
}

export class Signs {
  readonly group = new Group();
  labels: Label[] = [];
  /** The lines and surfaces that are drawn. */
  count = 0;

  /** Draws anew what is asked for. */
  update(model: Model, asked: Asked, size: Vector2): void {
    if (asked.show.length === 0) this.clear();
    else this.show(model.ask<Packed>("signs", asked), size);
  }

  /** Draws what the evaluator answers. */
  show(answer: Answer<Packed>, size: Vector2): void {
    this.clear();
    this.labels = answer.value.labels;
    this.count = answer.value.surfaces.length + answer.value.lines.length;
    this.surfaces(answer);
    this.lines(answer, size);
    for (const { points, colour, size: wide } of answer.value.clouds ?? []) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(answer.floats(points), 3));
      this.group.add(new Points(geometry, new PointsMaterial({ color: colour, size: wide, sizeAttenuation: false })));
    }
  }

  /** The picture has another size. */
  resized(size: Vector2): void {
    for (const child of this.group.children) if (child instanceof LineSegments2) child.material.resolution.copy(size);
  }

  clear(): void {
    for (const child of this.group.children) {
      const { geometry, material } = child as Mesh<BufferGeometry, MeshLambertMaterial>;
      geometry.dispose();
      material.dispose();
    }
    this.group.clear();
    this.labels = [];
    this.count = 0;
  }

  private surfaces(answer: Answer<Packed>): void {
    for (const surface of answer.value.surfaces) {
      if (surface.triangles[1] === 0) continue;
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(answer.floats(surface.positions), 3));
      geometry.setAttribute("normal", new Float32BufferAttribute(answer.floats(surface.normals), 3));
      geometry.setIndex(new BufferAttribute(answer.corners(surface.triangles), 1));
      const seen = surface.opacity < 1;
      const material = new MeshLambertMaterial({
        color: surface.colour,
        transparent: seen,
        opacity: surface.opacity,
        depthWrite: !seen,
        side: DoubleSide,
        // A sheet is as bright as its colour on both sides.
        emissive: seen ? surface.colour : 0,
        emissiveIntensity: 0.35,
      });
      this.group.add(new Mesh(geometry, material));
    }
  }

  private lines(answer: Answer<Packed>, size: Vector2): void {
    const before = new Map<string, Batch>();
    const behind = new Map<string, Batch>();
    for (const line of answer.value.lines) {
      const points = answer.floats(line.points);
      add(before, line.width, line.opacity, points, line.colour);
      // What is hidden shows through a little.
      if (line.through > 0) add(behind, line.width, line.through, points, line.colour);
    }
    for (const batch of behind.values()) this.group.add(drawn(batch, size, false));
    for (const batch of before.values()) this.group.add(drawn(batch, size, true));
  }
}

function add(to: Map<string, Batch>, width: number, opacity: number, points: Float32Array, colour: number): void {
  const key = `${width} ${opacity}`;
  let batch = to.get(key);
  if (!batch) to.set(key, (batch = { places: [], colours: [], width, opacity }));
  const { r, g, b } = new Color(colour);
  for (let i = 0; i + 5 < points.length; i += 3) {
    for (let k = 0; k < 6; k++) batch.places.push(points[i + k]!);
    batch.colours.push(r, g, b, r, g, b);
  }
}

function drawn(batch: Batch, size: Vector2, tested: boolean): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(batch.places);
  geometry.setColors(batch.colours);
  const material = new LineMaterial({
    linewidth: batch.width,
    vertexColors: true,
    transparent: true,
    opacity: batch.opacity,
    depthTest: tested,
    depthWrite: false,
  });
  material.resolution.copy(size);
  const lines = new LineSegments2(geometry, material);
  lines.renderOrder = tested ? 2 : 1;
  lines.frustumCulled = false;
  return lines;
}
