// Checks of the picture in three dimensions: that it shows the bodies, heeds pointer, fingers and keys, and gives way
// to the flat one. Its pixels differ from machine to machine, and are not kept.

import { DESKTOP, addressOf, launch, open } from "./browser.mjs";
import { demand } from "./suite.mjs";

/** Opens a page in three dimensions, once that is drawn; faults are errors and requests. */
export function inDepth(browser, path, use, options = {}) {
  return open(browser, path, { ...options, deep: true }, async (page) => {
    await page.evaluate(() => window.barrelstack.deep);
    demand(await page.evaluate(() => window.barrelstack.player.views.isDeep()), "the page does not open in three dimensions");
    return use(page);
  });
}

/** What a stage shows at places of bodies and beside them, and its eye. */
const facts = (page) => page.evaluate(() => {
  const { player } = window.barrelstack, { eye } = player.views;
  const pane = player.panes.find((one) => one.deep);
  return {
    around: eye.around, above: eye.above, factor: eye.factor, aside: [...eye.aside], perPixel: pane.deep.perPixel(),
    picture: pane.stage.canvas.toDataURL(),
  };
});

/** Where barrels are there is wood, and the pointer finds the barrel; at the upper corners there is paper. */
export async function shows(page) {
  const found = await page.evaluate(() => {
    const { player } = window.barrelstack, faults = [];
    let barrels = 0;
    for (const share of [0.1, 0.5, 1]) {
      player.seek(share * player.times().at(-1));
      for (const pane of player.panes.filter((one) => one.deep)) {
        const { canvas } = pane.stage, { width, height, dpr } = pane.stage.measures(), { depth } = pane.data;
        pane.stage.names = pane.stage.traces = pane.stage.callout = false;
        pane.deep.draw(pane.frame(), player.time());
        const context = canvas.getContext("2d");
        const at = (x, y) => [...context.getImageData(Math.round(x * dpr), Math.round(y * dpr), 1, 1).data];
        // The share of wood in a square of 17 px, which a hoop, a seam or a rail crosses.
        const wood = (x, y) => {
          const { data } = context.getImageData(Math.round(x * dpr) - 8, Math.round(y * dpr) - 8, 17, 17);
          let count = 0;
          for (let k = 0; k < data.length; k += 4) if (data[k] > data[k + 1] && data[k + 1] > data[k + 2] && data[k] - data[k + 2] > 12) count += 1;
          return count / (17 * 17);
        };
        depth.bodies.forEach(({ name, role, rows }, body) => {
          if (role !== "barrel") return;
          const [x, y] = pane.deep.project(pane.deep.placeOf(body, pane.frame()));
          if (!(x > 0 && x < width && y > 0 && y < height)) return faults.push(`${name} is out of sight at ${share} of the run`);
          // What stands before it hides it.
          if (pane.deep.bodyAt([x, y]) !== body) return;
          barrels += 1;
          if (wood(x, y) < 0.3) faults.push(`where ${name} is, ${(100 * wood(x, y)).toFixed(0)} % is wood`);
        });
        const [r, g, b] = at(width - 3, 3);
        if (Math.min(r, g, b) < 230) faults.push(`the paper is ${[r, g, b]}`);
        pane.stage.names = pane.stage.traces = true;
      }
    }
    return { faults, barrels };
  });
  demand(found.faults.length === 0, found.faults.slice(0, 5).join("\n"));
  demand(found.barrels >= 6, `only ${found.barrels} barrels are in sight`);
  return `${found.barrels} barrels`;
}

