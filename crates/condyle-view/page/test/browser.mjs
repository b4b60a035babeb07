// The page in a real browser: node browser.mjs CONDYLE CHROMIUM MODELS, the command, the browser, and the folder with
// the texts of the shipped models.
// It waits for states, never for times, and looks at pixels, so that a blank picture fails.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [condyle, browserPath, models] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "condyle-page-"));
const failures = [];
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

function check(good, what) {
  if (!good) throw new Error(what);
}

/** A page that is ready; what it writes to its console as an error fails the test. */
async function opened(address) {
  const page = await browser.newPage({ viewport: { width: 1000, height: 700 } });
  page.on("pageerror", (error) => failures.push(`${address}: ${error.message}`));
  page.on("console", (message) => {
    // A static site has no session: that is how the page learns that it is one.
    if (message.type() === "error" && !message.location().url.endsWith("/session.json")) failures.push(`${address}: ${message.text()}`);
  });
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
  return page;
}

/** How many pixels are not of the background, and a number that changes with the picture. */
async function pixels(page) {
  return page.evaluate(async () => {
    const { view } = window.condyle;
    view.now();
    const { width, height } = view.renderer.domElement;
    const flat = new OffscreenCanvas(width, height).getContext("2d");
    flat.drawImage(view.renderer.domElement, 0, 0);
    const { data } = flat.getImageData(0, 0, width, height);
    let [bone, sum] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = data.subarray(i, i + 3);
      // Bones are warmer than background and grid, and cartilage and joints bluer than these by far.
      if (r - b > 12 || b - r > 25) bone += 1;
      sum = (sum * 31 + r + g * 3 + b * 7) % 4294967291;
    }
    return { bone, all: data.length / 4, sum };
  });
}

