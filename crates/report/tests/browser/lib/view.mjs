// Checks of the picture of a player: zoom, pan, values of forces, tint, and that cursor and slider agree.

import { demand } from "./suite.mjs";

const lens = (page) => page.evaluate(() => ({ ...window.barrelstack.player.lens }));

/** Wheel, drag, keys and double click; the point under the pointer stays where it is. */
export async function zooming(page) {
  await page.evaluate(() => window.scrollTo(0, 0));
  const canvas = page.locator(".player canvas.scene").first();
  const box = await canvas.boundingBox();
  // The pointer stands on whole pixels.
  const at = [box.x + 0.4 * box.width, box.y + 0.5 * box.height].map(Math.round);
  const under = () => page.evaluate(([px, py]) => {
    const { stage } = window.barrelstack.player.panes[0];
    const { scale, x, z } = stage.viewAt(0), [middle, foot] = stage.origin();
    return [x + (px - middle) / scale, z + (foot - py) / scale];
  }, [at[0] - box.x, at[1] - box.y]);
  await page.mouse.move(...at);
  // Alone the wheel scrolls the page.
  await page.mouse.wheel(0, 60);
  await page.waitForTimeout(150);
  demand((await lens(page)).factor === 1, "the wheel alone zooms, so that the page cannot be scrolled");
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.waitForTimeout(150);
  const before = await under();
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -400);
  await page.keyboard.up("Control");
  await page.waitForFunction(() => window.barrelstack.player.lens.factor > 1.5, null, { timeout: 2000 });
  const after = await under();
  demand(Math.hypot(after[0] - before[0], after[1] - before[1]) < 1e-6, `the point under the pointer moves from ${before} to ${after}`);
  const scales = await page.evaluate(() => window.barrelstack.player.panes.map((pane) => pane.stage.viewAt(0).scale));
  demand(Math.max(...scales) - Math.min(...scales) < 1e-6 * scales[0], `the scales of the panes differ: ${scales}`);
  await page.mouse.down();
  await page.mouse.move(at[0] + 60, at[1] + 30, { steps: 3 });
  await page.mouse.up();
  const dragged = await under();
  demand(Math.abs((after[0] - dragged[0]) * scales[0] - 60) < 1 && Math.abs((dragged[1] - after[1]) * scales[0] - 30) < 1,
    `a drag by 60 and 30 px moves the picture by ${[(after[0] - dragged[0]) * scales[0], (dragged[1] - after[1]) * scales[0]]}`);
  await page.mouse.dblclick(...at);
  demand(JSON.stringify(await lens(page)) === '{"factor":1,"x":0,"z":0}', "a double click does not show the whole picture");
  await page.locator(".player .screen").first().focus();
  for (const key of ["+", "w", "d"]) await page.keyboard.press(key);
  const moved = await lens(page);
  demand(moved.factor > 1 && moved.x > 0 && moved.z > 0, `keys lead to ${JSON.stringify(moved)}`);
  await page.keyboard.press("0");
  demand((await lens(page)).factor === 1, "0 does not show the whole picture");
}

/** The panel of keys opens and closes from the keyboard, and the screen can be filled. */
export async function panels(page) {
  await page.locator(".player .screen").first().focus();
  await page.keyboard.press("?");
  const dialog = page.locator(".player dialog").first();
  demand(await dialog.isVisible(), "? does not show the keys");
  const text = await dialog.textContent();
  for (const word of ["play", "camera", "full screen", "zoom in"]) demand(text.includes(word), `the keys do not say how to: ${word}`);
  await page.keyboard.press("Escape");
  demand(!(await dialog.isVisible()), "escape does not close the keys");
  const high = (await page.locator(".player canvas.scene").first().boundingBox()).height;
  await page.locator('.player [data-act="fullscreen"]').first().click();
  await page.waitForFunction(() => document.fullscreenElement?.classList.contains("screen"), null, { timeout: 3000 });
  await page.waitForTimeout(200);
  const fits = await page.evaluate(() => {
    const screen = document.fullscreenElement;
    return screen.scrollHeight <= window.innerHeight + 1;
  });
  demand(fits, "on the full screen the player must be scrolled");
  await page.evaluate(() => document.exitFullscreen());
  await page.waitForFunction((high) => Math.abs(document.querySelector(".player canvas.scene").getBoundingClientRect().height - high) < 0.05 * high, high, { timeout: 3000 });
}

