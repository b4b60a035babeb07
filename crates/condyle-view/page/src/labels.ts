// Names over the picture.

import { element } from "./dom";
import type { Label } from "./signs";
import type { View } from "./view";

const MOST = 160;

export class Labels {
  private labels: Label[] = [];
  private spans: HTMLElement[] = [];

  constructor(
    private readonly root: HTMLElement,
    private readonly view: View,
  ) {}

  set(labels: Label[]): void {
    this.labels = labels.slice(0, MOST);
    while (this.spans.length < this.labels.length) this.spans.push(element("span"));
    this.spans.length = this.labels.length;
    this.labels.forEach((label, i) => (this.spans[i]!.textContent = label.text));
    this.root.replaceChildren(...this.spans);
  }

  /** Puts them where they belong in the picture that is drawn next. */
  place(): void {
    this.labels.forEach((label, i) => {
      const at = this.view.project(label.at);
      this.spans[i]!.style.transform = at ? `translate(${at[0] + 6}px, ${at[1] - 9}px)` : "translate(-999px, 0)";
    });
  }
}
