// Key poses, goals, and files of all formats on the page as a static site: node posing.mjs CONDYLE CHROMIUM MODELS.
// It waits for states, never for times.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [condyle, browserPath] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "condyle-posing-"));
const failures = [];
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const root = new URL("../dist/", import.meta.url);
const types = { html: "text/html", js: "text/javascript", lzma: "application/octet-stream" };
const asked = [];
const server = createServer((request, response) => {
  const path = request.url === "/" ? "index.html" : request.url.slice(1);
  asked.push(path);
  try {
    response.writeHead(200, { "content-type": types[path.split(".").at(-1)] }).end(readFileSync(new URL(path, root)));
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));

function check(good, what) {
  if (!good) throw new Error(what);
}

async function opened(file) {
  const page = await browser.newPage({ viewport: { width: 1100, height: 760 }, colorScheme: process.env.DARK ? "dark" : "light" });
  page.on("pageerror", (error) => failures.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" && !message.location().url.endsWith("/session.json")) failures.push(message.text());
  });
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
  if (file) await given(page, file);
  return page;
}

async function given(page, ...files) {
  await page.setInputFiles("input[type=file]", files);
}

async function test(name, run) {
  if (process.env.ONLY && !name.includes(process.env.ONLY)) return;
  try {
    await run();
    if (failures.length > 0) throw new Error(failures.join("\n"));
    console.log(`   ok: ${name}`);
  } catch (error) {
    console.error(`   FAILED: ${name}: ${error.message}`);
    process.exitCode = 1;
    failures.length = 0;
  }
}

/** A download that a click begins, as a file. */
async function downloaded(page, selector, name) {
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  const file = join(folder, name);
  await saved.saveAs(file);
  return file;
}

/** A picture for who wants to look. */
async function picture(page, name) {
  if (process.env.PICTURES) await page.screenshot({ path: join(process.env.PICTURES, `${name}.png`) });
}

/** Names and rows of a table in CSV. */
function table(text) {
  const [names, ...rows] = text.split("\n").filter((line) => line && !line.startsWith("#"));
  return { names: names.split(","), rows: rows.map((row) => row.split(",").map(Number)) };
}

/** Poses the figure by the names of coordinates, and sets a key at a time. */
async function keyed(page, time, values) {
  await page.evaluate((values) => {
    const app = window.condyle;
    const { coordinates } = app.model.about;
    for (const [key, value] of Object.entries(values)) app.model.actors[0].asked[coordinates.find((c) => c.key === key).place] = value;
    app.changed(true);
  }, values);
  await page.evaluate((time) => window.condyle.keys.set(time), time);
}

await test("keys that are set on the page are the command's", async () => {
  const page = await opened();
  await page.click("#keys > summary");
  await page.click("#set-key");
  await keyed(page, 0.5, { elbow_flex_r: 1.8, shoulder_elevation_r: 1.2, knee_angle_r: 0.4 });
  await keyed(page, 1.25, { elbow_flex_r: 0.3, shoulder_elevation_r: 0.2 });
  check((await page.locator(".lane .key").count()) === 3, "three keys are above the timeline");
  await picture(page, "keys");
  // The second is left on lines.
  await page.selectOption("[aria-label='how key 2 is left']", "linear");
  const file = await downloaded(page, "#save-keys", "keys.json");
  const out = join(folder, "keys.csv");
  execFileSync(condyle, ["convert", file, out, "--model", "human", "--rate", "60"], { stdio: ["ignore", "ignore", "ignore"] });
  const { names, rows } = table(readFileSync(out, "utf8"));
  check(rows.length === 76, `the command makes ${rows.length} frames, not 76`);
  const worst = await page.evaluate(({ names, rows }) => {
    const app = window.condyle;
    const [actor] = app.model.actors;
    let worst = 0;
    for (const row of rows) {
      app.timeline.go(row[0]);
      for (const c of app.model.about.coordinates) {
        const at = names.indexOf(c.key);
        if (at >= 0) worst = Math.max(worst, Math.abs(actor.effective[c.place] - row[at]));
      }
    }
    return worst;
  }, { names, rows });
  check(worst < 1e-9, `the page differs from the command by ${worst}`);
  console.log(`   76 frames of human: at most ${worst.toExponential(1)} off`);
  // The motion that the page saves has the same numbers.
  await page.click("nav summary:has-text('save')");
  const own = table(readFileSync(await downloaded(page, "[data-save=csv]", "own.csv"), "utf8"));
  check(own.rows.length === 76, "the saved motion has all frames");
  own.names.forEach((name, at) => {
    const there = names.indexOf(name);
    if (there >= 0) own.rows.forEach((row, k) => check(Math.abs(row[at] - rows[k][there]) < 1e-9, `${name} in frame ${k}: ${row[at]}, ${rows[k][there]}`));
  });
  // The saved file comes back as it was.
  await page.close();
  const again = await opened(file);
  await again.waitForFunction(() => window.condyle.keys.list.length === 3 && window.condyle.keys.list[1].between === "linear");
  await again.close();
});

await test("keys are moved, deleted and played, and undone", async () => {
  const page = await opened();
  await page.focus("#picture");
  await page.keyboard.press("p");
  await keyed(page, 1, { elbow_flex_r: 1.5 });
  const times = () => page.evaluate(() => window.condyle.keys.list.map((key) => key.time));
  const mark = page.locator(".lane .key").nth(1);
  await mark.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  check(`${await times()}` === "0,1.11", `arrows moved it to ${await times()}`);
  // By the pointer, half way back.
  const box = await page.locator(".lane .key").nth(1).boundingBox();
  const lane = await page.locator(".lane").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 0.1 * lane.width, y, { steps: 4 });
  await page.mouse.up();
  const [, moved] = await times();
  check(moved > 0.7 && moved < 1.05, `the pointer moved it to ${moved} s`);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press("u");
  check(`${await times()}` === "0,1.11", `an undo leads to ${await times()}`);
  await page.keyboard.press("y");
  check((await times())[1] === moved, "and a redo back");
  await page.evaluate(() => window.condyle.timeline.go(0));
  await page.keyboard.press(" ");
  // It plays over the keys, again and again.
  await page.waitForFunction(() => window.condyle.timeline.time > 0.3);
  await page.waitForFunction(() => window.condyle.timeline.time < 0.3);
  await page.keyboard.press(" ");
  await page.locator(".lane .key").nth(1).focus();
  await page.keyboard.press("Delete");
  check((await times()).length === 1, "Delete deletes");
  await page.close();
});

await browser.close();
server.close();
rmSync(folder, { recursive: true });
