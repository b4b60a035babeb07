// Starts the page.

import { App } from "./app";
import { authoring } from "./authoring";
import { Core } from "./core";
import { byId } from "./dom";
import { live } from "./live";
import { looks } from "./looks";
import { pointer } from "./pointer";
import { Quaternions } from "./quaternions";
import { evaluator, session } from "./session";
import { tools } from "./tools";

declare global {
  interface Window {
    /** For tests and for who is curious: the page as it is now. */
    condyle?: App;
  }
}

async function start(): Promise<void> {
  const [given, core] = await Promise.all([session(), evaluator().then((packed) => Core.start(packed))]);
  const app = new App(core, given);
  const dragging = { on: false };
  tools(app, dragging);
  pointer(app, dragging);
  app.quaternions = new Quaternions(app);
  await app.attempt(() => {
    if (given.model) {
      const { name, format, text } = given.model;
      const taken = core.take(`${name}.${format}`, new TextEncoder().encode(text), null);
      if (taken.model) app.open(taken.model, given.title, given.motions);
      if (given.motions[0]?.markers) app.toggle("markers");
      app.timed();
    } else {
      app.took(core.take("human", new Uint8Array(), null), "human");
    }
  });
  byId("waiting").hidden = true;
  await app.attempt(async () => app.dress(await looks(given.model?.geometry)));
  dropping(app);
  if (given.mode === "served") live(app);
  if (given.mode === "served" && given.editable) authoring(app);
  window.condyle = app;
  document.documentElement.dataset["ready"] = "yes";
}

/** Files that are dropped on the page. */
function dropping(app: App): void {
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  document.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) document.body.classList.remove("dropping");
  });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    void app.take(event.dataTransfer?.files ?? []);
  });
}

start().catch((error: unknown) => {
  byId("waiting").textContent = `the page cannot start: ${error instanceof Error ? error.message : String(error)}`;
});
