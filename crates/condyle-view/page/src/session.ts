// What the page is given to show: inside the page, from the server beside it, or nothing.

import type { Given } from "./looks";
import { type Motion, type PackedMotion, bytesOf, unpacked } from "./core";

export interface Session {
  mode: "served" | "exported" | "static";
  title: string;
  model: { name: string; format: string; text: string; geometry?: Given } | null;
  motions: Motion[];
  editable: boolean;
  source: string | null;
}

type Packed = Omit<Session, "motions"> & { motions: PackedMotion[] };

const nothing: Session = {
  mode: "static",
  title: "condyle",
  model: null,
  motions: [],
  editable: false,
  source: null,
};

/** The session of this page. */
export async function session(): Promise<Session> {
  const inside = document.getElementById("session");
  if (inside) return opened(JSON.parse(inside.textContent ?? "") as Packed);
  return (await served()) ?? nothing;
}

/** The session that a server hands out, if there is one. */
export async function served(): Promise<Session | null> {
  try {
    const response = await fetch("session.json", { cache: "no-store" });
    return response.ok ? opened((await response.json()) as Packed) : null;
  } catch {
    return null; // A static site has none.
  }
}

function opened(packed: Packed): Session {
  const inSession = (): Float32Array => new Float32Array();
  return { ...packed, motions: packed.motions.map((motion) => unpacked(motion, inSession)) };
}

/** The packed evaluator. */
export async function evaluator(): Promise<Uint8Array> {
  const inside = document.getElementById("core");
  if (inside) return bytesOf(inside.textContent ?? "");
  const response = await fetch("assets/core.wasm.lzma");
  if (!response.ok) throw new Error("the evaluator cannot be loaded");
  return new Uint8Array(await response.arrayBuffer());
}
