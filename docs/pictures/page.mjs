// The moving picture of the README: node docs/pictures/page.mjs CONDYLE CHROMIUM, the command and a browser, with the
// packages of crates/condyle-view/page installed.
//
// It opens the page of `condyle view human`, raises an arm by its slider, pulls the hand, walks through a motion that
// leaves its limits, and keeps what is seen as an animated WebP (pictures by the browser's own encoder).
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const page_ = new URL("../../crates/condyle-view/page/package.json", import.meta.url);
const { chromium } = createRequire(page_)("playwright-core");
const [condyle, browserPath] = process.argv.slice(2);
const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const [WIDE, HIGH, RATE, QUALITY] = [1180, 660, 10, 0.6];

const folder = mkdtempSync(join(tmpdir(), "condyle-movie-"));
const motion = join(folder, "through-thorax.mot");
execFileSync(condyle, ["convert", here("through-thorax.json"), motion, "--model", "human", "--rate", "60"]);
const file = join(folder, "human.html");
execFileSync(condyle, ["export", "page", "human", motion, "--title", "human", "-o", file]);

const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const page = await browser.newPage({ viewport: { width: WIDE, height: HIGH }, colorScheme: "light" });
await page.goto(pathToFileURL(file).href);
await page.waitForFunction(() => document.documentElement.dataset.ready === "yes");
await page.waitForSelector("#findings [data-kind=violation]");

/** Pictures, and for how many frames each stays. */
const frames = [];
async function taken(stays = 1) {
  await page.evaluate(() => {
    window.condyle.view.now();
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  });
  const png = (await page.screenshot({ type: "png" })).toString("base64");
  const last = frames.at(-1);
  if (last?.png === png) last.stays += stays;
  else frames.push({ png, stays });
}

// The pose by hand first: no motion is chosen.
await page.evaluate(() => {
  const app = window.condyle;
  app.chosen = [-1, -1];
  app.motionsChanged();
  app.neutral();
});
await taken(6);
await page.evaluate(() => {
  const app = window.condyle;
  const { segments } = app.model.about;
  app.select(segments.findIndex((s) => s.name === "humerus_r"));
  app.view.look(app.box(), "back");
  app.view.turn(-0.35, 0.12);
  app.view.nearer(0.62);
  app.view.controls.target.y += 0.3;
  app.view.camera.position.y += 0.3;
  app.view.controls.update();
});
await page.evaluate(() => window.condyle.toggle("centres"));
await taken(4);
const elevation = page.locator("input[type=range][data-key='shoulder_elevation_r']").first();
await elevation.scrollIntoViewIfNeeded();
for (let degrees = 0; degrees <= 150; degrees += 7.5) {
  await elevation.fill(String(degrees));
  await taken();
}
await taken(5);
await page.evaluate(() => window.condyle.toggle("centres"));

// The hand is pulled, and the body follows within its limits.
await page.click("#drag");
await page.evaluate(() => {
  const app = window.condyle;
  app.neutral();
  app.view.look(app.box(), "oblique");
});
const at = await page.evaluate(() => {
  const { model, view } = window.condyle;
  const arm = model.about.segments.findIndex((s) => s.name === "radius_r");
  const [x, y] = view.project(model.actors[0].world(arm, [0, -0.2, 0]));
  const box = document.getElementById("picture").getBoundingClientRect();
  return [x + box.left, y + box.top];
});
await page.mouse.move(...at);
await page.mouse.down();
for (let i = 1; i <= 24; i++) {
  const turn = (i / 24) * 1.9 * Math.PI;
  await page.mouse.move(at[0] - 60 * Math.sin(0.5 * turn) - 2 * i, at[1] - 90 * (1 - Math.cos(0.7 * turn)) * 0.9);
  await taken();
}
await page.mouse.up();
await taken(5);
await page.click("#drag");

