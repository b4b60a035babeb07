// The page edits a model's file in a real browser: node authoring.mjs CONDYLE CHROMIUM MODELS, the command, the browser,
// and the folder with the texts of the shipped models.
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [condyle, browserPath, models] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "condyle-authoring-"));
cpSync(join(models, "parts"), join(folder, "parts"), { recursive: true });
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const servers = [];
let failed = false;

function check(good, what) {
  if (!good) throw new Error(what);
}

/** Starts the command on a model and opens its page. */
async function viewed(model) {
  const server = spawn(condyle, ["view", model, "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  servers.push(server);
  const address = await new Promise((resolve, reject) => {
    server.stdout.once("data", (bytes) => resolve(bytes.toString().trim()));
    server.once("exit", (code) => reject(new Error(`condyle view ended with ${code}`)));
  });
  const page = await browser.newPage({ viewport: { width: 1200, height: 800 } });
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  // Refused edits are answers, too, which browsers report as failed loads.
  page.on("console", (message) => message.type() === "error" && !message.text().includes("status of 4") && errors.push(message.text()));
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
  await page.waitForSelector("#authoring h2");
  const end = async () => {
    await page.close();
    server.kill("SIGINT");
    check(errors.length === 0, errors.join("\n"));
  };
  return { page, address, end };
}

async function test(name, run) {
  try {
    await run();
    console.log(`   ok: ${name}`);
  } catch (error) {
    console.error(`   FAILED: ${name}: ${error.stack}`);
    failed = true;
  }
}

async function until(what, holds) {
  const end = Date.now() + 60_000;
  while (!(await holds())) {
    check(Date.now() < end, `it never came: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

const shown = (path) => path.map((step, at) => (typeof step === "number" ? `[${step}]` : at === 0 ? step : `.${step}`)).join("");

/** Numbers of the model's text, as the server lists them. */
const listed = (page) => page.evaluate(async () => (await fetch("editable.json")).json());

/** Finds a number by its name and gives it another value, as a person does; what the page asked, if it did. */
async function typed(page, path, value) {
  const name = shown(path);
  await page.locator("#authoring input[type=search]").fill(name);
  const field = page.locator(`input[data-number="${name}"]`);
  await field.waitFor({ state: "attached" });
  const group = page.locator("#authoring details:not([open])", { has: field });
  if ((await group.count()) > 0) await group.locator("summary").click();
  await field.fill(String(value));
  await field.press("Enter");
  await field.blur().catch(() => {});
}

/** Places of all segments: the page's, and those that the command computes from the file. */
async function compared(page, file) {
  const ours = await page.evaluate(() => {
    window.condyle.neutral();
    const { model } = window.condyle;
    const world = (index) => [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]].map((p) => Array.from(model.actors[0].world(index, p)));
    return Object.fromEntries(model.about.segments.map((segment, index) => [segment.name, world(index)]));
  });
  const theirs = JSON.parse(execFileSync(condyle, ["fk", file, "--limits", "on", "--json"], { maxBuffer: 1 << 28 })).frames[0].segments;
  check(Object.keys(theirs).length === Object.keys(ours).length, "other segments");
  let most = 0;
  for (const [name, t] of Object.entries(theirs)) {
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((p, which) => {
      for (let row = 0; row < 3; row++) {
        const place = t[4 * row] * p[0] + t[4 * row + 1] * p[1] + t[4 * row + 2] * p[2] + t[4 * row + 3];
        most = Math.max(most, Math.abs(place - ours[name][which][row]));
      }
    });
  }
  return most;
}

/** What differs between two texts: the bytes that were replaced and those that are there now. */
function difference(before, after) {
  let start = 0;
  while (start < before.length && before[start] === after[start]) start++;
  let end = 0;
  while (end < Math.min(before.length, after.length) - start && before.at(-1 - end) === after.at(-1 - end)) end++;
  return [before.slice(start, before.length - end), after.slice(start, after.length - end)];
}

/** One number of each kind: by its path without names. */
function kinds(values) {
  const found = new Map();
  for (const value of values) {
    const kind = value.path.map((step, at) => (typeof step === "number" ? "#" : at === 1 || at === 3 ? "*" : step)).join(".");
    if (value.origin.kind === "plain" && value.value !== 0 && !found.has(kind)) found.set(kind, value);
  }
  return found;
}

for (const name of ["shoulder-shao2003", "legs", "spine"]) {
  await test(`each kind of number of ${name} changes alone`, async () => {
    const file = join(folder, `${name}-mine.toml`);
    copyFileSync(join(models, `${name}.toml`), file);
    const { page, end } = await viewed(file);
    let [count, refused] = [0, 0];
    for (const [kind, value] of kinds((await listed(page)).values)) {
      const before = readFileSync(file, "latin1");
      const wanted = Number((value.value * 1.004).toPrecision(9));
      const model = await page.evaluate(() => window.condyle.model.handle);
      await typed(page, value.path, wanted);
      let fault = false;
      await until(`${kind} in the file`, async () => {
        fault = await page.evaluate(() => !document.getElementById("fault").hidden);
        return fault || readFileSync(file, "latin1") !== before;
      });
      const after = readFileSync(file, "latin1");
      if (fault) {
        // Such as a whole number, or a direction of length 1.
        check(after === before, `${kind}: refused, and yet the file changed`);
        await page.locator("#fault button").click();
        refused += 1;
        continue;
      }
      const [old, now] = difference(before, after);
      check(/^[-+.\deE]*$/.test(old) && /^[-+.\deE]*$/.test(now), `${kind}: ${old} became ${now}`);
      await until(`${kind} on the page`, () => page.evaluate((old) => window.condyle.model.handle !== old, model));
      const off = await compared(page, file);
      check(off < 1e-9, `${kind}: ${off} apart`);
      count += 1;
    }
    check(count >= 8 && refused * 3 < count, `${count} changed, ${refused} refused`);
    console.log(`      ${count} kinds of numbers, ${refused} refused`);
    await end();
  });
}

const LEG = 'condyle = 1\nkind = "model"\nangles = "deg"\nmirror = { plane = "z", from = "_r", to = "_l" }\nconstants = { shank = 0.400 } # of one person\n\n[segment.shank_r]\nat = [0, -0.420, 0.083] # Dumas 2007\n[segment.foot_r]\nparent = "shank_r"\nat = [0, "-$shank", 0]\n[joint.ankle_r]\ntype = "hinge"\nsegment = "foot_r"\naxis = [0, 0, 1]\ncoordinates = ["ankle_r"]\ncoordinate.ankle_r = { range = [-50, 20] }\n';

await test("the mirrored side follows, a constant is asked about, and edits are undone", async () => {
  const file = join(folder, "leg.toml");
  writeFileSync(file, LEG);
  const { page, end } = await viewed(file);
  const z = (name) => page.evaluate((name) => {
    const { model } = window.condyle;
    return model.actors[0].world(model.about.segments.findIndex((s) => s.name === name), [0, 0, 0])[2];
  }, name);
  await typed(page, ["segment", "shank_r", "at", 2], 0.1);
  await until("both sides", async () => Math.abs((await z("shank_l")) + 0.1) < 1e-9 && Math.abs((await z("shank_r")) - 0.1) < 1e-9);
  check(readFileSync(file, "utf8") === LEG.replace("0.083", "0.1"), readFileSync(file, "utf8"));
  // The way is not plain: the page says what it will write, and writes nothing until it may.
  await page.locator("#authoring input[type=search]").fill("segment.foot_r.at[1]");
  await page.locator('input[data-number="segment.foot_r.at[1]"]').fill("-0.41");
  await page.locator('input[data-number="segment.foot_r.at[1]"]').press("Enter");
  const question = await page.textContent("#confirm p");
  check(question.includes("writes constant `shank` (leg.toml:5)"), question);
  check(readFileSync(file, "utf8") === LEG.replace("0.083", "0.1"), "it did not wait");
  await page.click("#confirm-yes");
  await until("the constant", () => readFileSync(file, "utf8") === LEG.replace("0.083", "0.1").replace("0.400", "0.41"));
  for (const text of [LEG.replace("0.083", "0.1"), LEG]) {
    await page.click("#text-undo:not([disabled])");
    await until("undone", () => readFileSync(file, "utf8") === text);
  }
  await until("the old place", async () => Math.abs((await z("shank_l")) + 0.083) < 1e-9);
  await end();
});

await test("a segment, a component and a wire are added to the text", async () => {
  const file = join(folder, "added.toml");
  writeFileSync(file, `${LEG}
[joint_set.toes_r]
coordinate.toe_r = { range = [-40, 40] }
`);
  const { page, end } = await viewed(file);
  const added = async (button, values) => {
    await page.evaluate(() => (document.getElementById("adding").open = true));
    for (const [label, value] of Object.entries(values)) await page.getByLabel(label, { exact: true }).fill(value);
    const before = readFileSync(file, "utf8");
    await page.click(`#adding button:has-text('${button}')`);
    await until(`${button} in the file`, () => readFileSync(file, "utf8") !== before);
    check((await page.locator("#fault:not([hidden])").count()) === 0, await page.locator("#fault").textContent());
  };
  const segments = () => page.evaluate(() => window.condyle.model.about.segments.map(({ name }) => name));
  await page.evaluate(() => window.condyle.select(window.condyle.model.about.segments.findIndex((s) => s.name === "foot_r")));
  await added("add segment", { "name of a segment": "toes_r", "at x, y, z in m": "0.12, -0.03, 0" });
  await until("both toes", async () => (await segments()).includes("toes_r") && (await segments()).includes("toes_l"));
  await page.evaluate(() => window.condyle.look(window.condyle.model.about.sets.indexOf("toes_r")));
  await added("add component", { "name of a component": "bend", "its kind": "rotate", "its values, as JSON": '{"angle": "toe_r", "axis": [0, 0, 1]}' });
  await added("add wire", { "port (component.kind.port), or output.segment": "output.toes_r", "comes from": "bend" });
  // The toe bends: it was read back, and its mirrored twin too.
  const turned = async () => page.evaluate(() => {
    const { model } = window.condyle;
    const toe = model.about.coordinates.find(({ name }) => name === "toe_r");
    if (!toe) return 0;
    model.actors[0].asked[toe.place] = 0.5;
    model.actors[0].pose(true);
    const at = model.about.segments.findIndex((s) => s.name === "toes_r");
    const [origin, tip] = [[0, 0, 0], [1, 0, 0]].map((p) => model.actors[0].world(at, p));
    return Math.atan2(tip[1] - origin[1], tip[0] - origin[0]);
  });
  await until("the bent toe", async () => Math.abs((await turned()) - 0.5) < 1e-9);
  check(readFileSync(file, "utf8").startsWith(LEG), "what was there stays as it was written");
  await end();
});

await test("a shipped model is edited in a text of one's own", async () => {
  const { page, end } = await viewed("knee");
  const { values } = await listed(page);
  const number = values.find(({ path }) => path[0] === "segment" && path[2] === "at");
  check(number?.origin.kind === "shipped", JSON.stringify(number));
  const before = await page.evaluate(() => window.condyle.model.handle);
  await typed(page, number.path, number.value + 0.01);
  await page.waitForSelector("#confirm p");
  const question = await page.textContent("#confirm p");
  check(question.includes("knee-edited.toml") && question.includes("includes the shipped `knee`"), question);
  await page.click("#confirm-yes");
  await until("the page", () => page.evaluate((old) => window.condyle.model.handle !== old, before));
  const off = await compared(page, join(folder, "knee-edited.toml"));
  check(off < 1e-9, `${off} apart`);
  const text = readFileSync(join(folder, "knee-edited.toml"), "utf8");
  check(text.includes('include = ["knee"]') && text.length < 400, text);
  await end();
});

await test("a handle moves a bone, and one number of the file", async () => {
  const file = join(folder, "handle.toml");
  writeFileSync(file, LEG);
  const { page, end } = await viewed(file);
  await page.evaluate(() => {
    const { about } = window.condyle.model;
    window.condyle.select(about.segments.findIndex((s) => s.name === "shank_r"));
    window.condyle.view.look(window.condyle.box(), "front");
    window.condyle.view.now();
  });
  await page.click("#handles");
  const end_ = page.locator("[data-handle=y]");
  let [x, y] = [0, 0];
  await until("the handle under the pointer", async () => {
    const box = await end_.boundingBox();
    if (box === null) return false;
    [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    // The picture may still be getting its size.
    return page.evaluate(([x, y]) => document.elementFromPoint(x, y)?.dataset.handle === "y", [x, y]);
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 5; i++) await page.mouse.move(x, y - 4 * i);
  await page.mouse.up();
  await until("the file", () => readFileSync(file, "utf8") !== LEG);
  const [old, now] = difference(LEG, readFileSync(file, "utf8"));
  const value = Number(/at = \[0, (\S+), 0.083\]/.exec(readFileSync(file, "utf8"))?.[1]);
  check(value > -0.42 && value < 0.4, `${old} became ${now}`);
  check(readFileSync(file, "utf8") === LEG.replace("-0.420", String(value)), "that number alone");
  await end();
});

await test("a file that an editor breaks is told with its line, and mended", async () => {
  const file = join(folder, "broken.toml");
  writeFileSync(file, LEG);
  const { page, end } = await viewed(file);
  const segments = () => page.evaluate(() => window.condyle.model.about.segments.length);
  writeFileSync(file, LEG.replace("parent", "parnet"));
  await page.waitForSelector("#fault:not([hidden])");
  const fault = await page.textContent("#fault");
  check(fault.includes("line 10") && fault.includes("parnet") && fault.includes("did you mean"), fault);
  check((await segments()) === 4, "the last good model is shown");
  writeFileSync(file, `${LEG}[segment.toe_r]\nparent = "foot_r"\n`);
  await page.waitForSelector("#fault", { state: "hidden" });
  await until("the mended model", async () => (await segments()) === 6);
  await end();
});

await browser.close();
for (const server of servers) server.kill("SIGINT");
rmSync(folder, { recursive: true, force: true });
process.exit(failed ? 1 : 0);
