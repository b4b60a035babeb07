// Changes that the server tells.

import type { App } from "./app";
import { looks } from "./looks";
import { served } from "./session";

interface Told {
  kind: "model" | "fault" | "mended";
  text?: string;
  line?: number;
  excerpt?: string;
}

export function live(app: App): void {
  const events = new EventSource("events");
  events.addEventListener("message", (event: MessageEvent<string>) => {
    const told = JSON.parse(event.data) as Told;
    if (told.kind === "model") void app.attempt(() => again(app));
    else if (told.kind === "mended") app.say([]);
    else app.say([{ severity: "error", text: [told.text ?? "", told.excerpt ?? ""].join("\n"), line: told.line ?? null }]);
  });
}

/** Shows what the session holds now, in the pose that is there. */
async function again(app: App): Promise<void> {
  const session = await served();
  if (!session?.model) return;
  const { name, format, text } = session.model;
  const taken = app.core.take(`${name}.${format}`, new TextEncoder().encode(text), null);
  if (taken.model) app.open(taken.model, session.title, session.motions, true);
  app.dress(await looks(session.model.geometry));
}