// A motion through the thorax: what it breaks is listed, and a click goes there.
await page.evaluate(() => {
  const app = window.condyle;
  app.chosen = [0, -1];
  app.motionsChanged();
  app.select(null);
  app.view.look(app.box(), "front");
  app.timed();
});
await page.waitForSelector("#findings [data-kind=violation]");
const end = await page.evaluate(() => window.condyle.motions[0].times.at(-1));
for (let i = 0; i <= 22; i++) {
  await page.evaluate((time) => window.condyle.timeline.go(time), (i / 22) * end);
  await taken();
}
await page.click("#findings [data-kind=violation]");
await taken(12);

// Of each picture only the rectangle that differs from the one before.
const parts = [];
for (const { png, stays } of frames) {
  const { webp, x, y, wide, high } = await page.evaluate(async ([png, quality]) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const whole = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d", { willReadFrequently: true });
    whole.drawImage(bitmap, 0, 0);
    const now = new Uint32Array(whole.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
    const before = window.before;
    window.before = now;
    let [left, top, right, bottom] = before ? [bitmap.width, bitmap.height, 0, 0] : [0, 0, bitmap.width, bitmap.height];
    for (let at = 0; before && at < now.length; at++) {
      if (now[at] === before[at]) continue;
      const [column, row] = [at % bitmap.width, Math.floor(at / bitmap.width)];
      [left, right] = [Math.min(left, column), Math.max(right, column + 1)];
      [top, bottom] = [Math.min(top, row), Math.max(bottom, row + 1)];
    }
    // Places are even in this format.
    [left, top] = [left & ~1, top & ~1];
    const [wide, high] = [right - left, bottom - top];
    const part = new OffscreenCanvas(wide, high);
    part.getContext("2d").drawImage(bitmap, -left, -top);
    const bytes = new Uint8Array(await (await part.convertToBlob({ type: "image/webp", quality })).arrayBuffer());
    return { webp: Array.from(bytes), x: left, y: top, wide, high };
  }, [png, QUALITY]);
  parts.push({ webp: Buffer.from(webp), x, y, wide, high, stays });
}
writeFileSync(here("page.webp"), animated(parts));
console.log(`${frames.length} pictures`);
await browser.close();
rmSync(folder, { recursive: true });

/** One file of many pictures: the container of WebP, as Google's specification of it has it (RIFF, VP8X, ANIM, ANMF). */
function animated(pictures) {
  const u24 = (x) => Buffer.from([x & 255, (x >> 8) & 255, x >> 16]);
  const u32 = (x) => {
    const bytes = Buffer.alloc(4);
    bytes.writeUInt32LE(x);
    return bytes;
  };
  const chunk = (name, body) => Buffer.concat([Buffer.from(name, "latin1"), u32(body.length), body, Buffer.alloc(body.length % 2)]);
  const sizes = (wide, high) => [u24(wide - 1), u24(high - 1)];
  const chunks = [
    chunk("VP8X", Buffer.concat([Buffer.from([2, 0, 0, 0]), ...sizes(WIDE, HIGH)])),
    chunk("ANIM", Buffer.concat([u32(0xffffffff), Buffer.from([0, 0])])),
  ];
  for (const { webp, x, y, wide, high, stays } of pictures) {
    const milliseconds = Math.round((1000 / RATE) * stays);
    const head = [u24(x / 2), u24(y / 2), ...sizes(wide, high), u24(milliseconds), Buffer.from([2])];
    chunks.push(chunk("ANMF", Buffer.concat([...head, bitstream(webp)])));
  }
  const body = Buffer.concat([Buffer.from("WEBP", "latin1"), ...chunks]);
  return Buffer.concat([Buffer.from("RIFF", "latin1"), u32(body.length), body]);
}

/** The chunk that holds the pixels of a still WebP; colour profiles and the like stay behind. */
function bitstream(webp) {
  for (let at = 12; at + 8 <= webp.length; ) {
    const length = webp.readUInt32LE(at + 4);
    const end = at + 8 + length + (length % 2);
    if (["VP8 ", "VP8L"].includes(webp.toString("latin1", at, at + 4))) return webp.subarray(at, end);
    at = end;
  }
  throw new Error("a picture without pixels");
}