/** Drag turns, shift and drag moves, wheel and keys bring closer, the button shows the whole again. */
export async function turns(page) {
  await page.evaluate(() => window.scrollTo(0, 0));
  const canvas = page.locator(".pane:not([hidden]) canvas.scene, .screen > .stage canvas.scene").first();
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox(), middle = [box.x + 0.3 * box.width, box.y + 0.4 * box.height];
  const drag = async (dx, dy) => {
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0] + dx, middle[1] + dy, { steps: 4 });
    await page.mouse.up();
    return facts(page);
  };
  const before = await facts(page);
  const turned = await drag(90, 30);
  demand(turned.around < before.around - 0.5 && turned.above > before.above + 0.1, `a drag turns from ${before.around} to ${turned.around}`);
  demand(turned.picture !== before.picture, "a drag changes nothing on the picture");
  const down = await drag(0, -2000);
  demand(down.above === 0, `the eye goes below the floor, to ${down.above}`);
  await page.keyboard.down("Shift");
  const moved = await drag(40, 0);
  await page.keyboard.up("Shift");
  const way = Math.hypot(...moved.aside) / moved.perPixel;
  demand(Math.abs(way - 40) < 2 && moved.around === down.around, `a drag by 40 px with shift moves the picture by ${way} px`);
  await page.mouse.wheel(0, 60);
  demand((await facts(page)).factor === 1, "the wheel alone zooms, so that the page cannot be scrolled");
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.mouse.move(...middle);
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -400);
  await page.keyboard.up("Control");
  await page.waitForFunction(() => window.barrelstack.player.views.eye.factor > 1.5, null, { timeout: 3000 });
  const near = await facts(page);
  demand(near.perPixel < 0.7 * moved.perPixel, "the wheel with Ctrl does not zoom");
  await page.locator('[data-act="whole"]').first().click();
  const whole = await facts(page);
  demand(whole.factor === 1 && whole.aside.every((v) => v === 0) && whole.around === before.around, "the button does not show the whole picture");
  await page.locator(".player .screen").first().focus();
  for (const key of ["+", "d", "w", "Shift+D"]) await page.keyboard.press(key);
  const keyed = await facts(page);
  demand(keyed.factor > 1 && keyed.around !== whole.around && keyed.above > whole.above && Math.hypot(...keyed.aside) > 0, `keys lead to ${JSON.stringify({ ...keyed, picture: "" })}`);
  await page.keyboard.press("0");
  demand((await facts(page)).factor === 1, "0 does not show the whole picture");
}

/** One finger turns and two bring closer; beside the stage a finger scrolls the page. */
export async function fingers(page) {
  const canvas = page.locator(".pane:not([hidden]) canvas.scene, .screen > .stage canvas.scene").first();
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox(), [x, y] = [box.x + 0.5 * box.width, box.y + 0.5 * box.height];
  const client = await page.context().newCDPSession(page);
  const touch = (type, ...points) => client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const before = await facts(page);
  const scrolled = await page.evaluate(() => window.scrollY);
  await touch("touchStart", [x, y]);
  for (let k = 1; k <= 5; k++) await touch("touchMove", [x + 12 * k, y + 6 * k]);
  await touch("touchEnd");
  const turned = await facts(page);
  demand(turned.around < before.around - 0.3, "one finger does not turn the stack");
  demand((await page.evaluate(() => window.scrollY)) === scrolled, "a finger on the stage scrolls the page");
  await touch("touchStart", [x - 20, y], [x + 20, y]);
  for (let k = 1; k <= 5; k++) await touch("touchMove", [x - 20 - 8 * k, y], [x + 20 + 8 * k, y]);
  await touch("touchEnd");
  const near = await facts(page);
  demand(near.factor > 2 && near.around === turned.around, `two fingers lead to ${near.factor}`);
  // A tap names what it meets.
  await page.locator('[data-act="whole"]').first().click();
  const spot = await page.evaluate(() => {
    const pane = window.barrelstack.player.panes.find((one) => one.deep);
    const body = pane.data.depth.bodies.findIndex(({ role }) => role === "barrel");
    return pane.deep.project(pane.deep.placeOf(body, pane.frame()));
  });
  await canvas.scrollIntoViewIfNeeded();
  const now = await canvas.boundingBox();
  const untold = (await facts(page)).picture;
  await touch("touchStart", [now.x + spot[0], now.y + spot[1]]);
  await touch("touchEnd");
  demand((await facts(page)).picture !== untold, "a tap on a barrel does not name it");
  const free = await page.evaluate(() => getComputedStyle(document.body).touchAction === "auto");
  demand(free, "the page beside the stage cannot be scrolled by a finger");
}

