// What a model looks like beside its own shapes: meshes of files, and a skin, as the session gives them.

import { Answer, type Span, bytesOf } from "./core";

/** Surfaces at the defaults, each carried by one segment or by two. */
export interface Packed {
  positions: Span;
  normals: Span;
  colours: Span;
  carriers: Span;
  triangles: Span;
  parts: Part[];
}

/** A bone, or what hangs between two. */
export interface Part {
  name: string;
  segments: [number, number];
  corners: [number, number];
  triangles: [number, number];
  /** Whether it comes from a file that the model names. */
  mesh?: boolean;
}

/** A surface that four holds carry at each corner. */
export interface PackedSkin {
  positions: Span;
  normals: Span;
  colours: Span;
  weights: Span;
  carriers: Span;
  triangles: Span;
  /** Segments, each with the transform from the surface to it, column by column. */
  holds: { segment: number | null; bind: number[] }[];
}

export interface Looks {
  meshes: Answer<Packed> | null;
  skin: Answer<PackedSkin> | null;
}

/** Names and texts of a session's looks; the numbers are at an address or inside. */
export type Given = Record<string, { at: string | null; numbers: string | null; text: unknown }>;

/** What can be seen of a figure. */
export const LOOKS = ["bones", "meshes", "skin"] as const;
export type Look = (typeof LOOKS)[number];

/** Fetches what there is; `null` if there is nothing. */
export async function looks(given: Given | undefined): Promise<Looks | null> {
  const one = async <T>(name: string): Promise<Answer<T> | null> => {
    const entry = given?.[name];
    if (!entry) return null;
    if (entry.numbers !== null) return new Answer(entry.text as T, bytesOf(entry.numbers).buffer);
    const response = await fetch(entry.at ?? "", { cache: "no-store" });
    return response.ok ? new Answer(entry.text as T, await response.arrayBuffer()) : null;
  };
  const [meshes, skin] = await Promise.all([one<Packed>("meshes"), one<PackedSkin>("skin")]);
  return meshes || skin ? { meshes, skin } : null;
}
