// The rotations of a joint in the space of quaternions, in a browser: that it is drawn, that it says where the pose is, that
// it turns by keys; and that the reach of a learned limit does not keep a person waiting.
// Usage: node rotations.mjs CONDYLE CHROMIUM MODELS
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [condyle, executablePath] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "condyle-rotations-"));
const file = join(folder, "human.html");
execFileSync(condyle, ["export", "page", "human", "-o", file]);
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath, args });
try {
  for (const colorScheme of ["light", "dark"]) {
    const page = await browser.newPage({ viewport: { width: 1200, height: 900 }, colorScheme });
    const errors = [];
    page.on("pageerror", (error) => errors.push(error.message));
    await page.goto(`file://${file}`);
    await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
    assert.equal(await page.isVisible("#quaternions"), false, "nothing is looked at yet");
    // An arm that is twisted much too far, limits off.
    await page.evaluate(() => {
      const app = window.condyle;
      app.limits(false);
      app.look(app.model.about.sets.indexOf("shoulder_r"));
      const turn = app.model.about.coordinates.find((c) => c.name === "shoulder_rotation_r");
      app.model.actors[0].asked[turn.place] = -2.6;
      app.changed(true);
    });
    const said = page.locator("#quaternions p[role=status]");
    await said.filter({ hasText: /\d° outside/ }).waitFor({ timeout: 60_000 });
    const coloured = () =>
      page.evaluate(async () => {
        const canvas = document.querySelector("#quaternions canvas");
        await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
        const copy = document.createElement("canvas");
        [copy.width, copy.height] = [canvas.width, canvas.height];
        const context = copy.getContext("2d");
        context.drawImage(canvas, 0, 0);
        const { data } = context.getImageData(0, 0, copy.width, copy.height);
        const [first, second, third] = data;
        let count = 0;
        let sum = 0;
        for (let i = 0; i < data.length; i += 4) {
          const off = Math.abs(data[i] - first) + Math.abs(data[i + 1] - second) + Math.abs(data[i + 2] - third);
          if (off > 40) [count, sum] = [count + 1, (sum * 31 + i) % 1_000_003];
        }
        return { share: (4 * count) / data.length, sum };
      });
    await page.waitForFunction(() => document.querySelector("#quaternions canvas").width > 100);
    const before = await coloured();
    assert.ok(before.share > 0.1 && before.share < 0.9, `${colorScheme}: ${before.share} of the canvas is drawn on`);
    // By keys it turns.
    await page.focus("#quaternions canvas");
    for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowRight");
    assert.notEqual((await coloured()).sum, before.sum, "arrow keys turn it");
    // With limits the pose is inside, or on the boundary.
    await page.evaluate(() => {
      const app = window.condyle;
      app.neutral();
    });
    await said.filter({ hasText: /\d° inside/ }).waitFor({ timeout: 60_000 });
    // What the command's evaluator draws is what the page shows: a boundary, and no recorded rotations of a limit by formulas.
    const legend = await page.locator("#quaternions .legend").innerText();
    assert.ok(legend.includes("boundary") && !legend.includes("recorded"), legend);
    // A joint without such a limit has none.
    await page.evaluate(() => window.condyle.look(window.condyle.model.about.sets.indexOf("elbow_r")));
    await page.locator("#quaternions").waitFor({ state: "hidden", timeout: 60_000 });
    assert.deepEqual(errors, []);
    await page.close();
  }
  console.log("the rotations of a joint are seen in the space of quaternions");
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
