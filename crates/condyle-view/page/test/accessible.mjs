// The page for everybody, in a real browser: node accessible.mjs CONDYLE CHROMIUM, the command and the browser.
// axe-core finds controls without names and text without contrast, in light and dark, at 100 % and at 200 %; and all is
// reached by keys alone.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [condyle, browserPath] = process.argv.slice(2);
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const folder = mkdtempSync(join(tmpdir(), "condyle-accessible-"));
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

// A motion that leaves its limits, so that findings and the timeline are there, too.
const motion = join(folder, "lift.csv");
writeFileSync(motion, `time,elbow_flex_r,knee_angle_r\n${Array.from({ length: 21 }, (_, i) => `${i / 10},${0.2 * i},0.1`).join("\n")}\n`);
const moving = join(folder, "moving.html");
execFileSync(condyle, ["export", "page", "human", motion, "-o", moving]);
const still = join(folder, "still.html");
execFileSync(condyle, ["export", "page", "human", "-o", still]);

async function opened(file, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
  if (file === moving) await page.waitForSelector("#findings [data-kind=violation]");
  // Something is selected, so that networks and numbers are seen.
  await page.evaluate(() => window.condyle.select(window.condyle.model.about.segments.findIndex((s) => s.name === "radius_r")));
  return page;
}

async function test(name, run) {
  try {
    await run();
    console.log(`   ok: ${name}`);
  } catch (error) {
    console.error(`   FAILED: ${name}: ${error.message}`);
    process.exitCode = 1;
  }
}

for (const colorScheme of ["light", "dark"]) {
  for (const [zoom, width, height] of [[1, 1280, 800], [2, 640, 400]]) {
    await test(`${colorScheme} at ${100 * zoom} %: names, roles and contrast`, async () => {
      const page = await opened(moving, { colorScheme, viewport: { width, height }, deviceScaleFactor: zoom });
      for (const menu of await page.locator("nav summary").all()) {
        await menu.click();
        await audited(page);
        await menu.click();
      }
      await page.evaluate(() => {
        for (const set of [...document.querySelectorAll("#coordinates details")].slice(0, 6)) set.open = true;
      });
      await audited(page);
      await page.keyboard.press("?");
      await audited(page);
      // Nothing lies beside the window: at 200 % the parts of the page stand one below the other.
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      if (wide > 0) throw new Error(`${wide} pixels of the page lie beside the window`);
      await page.context().close();
    });
  }
}

/** Faults that axe-core finds in what is seen now. */
async function audited(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] }));
  if (violations.length === 0) return;
  throw new Error(violations.map(({ id, help, nodes }) => `${id}: ${help}:\n      ${nodes.slice(0, 4).map((node) => `${node.html.slice(0, 160)} ${node.failureSummary?.replaceAll("\n", " ")}`).join("\n      ")}`).join("\n    "));
}

await test("every control is reached by keys, and none holds them", async () => {
  const page = await opened(moving, { viewport: { width: 1280, height: 800 } });
  const controls = await page.evaluate(() => {
    const seen = (node) => node.checkVisibility({ visibilityProperty: true, contentVisibilityAuto: true }) && !node.disabled;
    const all = [...document.querySelectorAll("button, input, select, summary, [tabindex='0']")].filter(seen);
    all.forEach((node, index) => (node.dataset.control = String(index)));
    return all.map((node) => node.outerHTML.slice(0, 100));
  });
  const reached = new Set();
  await page.evaluate(() => document.activeElement?.blur());
  for (let i = 0; i < controls.length + 20; i++) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => document.activeElement?.dataset.control ?? "");
    if (at !== "") reached.add(Number(at));
  }
  const missed = controls.filter((_, index) => !reached.has(index));
  if (controls.length < 30 || missed.length > 0) throw new Error(`${missed.length} of ${controls.length} are not reached: ${missed.slice(0, 5).join("\n")}`);
  await page.close();
});

await test("a bone is chosen, posed and undone by keys", async () => {
  const page = await opened(still, { viewport: { width: 1280, height: 800 } });
  const values = () => page.evaluate(() => Array.from(window.condyle.model.actors[0].effective));
  const differ = (a, b) => a.some((x, i) => Math.abs(x - b[i]) > 1e-9);
  await page.focus("#picture");
  const rest = await values();
  await page.keyboard.press("d");
  for (let i = 0; i < 5; i++) await page.keyboard.press("ArrowUp");
  const moved = await values();
  if (!differ(rest, moved)) throw new Error("arrow keys moved no bone");
  for (let i = 0; i < 5; i++) await page.keyboard.press("u");
  if (differ(rest, await values())) throw new Error("undo does not bring the pose back");
  const before = await page.evaluate(() => window.condyle.selected);
  await page.keyboard.press("j");
  if ((await page.evaluate(() => window.condyle.selected)) === before) throw new Error("the next bone was not chosen");
  await page.close();
});

await browser.close();
rmSync(folder, { recursive: true });
