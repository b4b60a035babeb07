// The page shows what `condyle render` shows: node render.mjs CONDYLE CHROMIUM, the command and the browser.
// The same model from the same side: outlines of bones lie on each other, and they are equally bright.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [condyle, browserPath] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "condyle-render-"));
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

/** Pixels of bones, which are warmer than all else, of the page and of a picture, each cut to its bones and as wide. */
function compared([png, from]) {
  const app = window.condyle;
  const { view } = app;
  // Nearly parallel rays, as those of the command are.
  view.camera.fov = 1;
  view.look(app.box(), from);
  view.camera.far = 1e5;
  view.camera.updateProjectionMatrix();
  view.scene.fog = null;
  view.now();
  const WIDE = 300;
  const bones = (data, i) => data[4 * i] - data[4 * i + 2] > 14;
  const pixels = (bitmap, left, top, right, bottom, wide, high) => {
    const flat = new OffscreenCanvas(wide, high).getContext("2d", { willReadFrequently: true });
    flat.drawImage(bitmap, left, top, right - left, bottom - top, 0, 0, wide, high);
    return flat.getImageData(0, 0, wide, high).data;
  };
  const box = (bitmap) => {
    const { width, height } = bitmap;
    const data = pixels(bitmap, 0, 0, width, height, width, height);
    let [left, top, right, bottom] = [width, height, 0, 0];
    for (let i = 0; i < width * height; i++) {
      if (!bones(data, i)) continue;
      const [x, y] = [i % width, Math.floor(i / width)];
      [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x + 1), Math.min(top, y), Math.max(bottom, y + 1)];
    }
    return [left, top, right, bottom];
  };
  return (async () => {
    const ours = await createImageBitmap(view.renderer.domElement);
    const theirs = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const [left, top, right, bottom] = box(ours);
    const high = Math.round((WIDE * (bottom - top)) / (right - left));
    const cut = [ours, theirs].map((bitmap) => {
      const data = pixels(bitmap, ...box(bitmap), WIDE, high);
      const seen = Array.from({ length: WIDE * high }, (_, i) => bones(data, i));
      const colour = [0, 1, 2].map((k) => seen.reduce((sum, is, i) => sum + (is ? data[4 * i + k] : 0), 0) / seen.filter(Boolean).length);
      return { seen, colour };
    });
    // How many pixels of one have none of the other beside them.
    const lost = (a, b) => {
      const near = (i) => [-1, 0, 1].some((y) => [-1, 0, 1].some((x) => b[i + x + y * WIDE]));
      return a.filter((is, i) => is && !near(i)).length / a.filter(Boolean).length;
    };
    const [a, b] = cut;
    return { lost: Math.max(lost(a.seen, b.seen), lost(b.seen, a.seen)), colours: [a.colour, b.colour], count: a.seen.filter(Boolean).length };
  })();
}

for (const name of ["human", "shoulder", "knee"]) {
  const file = join(folder, `${name}.html`);
  execFileSync(condyle, ["export", "page", name, "-o", file]);
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, colorScheme: "light" });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
  for (const [from, view] of [["front", "front"], ["oblique", "35,12"]]) {
    const picture = join(folder, `${name}-${from}.png`);
    execFileSync(condyle, ["render", name, "--view", view, "--size", "800x800", "-o", picture]);
    const { lost, colours, count } = await page.evaluate(compared, [readFileSync(picture).toString("base64"), from]);
    const off = Math.max(...colours[0].map((value, k) => Math.abs(value - colours[1][k])));
    const what = `${name} from ${from}: ${(100 * lost).toFixed(2)} % of outlines apart, colours ${off.toFixed(1)} of 255 apart`;
    const good = count > 2000 && lost < 0.01 && off < 8;
    console[good ? "log" : "error"](`   ${good ? "ok" : "FAILED"}: ${what}`);
    if (!good) process.exitCode = 1;
  }
  await page.close();
}

await browser.close();
rmSync(folder, { recursive: true });
