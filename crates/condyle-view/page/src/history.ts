// Undo and redo of poses.

export class History {
  private past: Float64Array[] = [];
  private future: Float64Array[] = [];

  /** Forgets everything: this is where things begin. */
  begin(pose: Float64Array): void {
    this.past = [pose.slice()];
    this.future = [];
  }

  /** Remembers a pose after a change. */
  keep(pose: Float64Array): void {
    const last = this.past.at(-1);
    if (last && last.every((value, i) => value === pose[i])) return;
    this.past.push(pose.slice());
    if (this.past.length > 500) this.past.shift();
    this.future = [];
  }

  undo(): Float64Array | null {
    if (this.past.length < 2) return null;
    this.future.push(this.past.pop()!);
    return this.past.at(-1)!;
  }

  redo(): Float64Array | null {
    const next = this.future.pop();
    if (!next) return null;
    this.past.push(next);
    return next;
  }
}