/** From across, along and above the picture has the silhouette of the flat one: the same middle and the same shape. */
export async function presets(page) {
  const found = await page.evaluate(() => {
    const { player } = window.barrelstack, faults = [], shares = [];
    player.seek(player.times()[0]);
    for (const pane of player.panes.filter((one) => one.deep && one.data.depth.plane)) {
      const { stage, deep, data } = pane, { width, height, dpr } = stage.measures(), frame = pane.frame();
      const context = stage.canvas.getContext("2d", { willReadFrequently: true });
      player.views.eye.go(data.depth.plane);
      Object.assign(stage, { names: false, traces: false, callout: false });
      // Wood and steel, on paper or floor, by the barrels of the middle of the flat picture.
      const spread = (draw, at) => {
        draw();
        const wood = (x, y) => {
          const [r, g, b] = context.getImageData(Math.round(x * dpr), Math.round(y * dpr), 1, 1).data;
          return r - b > 14 && r > g;
        };
        // The extent of wood through the middles of all barrels, over the distance of lowest and highest.
        const middles = data.bodies.flatMap((body, k) => (body.role === "barrel" ? [at(k)] : []));
        const rise = Math.max(...middles.map((m) => m[1])) - Math.min(...middles.map((m) => m[1]));
        return middles.map(([x, y]) => {
          const ends = [-1, 1].map((side) => {
            let reach = 0;
            for (let step = 0; step < 200; step += 1) if (wood(x + side * step, y + 2)) reach = step;
              else if (step - reach > 12) break;
            return reach;
          });
          return [(ends[0] + ends[1]) / rise, middles.length > 1 ? (y - middles[0][1]) / rise : 0];
        });
      };
      const { scale, x: mx, z: mz } = stage.viewAt(frame), [middle, foot] = stage.origin();
      const flat = spread(() => stage.draw(frame, player.time()), (k) => [middle + (data.poses[3 * k][frame] - mx) * scale, foot - (data.poses[3 * k + 1][frame] - mz) * scale]);
      const turned = spread(() => deep.draw(frame, player.time()), (k) => deep.project(deep.placeOf(k, frame)));
      flat.forEach(([wide, up], k) => {
        const [own, high] = turned[k];
        shares.push(Math.abs(own / wide - 1));
        if (Math.abs(up - high) > 0.06) faults.push(`${data.depth.plane}: a barrel at ${up} of the height is at ${high}`);
      });
      Object.assign(stage, { names: true, traces: true });
    }
    player.views.eye.go("above");
    const up = player.views.eye.above;
    player.views.eye.go("corner");
    shares.sort((a, b) => a - b);
    return { faults, typical: shares[shares.length >> 1], up, count: shares.length };
  });
  demand(found.faults.length === 0, found.faults.slice(0, 5).join("\n"));
  demand(found.count >= 4 && found.typical < 0.2, `barrels are wider or slimmer by ${(100 * found.typical).toFixed(0)} % than on the flat picture`);
  demand(Math.abs(found.up - 0.5 * Math.PI) < 1e-9, "from above the eye is not above");
  return `${found.count} barrels, typically ${(100 * found.typical).toFixed(0)} % off`;
}

/** Arrows of forces appear where the switch asks for them, and the pointer shows their values. */
export async function arrows(page) {
  const box = page.locator('.player [data-act="forces"]').first();
  demand(await box.isVisible(), "there is no switch of forces");
  await page.evaluate(() => window.barrelstack.player.seek(0));
  const bare = (await facts(page)).picture;
  await box.check();
  demand((await facts(page)).picture !== bare, "the switch draws no arrow");
  const found = await page.evaluate(() => {
    const { player } = window.barrelstack, faults = [];
    let asked = 0;
    for (const share of [0, 0.3, 1]) {
      player.seek(share * player.times().at(-1));
      for (const { stage, deep, frame } of player.panes.filter((one) => one.deep)) {
        for (const { at, force } of deep.pushesAt(frame())) {
          if (Math.hypot(...force) < 500) continue;
          stage.hover = deep.project(at).slice(0, 2);
          deep.draw(frame(), player.time());
          asked += 1;
          if (!/^[\d.]+\u00a0k?N$/.test(stage.valued?.text ?? "")) faults.push(`over an arrow of ${Math.hypot(...force)} N it says ${stage.valued?.text}`);
        }
        stage.hover = null;
      }
    }
    return { asked, faults };
  });
  await box.uncheck();
  demand(found.faults.length === 0, found.faults.slice(0, 5).join("\n"));
  demand(found.asked >= 10, `only ${found.asked} arrows could be asked`);
  return `${found.asked} arrows`;
}

