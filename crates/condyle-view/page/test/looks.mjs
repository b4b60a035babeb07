// Meshes, skins and rows of figures on the page: node looks.mjs CONDYLE CHROMIUM, the command and the browser.
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [condyle, browserPath] = process.argv.slice(2);
const pictures = process.env.PICTURES;
const folder = mkdtempSync(join(tmpdir(), "condyle-looks-"));
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

// An arm that names the mesh of a bar, 0.1 by 0.6 by 0.1 m; a second mesh is not there.
const mesh = (name, file) => `<Mesh name="${name}"><socket_frame>..</socket_frame><scale_factors>2 1 1</scale_factors><mesh_file>${file}</mesh_file></Mesh>`;
const body = (name, meshes) => `<Body name="${name}"><attached_geometry>${meshes}</attached_geometry></Body>`;
const joint = (name, parent, child, at) => `<PinJoint name="${name}"><socket_parent_frame>${name}_in</socket_parent_frame><socket_child_frame>/bodyset/${child}</socket_child_frame>
  <coordinates><Coordinate name="${name}_angle"><range>-2 2</range></Coordinate></coordinates>
  <frames><PhysicalOffsetFrame name="${name}_in"><socket_parent>${parent}</socket_parent><translation>${at}</translation></PhysicalOffsetFrame></frames></PinJoint>`;
writeFileSync(join(folder, "arm.osim"), `<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="arm"><BodySet><objects>
  ${body("humerus", mesh("bar", "bar.obj"))}${body("ulna", mesh("gone", "gone.vtp"))}</objects></BodySet><JointSet><objects>
  ${joint("shoulder", "/ground", "humerus", "0 1.4 0")}${joint("elbow", "/bodyset/humerus", "ulna", "0 -0.6 0")}</objects></JointSet></Model></OpenSimDocument>`);
mkdirSync(join(folder, "Geometry"));
const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1 ? 0.025 : -0.025, i & 2 ? 0 : -0.6, i & 4 ? 0.05 : -0.05]);
const faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
writeFileSync(join(folder, "Geometry", "bar.obj"), corners.map((c) => `v ${c.join(" ")}\n`).join("") + faces.map((f) => `f ${f.join(" ")}\n`).join(""));

const motion = (name, most) => {
  const rows = Array.from({ length: 21 }, (_, i) => `${i / 10},${(most * i) / 20},${(most * i) / 20}`);
  writeFileSync(join(folder, name), `time,elbow_flex_r,knee_angle_r\n${rows.join("\n")}\n`);
  return join(folder, name);
};
const motions = [motion("bent.csv", 1.2), motion("half.csv", 0.6), motion("straight.csv", 0)];

function exported(name, ...given) {
  const file = join(folder, `${name}.html`);
  execFileSync(condyle, ["export", "page", ...given, "-o", file], { stdio: ["ignore", "ignore", "pipe"] });
  return pathToFileURL(file).href;
}

async function opened(url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 760 }, ...options });
  const page = await context.newPage();
  page.on("pageerror", (error) => {
    console.error(`   FAILED: an error on the page: ${error.message}`);
    process.exitCode = 1;
  });
  await page.goto(url);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: 120_000 });
  return page;
}

async function test(name, run) {
  try {
    await run();
    console.log(`   ok: ${name}`);
  } catch (error) {
    console.error(`   FAILED: ${name}: ${error.stack}`);
    process.exitCode = 1;
  }
}

async function kept(page, name) {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
}

const is = (found, expected, what) => {
  const [a, b] = [found, expected].map((value) => JSON.stringify(value));
  if (a !== b) throw new Error(`${what}: ${a} instead of ${b}`);
};

/** The picture as it is now, as a text. */
const picture = (page) =>
  page.evaluate(() => {
    window.condyle.view.now();
    return document.getElementById("picture").toDataURL("image/png");
  });

/** The size of all that is seen, in millimetres. */
const size = (page) =>
  page.evaluate(() => {
    const box = window.condyle.box();
    return ["x", "y", "z"].map((axis) => Math.round(1000 * (box.max[axis] - box.min[axis])));
  });

async function meshes(page, name) {
  is(await page.evaluate(() => window.condyle.lookable), ["bones", "meshes"], "what can be seen");
  const width = (await size(page))[0];
  // The bar is 50 mm wide, and stretched to 100 mm: bones made by condyle are narrower.
  is(width, 100, "the width of the arm");
  const before = await picture(page);
  await kept(page, name);
  await page.locator("nav summary", { hasText: "show" }).click();
  await page.locator("[data-show=meshes]").uncheck();
  if ((await size(page))[0] >= 100) throw new Error("the mesh is still there");
  if ((await picture(page)) === before) throw new Error("the picture is the same without the mesh");
  await page.locator("[data-show=meshes]").check();
  is((await size(page))[0], 100, "the width of the arm with its mesh again");
  // A quarter of a turn of the shoulder: the bar lies along x.
  await page.evaluate(() => {
    const { condyle } = window;
    const pose = condyle.model.actors[0].asked.slice();
    pose[condyle.model.about.coordinates.find((c) => c.name === "shoulder_angle").place] = Math.PI / 2;
    condyle.put(pose, true);
  });
  const [along] = await size(page);
  if (along < 600) throw new Error(`the mesh did not turn: it is ${along} mm long along x`);
  await page.context().close();
}

