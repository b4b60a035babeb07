// Undo and redo of poses, and of what else changes with them.

/** Something that is undone beside poses; what it gives is never changed, only replaced. */
export interface Part {
  get(): unknown;
  set(value: never): void;
}

interface Kept {
  pose: Float64Array;
  parts: unknown[];
}

export class History {
  readonly parts: Part[] = [];
  private past: Kept[] = [];
  private future: Kept[] = [];

  /** Forgets everything: this is where things begin. */
  begin(pose: Float64Array): void {
    this.past = [this.now(pose)];
    this.future = [];
  }

  /** Remembers a pose after a change. */
  keep(pose: Float64Array): void {
    const last = this.past.at(-1);
    const next = this.now(pose);
    if (last && last.parts.every((part, i) => part === next.parts[i]) && last.pose.every((value, i) => value === pose[i])) return;
    this.past.push(next);
    if (this.past.length > 500) this.past.shift();
    this.future = [];
  }

  undo(): Float64Array | null {
    if (this.past.length < 2) return null;
    this.future.push(this.past.pop()!);
    return this.restored(this.past.at(-1)!);
  }

  redo(): Float64Array | null {
    const next = this.future.pop();
    if (!next) return null;
    this.past.push(next);
    return this.restored(next);
  }

  private now(pose: Float64Array): Kept {
    return { pose: pose.slice(), parts: this.parts.map((part) => part.get()) };
  }

  private restored({ pose, parts }: Kept): Float64Array {
    this.parts.forEach((part, i) => part.set(parts[i] as never));
    return pose;
  }
}
