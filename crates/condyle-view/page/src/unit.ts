// Numbers as people read them: degrees and centimetres.

import type { Coordinate } from "./core";

export interface Unit {
  /** Shown numbers in one stored. */
  factor: number;
  sign: string;
  digits: number;
}

export function unitOf(kind: Coordinate["kind"]): Unit {
  if (kind === "rotation" || kind === "orientation") return { factor: 180 / Math.PI, sign: "°", digits: 1 };
  if (kind === "translation") return { factor: 100, sign: "cm", digits: 2 };
  return { factor: 1, sign: "", digits: 3 };
}

export function shown(value: number, unit: Unit): string {
  const text = (value * unit.factor).toFixed(unit.digits);
  // No minus before nothing.
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text;
}

/** The ends of a slider: the range, or as far as makes sense. */
export function reach({ kind, lower, upper, default: [neutral = 0] }: Coordinate): [number, number] {
  const usual = kind === "rotation" || kind === "orientation" ? Math.PI : 1;
  return [lower ?? Math.min(neutral, upper ?? neutral) - usual, upper ?? Math.max(neutral, lower ?? neutral) + usual];
}

type Four = [number, number, number, number];

/** The rotation vector of a quaternion, in radians. */
export function vectorOf([x, y, z, w]: Four): [number, number, number] {
  const sign = w < 0 ? -1 : 1;
  const sine = Math.hypot(x, y, z);
  const length = 2 * Math.atan2(sine, sign * w);
  const scale = sine < 1e-12 ? 2 : length / sine;
  return [sign * x * scale, sign * y * scale, sign * z * scale];
}

/** The quaternion of a rotation vector. */
export function quaternionOf([x, y, z]: readonly [number, number, number]): Four {
  const angle = Math.hypot(x, y, z);
  const scale = angle < 1e-12 ? 0.5 : Math.sin(angle / 2) / angle;
  return [x * scale, y * scale, z * scale, Math.cos(angle / 2)];
}