async function test(name, run) {
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

function exported(name, ...motions) {
  const file = join(folder, `${name}.html`);
  execFileSync(condyle, ["export", "page", name, ...motions, "-o", file]);
  return pathToFileURL(file).href;
}

const shipped = readdirSync(models).filter((file) => file.endsWith(".toml")).map((file) => file.slice(0, -5));
check(shipped.length > 5, `${models}: no models`);
for (const name of shipped) {
  await test(`${name} is seen`, async () => {
    const page = await opened(exported(name));
    const { bone, all } = await pixels(page);
    check(bone > 0.003 * all, `only ${bone} of ${all} pixels are of bones`);
    await page.close();
  });
}

await test("a slider moves its bone", async () => {
  const page = await opened(exported("human"));
  const before = await pixels(page);
  const place = () => page.evaluate(() => {
    const { model } = window.condyle;
    return model.actors[0].world(model.about.segments.findIndex((s) => s.name === "hand_r"), [0, 0, 0]);
  });
  const from = await place();
  await page.click("details[data-set] > summary:has-text('elbow_r')");
  const slider = page.locator("input[type=range][data-key='elbow_flex_r']");
  await slider.focus();
  for (let i = 0; i < 30; i++) await page.keyboard.press("ArrowRight");
  await slider.fill("90");
  const to = await place();
  const moved = Math.hypot(...from.map((x, i) => x - to[i]));
  check(moved > 0.2, `the hand moved by ${moved} m`);
  const after = await pixels(page);
  check(after.sum !== before.sum, "the picture stayed as it was");
  await page.click("#undo");
  await page.keyboard.press("u");
  await page.close();
});

await test("a hand that is dragged arrives, and no limit breaks", async () => {
  const page = await opened(exported("human"));
  await page.click("#drag");
  const at = await page.evaluate(() => {
    const { model, view } = window.condyle;
    const hand = model.about.segments.findIndex((s) => s.name === "radius_r");
    // The middle of the bone, where it is surely hit.
    const [x, y] = view.project(model.actors[0].world(hand, [0, -0.12, 0]));
    const box = document.getElementById("picture").getBoundingClientRect();
    return [x + box.left, y + box.top];
  });
  await page.mouse.move(...at);
  await page.mouse.down();
  for (let i = 1; i <= 8; i++) await page.mouse.move(at[0] - 6 * i, at[1] - 6 * i);
  const hover = await page.textContent("#hover");
  await page.mouse.up();
  const off = Number(/: ([\d.]+) mm/.exec(hover)?.[1] ?? NaN);
  check(off < 5, `after dragging it says: ${hover}`);
  const broken = await page.evaluate(() => {
    const { model } = window.condyle;
    const { effective } = model.actors[0];
    return model.about.coordinates.filter((c) => c.enforced && c.kind !== "orientation" && ((c.lower ?? -Infinity) - 1e-9 > effective[c.place] || (c.upper ?? Infinity) + 1e-9 < effective[c.place])).map((c) => c.key);
  });
  check(broken.length === 0, `out of range: ${broken}`);
  await page.close();
});

await test("a motion plays, and what it breaks is listed and found", async () => {
  const motion = join(folder, "bend.csv");
  const rows = Array.from({ length: 21 }, (_, i) => `${i / 10},${i < 12 ? 0.1 * i : 3.5}`);
  writeFileSync(motion, `time,knee_angle_r\n${rows.join("\n")}\n`);
  const page = await opened(exported("knee", motion));
  await page.waitForSelector("#findings [data-kind=violation]");
  await page.click("#findings [data-kind=violation]");
  const time = await page.evaluate(() => window.condyle.timeline.time);
  check(time >= 1.15, `it went to ${time} s`);
  await page.evaluate(() => window.condyle.timeline.go(0));
  await page.keyboard.press("Escape");
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press(" ");
  await page.waitForFunction(() => window.condyle.timeline.playing && window.condyle.timeline.time > 0.3);
  await page.close();
});

await test("the demo's page follows what walks", async () => {
  execFileSync(condyle, ["demo", "-o", folder]);
  const page = await opened(pathToFileURL(join(folder, "demo.html")).href);
  const at = (time) => page.evaluate((time) => window.condyle.timeline.go(time), time);
  const root = () => page.evaluate(() => Array.from(window.condyle.model.actors[0].world(0, [0, 0, 0])));
  await at(0);
  const [start, first] = [await root(), await pixels(page)];
  await at(await page.evaluate(() => window.condyle.motions[0].times.at(-1)));
  const [end, last] = [await root(), await pixels(page)];
  const way = Math.hypot(end[0] - start[0], end[2] - start[2]);
  check(way > 2, `it walks ${way} m`);
  check(last.bone > 0.7 * first.bone, `${first.bone} pixels of bones, and ${last.bone} in the end`);
  await page.close();
});

await test("the network opens, and limits are drawn", async () => {
  const page = await opened(exported("shoulder"));
  await page.evaluate(() => {
    const app = window.condyle;
    app.select(app.model.about.segments.findIndex((s) => s.name.startsWith("humerus")));
  });
  await page.waitForFunction(() => window.condyle.inspector.network.count > 5);
  await page.click("nav summary:has-text('show')");
  await page.check("[data-show=limits]");
  await page.waitForFunction(() => window.condyle.signs.count > 0, null, { timeout: 120_000 });
  await page.close();
});

await test("a pose that is saved is posed alike by the command", async () => {
  const page = await opened(exported("human"));
  await page.evaluate(() => {
    const app = window.condyle;
    app.model.actors[0].asked.set(app.model.actors[0].asked.map((x, i) => x + 0.1 * Math.sin(i)));
    app.changed(true);
  });
  await page.click("nav summary:has-text('save')");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("[data-save=json]")]);
  const pose = join(folder, "pose.json");
  await saved.saveAs(pose);
  const places = await page.evaluate(() => {
    const { model } = window.condyle;
    return model.about.segments.map(({ name }, k) => [name, Array.from(model.actors[0].places.slice(16 * k, 16 * k + 16))]);
  });
  const { frames } = JSON.parse(execFileSync(condyle, ["fk", "human", "--pose", pose, "--json"], { maxBuffer: 1 << 26 }));
  let worst = 0;
  for (const [name, own] of places) frames[0].segments[name].forEach((x, i) => (worst = Math.max(worst, Math.abs(x - own[i]))));
  check(worst < 1e-9, `fk differs by ${worst}`);
  await page.close();
});

await test("the static page reads what is dropped on it, and poses quickly", async () => {
  const root = new URL("../dist/", import.meta.url);
  const types = { html: "text/html", js: "text/javascript", lzma: "application/octet-stream" };
  const server = createServer((request, response) => {
    const path = request.url === "/" ? "index.html" : request.url.slice(1);
    try {
      const bytes = readFileSync(new URL(path, root));
      response.writeHead(200, { "content-type": types[path.split(".").at(-1)] }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const start = Date.now();
  const page = await opened(`http://127.0.0.1:${server.address().port}/`);
  const first = Date.now() - start;
  check((await pixels(page)).bone > 1000, "nothing is seen");
  const micros = await page.evaluate(() => {
    const { model } = window.condyle;
    const [actor] = model.actors;
    let best = Infinity;
    for (let run = 0; run < 20; run++) {
      const begin = performance.now();
      for (let i = 0; i < 200; i++) {
        actor.asked[10] = 0.001 * i;
        actor.pose(true);
      }
      best = Math.min(best, (performance.now() - begin) / 0.2);
    }
    return best;
  });
  console.log(`   human: ${micros.toFixed(1)} us a pose, first picture after ${first} ms`);
  check(micros < 150, `a pose takes ${micros} us`);
  const table = join(folder, "lift.csv");
  writeFileSync(table, "time,elbow_flex_r\n0,0\n1,1.5\n");
  await page.setInputFiles("input[type=file]", table);
  await page.waitForFunction(() => window.condyle.motions.length === 1);
  await page.close();
  server.close();
});

await browser.close();
rmSync(folder, { recursive: true });