/** Over an arrow the pointer shows its force, and never over a name. */
export async function values(page) {
  const box = page.locator('.player [data-act="forces"]').first();
  await box.check();
  const found = await page.evaluate(() => {
    const { player } = window.barrelstack;
    const [pane] = player.panes;
    const { stage } = pane;
    const faults = [];
    let asked = 0;
    for (const share of [0.2, 0.5, 0.8]) {
      player.seek(share * player.times().at(-1));
      const { scale, x, z } = stage.viewAt(pane.frame()), [middle, foot] = stage.origin();
      for (const force of pane.forces()) {
        const size = Math.hypot(force.fx, force.fz);
        const at = [middle + (force.x - x) * scale, foot - (force.z - z) * scale];
        if (size < 500 || at[0] < 30 || at[0] > 2 * middle - 30 || at[1] < 50) continue;
        stage.hover = at;
        stage.draw(pane.frame(), player.time());
        asked += 1;
        const { valued } = stage;
        if (!valued || !/^[\d.]+\u00a0k?N$/.test(valued.text)) faults.push(`over an arrow of ${size} N it says ${valued?.text}`);
        else if (stage.names && valued.names.some((name) => name[0] < valued.box[2] && valued.box[0] < name[2] && name[1] < valued.box[3] && valued.box[1] < name[3])) {
          faults.push(`${valued.text} stands over a name`);
        }
      }
    }
    stage.hover = null;
    return { faults, asked };
  });
  await box.uncheck();
  demand(found.asked >= 5, `only ${found.asked} arrows could be asked`);
  demand(found.faults.length === 0, found.faults.slice(0, 5).join("\n"));
  return `${found.asked} arrows`;
}

/** The tint of a barrel follows its stress: white where nothing presses, full where it is largest. */
export async function tints(page) {
  const box = page.locator('.player [data-act="tint"]').first();
  await box.check();
  const found = await page.evaluate(() => {
    const { player } = window.barrelstack;
    const pane = player.panes[0], { stage, data } = pane;
    const ratio = Math.min(window.devicePixelRatio || 1, 3);
    const barrels = data.bodies.map((body, at) => at).filter((at) => data.bodies[at].role === "barrel");
    stage.names = stage.traces = false;
    stage.callout = false;
    const pairs = [];
    for (const share of [0.02, 0.3, 0.6]) {
      player.seek(share * player.times().at(-1));
      const k = pane.frame(), { scale, x, z } = stage.viewAt(k), [middle, foot] = stage.origin();
      stage.callout = false;
      stage.draw(k, player.time());
      for (const body of barrels) {
        const px = middle + (data.poses[3 * body][k] - x) * scale, py = foot - (data.poses[3 * body + 1][k] - z) * scale;
        if (px < 5 || px > 2 * middle - 5 || py < 75) continue;
        const [, g] = stage.canvas.getContext("2d").getImageData(Math.round(px * ratio), Math.round(py * ratio), 1, 1).data;
        pairs.push([Math.min(data.tint.values[body][k] / stage.full, 1), g]);
      }
    }
    stage.names = stage.traces = true;
    return { pairs, full: stage.full };
  });
  await box.uncheck();
  demand(found.full > 0 && found.pairs.length >= 6, `${found.pairs.length} barrels in sight, ${found.full} kN/m at most`);
  // Green goes from that of the paper, 255, to that of the accent, 31.
  for (const [share, green] of found.pairs) {
    demand(Math.abs(green - (255 - share * 224)) < 4, `at ${share} of the scale the green is ${green}`);
  }
  return `${found.pairs.length} barrels, to ${found.full.toFixed(1)} kN/m`;
}

/** The cursor of the strip stands over the middle of the thumb, to a pixel, as they are painted. */
export async function agreement(page) {
  const strip = page.locator(".player canvas.timeline").first();
  if (!(await strip.isVisible())) return "no strip";
  let worst = 0;
  for (const share of [0, 0.13, 0.5, 0.77, 1]) {
    await page.evaluate((share) => {
      const { player } = window.barrelstack;
      player.seek(player.times()[0] + share * (player.times().at(-1) - player.times()[0]));
    }, share);
    await strip.scrollIntoViewIfNeeded();
    const [a, b] = [await strip.boundingBox(), await page.locator(".player .rail").first().boundingBox()];
    const clip = { x: a.x, y: a.y, width: a.width, height: b.y + b.height - a.y };
    const picture = (await page.screenshot({ clip })).toString("base64");
    const middles = await page.evaluate(async ([picture, high]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${picture}`;
      await image.decode();
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [image.width, image.height];
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const wish = getComputedStyle(document.documentElement).getPropertyValue("--accent").trim();
      const parts = [1, 3, 5].map((k) => parseInt(wish.slice(k, k + 2), 16));
      // The middle of what has the color of the accent in a row.
      const middle = (y) => {
        const row = context.getImageData(0, Math.round(y), image.width, 1).data;
        const hits = [];
        for (let x = 0; x < image.width; x++) if (parts.every((part, k) => Math.abs(row[4 * x + k] - part) < 12)) hits.push(x + 0.5);
        return hits.length > 0 ? 0.5 * (hits[0] + hits.at(-1)) : NaN;
      };
      // The strip has the cursor alone in its last row.
      return [middle(high - 1), middle(high + 0.5 * (image.height - high))];
    }, [picture, a.height]);
    const apart = Math.abs(middles[0] - middles[1]);
    demand(apart <= 1, `at ${share} of the run the cursor stands at ${middles[0]} px, the thumb at ${middles[1]} px`);
    worst = Math.max(worst, apart);
  }
  return `${worst.toFixed(2)} px apart`;
}
