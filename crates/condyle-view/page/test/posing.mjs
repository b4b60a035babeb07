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

/** The pose of the page by the names of coordinates, and what is out of its range. */
async function posed(page) {
  return page.evaluate(() => {
    const { model } = window.condyle;
    const { effective } = model.actors[0];
    const single = model.about.coordinates.filter((c) => c.kind !== "orientation");
    return {
      values: Object.fromEntries(single.map((c) => [c.key, effective[c.place]])),
      broken: single.filter((c) => c.enforced && ((c.lower ?? -Infinity) - 1e-9 > effective[c.place] || (c.upper ?? Infinity) + 1e-9 < effective[c.place])).map((c) => c.key),
    };
  });
}

await test("goals are met as by the command", async () => {
  const page = await opened();
  await page.evaluate(() => {
    const app = window.condyle;
    app.select(app.model.about.segments.findIndex((s) => s.name === "hand_r"));
  });
  await page.click("#goals > summary");
  await page.selectOption("#goal-kind", "point");
  await page.click("#goal-add");
  await page.selectOption("#goal-kind", "plane");
  await page.evaluate(() => {
    const app = window.condyle;
    app.select(app.model.about.segments.findIndex((s) => s.name === "foot_l" || s.name === "calcaneus_l" || s.name === "talus_l"));
  });
  await page.click("#goal-add");
  // Thirty centimetres up: the number is changed, and the figure follows.
  const up = page.locator("[aria-label='at of point hand_r, y']");
  await up.fill(String(Number(await up.inputValue()) + 30));
  await up.press("Enter");
  await page.waitForFunction(() => window.condyle.goals.lacks.length === 2 && window.condyle.goals.lacks[0].off < 2e-3);
  await picture(page, "goals");
  await page.click("#goals-solve");
  await page.waitForFunction(() => window.condyle.goals.lacks.every((lack) => lack.met), null, { timeout: 120_000 });
  const file = await downloaded(page, "#save-goals", "goals.toml");
  const out = join(folder, "pose.json");
  execFileSync(condyle, ["pose", "human", file, "-o", out], { stdio: ["ignore", "ignore", "ignore"] });
  const native = JSON.parse(readFileSync(out, "utf8"));
  const { values, broken } = await posed(page);
  check(broken.length === 0, `out of range: ${broken}`);
  let worst = 0;
  for (const [key, value] of Object.entries(native)) if (key in values) worst = Math.max(worst, Math.abs(values[key] - value));
  console.log(`   goals: at most ${worst.toExponential(1)} off the command`);
  check(worst < 1e-6, `the page differs from the command by ${worst}`);
  await page.close();
  const again = await opened(file);
  await again.waitForFunction(() => window.condyle.goals.list.goals.length === 2 && window.condyle.goals.list.goals[0].kind === "point");
  await again.close();
});

await test("feet that are pinned stay while a hand is dragged", async () => {
  const page = await opened();
  await page.evaluate(() => {
    const app = window.condyle;
    const { markers } = app.model.about;
    const [actor] = app.model.actors;
    const goals = ["r_calc", "r_toe", "L_calc", "L_toe"].map((name) => {
      const marker = markers.find((m) => m.name === name);
      return { kind: "point", name, point: name, at: actor.world(marker.segment, marker.point) };
    });
    app.goals.change({ goals, hold: [], stiffness: [], limits: true }, "look");
  });
  await page.click("#drag");
  const at = await page.evaluate(() => {
    const { model, view } = window.condyle;
    const hand = model.about.segments.findIndex((s) => s.name === "radius_r");
    const [x, y] = view.project(model.actors[0].world(hand, [0, -0.12, 0]));
    const box = document.getElementById("picture").getBoundingClientRect();
    return [x + box.left, y + box.top];
  });
  const pelvis = await posed(page);
  await page.mouse.move(...at);
  await page.mouse.down();
  for (let i = 1; i <= 10; i++) {
    await page.mouse.move(at[0] - 6 * i, at[1] + 8 * i);
    const { broken } = await posed(page);
    check(broken.length === 0, `out of range: ${broken}`);
  }
  const hover = await page.textContent("#hover");
  await page.waitForFunction(() => window.condyle.goals.lacks.length === 4);
  const lacks = await page.evaluate(() => window.condyle.model.ask("lacking", { actor: 0 }).value.map((lack) => lack.off));
  await picture(page, "pinned");
  await page.mouse.up();
  check(Math.max(...lacks) < 2e-3, `feet are off by ${lacks}`);
  const off = Number(/: ([\d.]+) mm/.exec(hover)?.[1] ?? NaN);
  console.log(`   pinned: the hand is ${off} mm off, feet at most ${(1000 * Math.max(...lacks)).toFixed(2)} mm`);
  check(off < 20, `after dragging it says: ${hover}`);
  const after = await posed(page);
  check(Object.keys(after.values).some((key) => Math.abs(after.values[key] - pelvis.values[key]) > 0.02), "nothing moved");
  await page.close();
});

await test("files of other formats are read by a module that is fetched then", async () => {
  const osim = join(folder, "legs.osim");
  execFileSync(condyle, ["convert", "legs", osim], { stdio: ["ignore", "ignore", "ignore"] });
  const keys = join(folder, "bend.json");
  writeFileSync(keys, JSON.stringify([{ time: 0, knee_angle_r: 0 }, { time: 1, knee_angle_r: -1 }]));
  const glb = join(folder, "bend.glb");
  execFileSync(condyle, ["convert", keys, glb, "--model", "knee", "--rate", "30"], { stdio: ["ignore", "ignore", "ignore"] });
  asked.length = 0;
  const page = await opened();
  check(!asked.some((path) => path.includes("readers")), "nothing is fetched that is not needed");
  await given(page, osim);
  await page.waitForFunction(() => window.condyle.title === "legs" && window.condyle.model.about.coordinates.some((c) => c.name === "knee_angle_r"), null, { timeout: 120_000 });
  check(asked.some((path) => path.includes("readers")), "the readers are fetched");
  await given(page, glb);
  await page.waitForFunction(() => window.condyle.title === "bend" && window.condyle.motions[0]?.times.length > 20, null, { timeout: 120_000 });
  check((await page.evaluate(() => window.condyle.model.about.segments.length)) > 1, "a scene has segments");
  await picture(page, "glb");
  await page.close();
});

await browser.close();
server.close();
rmSync(folder, { recursive: true });
