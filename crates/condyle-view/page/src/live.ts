// Changes that the server tells.

import { carried } from "./again";
import type { App } from "./app";
import { trackAgain } from "./aside";
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

/** Shows what the session holds now, in the pose and at the time that are there; motions follow. */
async function again(app: App): Promise<void> {
  const session = await served();
  if (!session?.model) return;
  const { name, format, text } = session.model;
  const before = app.model?.about;
  const seen = app.chosen.map((which) => app.motions[which]?.name);
  // None, or all in a row.
  const second = Math.min(app.chosen[1], -1);
  const old = app.motions;
  const taken = app.core.take(`${name}.${format}`, new TextEncoder().encode(text), null);
  if (!taken.model) return;
  const { motions: all, said } = before ? carried(old, before, taken.model.about) : { motions: [], said: [] };
  // Those that were dropped on the page are known here alone.
  const motions = all.filter((motion) => !session.motions.some((other) => other.name === motion.name));
  app.open(taken.model, session.title, [...session.motions, ...motions], true);
  const index = (wanted: string | undefined) => app.motions.findIndex((motion) => motion.name === wanted);
  if (seen[0] !== undefined && index(seen[0]) >= 0) app.chosen = [index(seen[0]), seen[1] === undefined ? second : index(seen[1])];
  app.motionsChanged();
  app.dress(await looks(session.model.geometry));
  app.timed();
  if (said.length > 0) app.say(said);
  const shown = app.motions[app.chosen[0]];
  if (shown?.markers) void app.attempt(() => trackAgain(app, shown, false));
}