/** The switch and its key lead to the flat picture and back, to the same address of time and play. */
export async function switches(page) {
  const state = () => page.evaluate(() => ({
    deep: window.barrelstack.player.views.isDeep(), pressed: document.querySelector('[data-act="flat"]').getAttribute("aria-pressed"),
    time: window.barrelstack.player.time(), shown: [...document.querySelectorAll("canvas.scene")].filter((one) => one.checkVisibility()).length,
    all: document.querySelectorAll("canvas.scene").length,
  }));
  await page.evaluate(() => window.barrelstack.player.seek(5));
  const before = await state();
  await page.locator('[data-act="flat"]').first().click();
  const flat = await state();
  demand(!flat.deep && flat.pressed === "true" && flat.time === before.time && flat.shown === flat.all, `the button leads to ${JSON.stringify(flat)}`);
  await page.locator(".player .screen").first().focus();
  await page.keyboard.press("v");
  const back = await state();
  demand(back.deep && back.pressed === "false" && back.shown === before.shown, `the key leads to ${JSON.stringify(back)}`);
  await page.keyboard.press("Space");
  // A machine without a graphics card takes its time for a frame.
  await page.waitForFunction((time) => window.barrelstack.player.time() > time, before.time, { timeout: 5000 });
  await page.keyboard.press("Space");
}

/** The time of a frame, which depends on the machine and is stated, not judged. */
export async function pace(page) {
  const { frame, bodies } = await page.evaluate(() => {
    const { player } = window.barrelstack;
    const times = [];
    for (let k = 0; k < 20; k++) {
      const since = performance.now();
      player.seek(player.times().at(-1) * (k / 20));
      document.querySelector("canvas.scene").getContext("2d").getImageData(0, 0, 1, 1);
      times.push(performance.now() - since);
    }
    const deep = player.panes.filter((one) => one.deep);
    return { frame: times.sort((a, b) => a - b)[10], bodies: deep.reduce((sum, { data }) => sum + data.depth.bodies.length, 0) };
  });
  return `${frame.toFixed(0)} ms for a frame of ${bodies} bodies`;
}

/** Without WebGL the page is flat, without an error and without a switch that leads nowhere. */
export async function without(path) {
  const browser = await launch(["--disable-webgl", "--disable-3d-apis"]);
  try {
    await open(browser, path, { viewport: DESKTOP, deep: true }, async (page) => {
      await page.evaluate(() => window.barrelstack.deep);
      const found = await page.evaluate(() => ({
        deep: window.barrelstack.player.views.isDeep(), switched: document.querySelector('[data-act="deep"]').checkVisibility(),
        drawn: new Set(document.querySelector("canvas.scene").getContext("2d").getImageData(0, 0, 400, 300).data).size,
      }));
      demand(!found.deep && !found.switched, `without WebGL it is ${JSON.stringify(found)}`);
      demand(found.drawn > 5, "without WebGL nothing is drawn");
    });
  } finally {
    await browser.close();
  }
}

/** The address asks for the flat picture. */
export async function addressed(browser, path) {
  await open(browser, path, {}, async (page) => {
    demand(addressOf(path).endsWith("?view=flat"), "the address does not ask");
    await page.evaluate(() => window.barrelstack.deep);
    demand(!(await page.evaluate(() => window.barrelstack.player.views.isDeep())), "?view=flat opens in three dimensions");
    demand(await page.locator('[data-act="deep"]').first().isVisible(), "there is no switch back");
  });
}