await test("a mesh that an .osim names is seen on the exported page", async () => {
  await meshes(await opened(exported("arm", join(folder, "arm.osim"))), "mesh");
});

await test("a mesh is served by its name alone, and moves with its bone", async () => {
  const server = spawn(condyle, ["view", join(folder, "arm.osim"), "--no-open"], { stdio: ["ignore", "pipe", "ignore"] });
  try {
    const address = await new Promise((found, failed) => {
      let text = "";
      server.stdout.on("data", (more) => {
        text += more;
        if (text.includes("\n")) found(text.trim());
      });
      server.on("exit", () => failed(new Error("the server ended")));
    });
    for (const [name, status] of [["meshes", 200], ["skin", 404], ["bar.obj", 404], ["Geometry/bar.obj", 404], ["../arm.osim", 404]]) {
      is((await fetch(`${address}files/${name}`)).status, status, name);
    }
    await meshes(await opened(address, { colorScheme: "dark" }), "mesh-dark");
  } finally {
    server.kill();
  }
});

await test("a skin, bones, or both", async () => {
  const scene = join(folder, "scene.glb");
  execFileSync(condyle, ["convert", motions[0], scene, "--model", "human"], { stdio: ["ignore", "ignore", "pipe"] });
  const page = await opened(exported("scene", scene));
  is(await page.evaluate(() => window.condyle.lookable), ["bones", "skin"], "what can be seen");
  const seen = [await picture(page)];
  await kept(page, "skin-and-bones");
  await page.locator("nav summary", { hasText: "show" }).click();
  await page.locator("[data-show=bones]").uncheck();
  seen.push(await picture(page));
  await kept(page, "skin");
  await page.locator("[data-show=bones]").check();
  await page.locator("[data-show=skin]").uncheck();
  seen.push(await picture(page));
  is(new Set(seen).size, 3, "different pictures");
  // The skin of such a file is the bones of the model that it was written from. At the end of the motion the right forearm is
  // raised: the skin, blended by three.js, is in the box of the same bones of `human`, moved by the evaluator.
  const box = (skin) =>
    page.evaluate(async (skin) => {
      const app = window.condyle;
      app.timeline.go(2);
      const { mesh } = skin ? app.figures[0].skin : app.figures[0];
      if (!skin) return app.box();
      mesh.computeBoundingBox();
      return mesh.boundingBox;
    }, skin);
  const skinned = await box(true);
  const human = await opened(exported("human", "human", motions[0]));
  const posed = await human.evaluate(() => {
    window.condyle.timeline.go(2);
    const mesh = window.condyle.figures[0].mesh;
    mesh.computeBoundingBox();
    return mesh.boundingBox;
  });
  const edges = ({ min, max }) => [max.x - min.x, max.y - min.y, max.z - min.z].sort();
  const off = edges(skinned).map((length, axis) => Math.abs(length - edges(posed)[axis]));
  if (Math.max(...off) > 1e-4) throw new Error(`the skin is off by ${off} m`);
  await page.context().close();
  await human.context().close();
});

await test("three motions stand in a row with their names", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const page = await opened(exported("row", "human", ...motions), { colorScheme });
    is(await page.evaluate(() => window.condyle.figures.length), 3, "figures");
    await page.evaluate(() => {
      window.condyle.timeline.go(2);
    });
    await page.waitForFunction(() => document.getElementById("labels").textContent.includes("straight.csv"));
    const text = await page.evaluate(() => document.getElementById("labels").textContent);
    for (const name of ["bent.csv", "half.csv", "straight.csv"]) if (!text.includes(name)) throw new Error(`${name} is not written: ${text}`);
    const shared = await page.evaluate(() => new Set(window.condyle.figures.map((figure) => figure.mesh.geometry)).size);
    is(shared, 1, "surfaces that figures share");
    const knees = await page.evaluate(() => {
      const { condyle } = window;
      const knee = condyle.model.about.coordinates.find((c) => c.name === "knee_angle_r").place;
      return condyle.figures.map((figure) => Number(figure.actor.effective[knee].toFixed(3)));
    });
    is(knees, [1.2, 0.6, 0], "knees at the end");
    await kept(page, `row-${colorScheme}`);
    await page.context().close();
  }
});

await browser.close();
rmSync(folder, { recursive: true, force: true });
