// Checks of how a player opens: on the moment that matters, looped or still, until the reader takes over.

import { DESKTOP, addressOf } from "./browser.mjs";
import { demand } from "./suite.mjs";

const facts = (page) => page.evaluate(() => {
  const { player } = window.barrelstack;
  return {
    time: player.time(), moment: player.moment, begins: player.begins, looping: player.isLooping(), playing: player.isPlaying(),
    first: player.times()[0], callouts: player.panes.filter((pane) => pane.stage.callout && pane.data.moment).length,
    hash: location.hash,
  };
});

/** Where motion is unwanted the page opens on a still of the moment, with its sentence. */
export async function still(page) {
  const now = await facts(page);
  demand(now.moment, "no pane has a moment");
  demand(!now.looping && !now.playing, "something moves though motion is unwanted");
  demand(Math.abs(now.time - now.moment.t) <= 0.5 / 60 + 1e-3, `it opens at ${now.time} s, its moment is ${now.moment.t} s`);
  demand(now.callouts > 0, "no sentence stands at the body that goes first");
  demand(now.hash === "", `the opening writes ${now.hash} into the address`);
  // The first loss of a seat of all panes, from the list of events.
  const losses = await page.evaluate(() => window.barrelstack.player.panes.flatMap((pane) => pane.data.events).filter((event) => ["seat", "fall"].includes(event.kind)).map((event) => event.t));
  if (losses.length > 0) {
    demand(now.moment.t <= Math.min(...losses) + 1e-6, `the moment, ${now.moment.t} s, is after the first loss, ${Math.min(...losses)} s`);
  }
  return `${now.moment.text}, ${now.moment.t.toFixed(2)} s`;
}

/** Opens a page where motion is welcome, and hands it to `use`. */
async function moving(browser, path, hash, use) {
  const context = await browser.newContext({ viewport: DESKTOP, reducedMotion: "no-preference" });
  try {
    const page = await context.newPage();
    await page.goto(addressOf(path) + hash);
    return await use(page);
  } finally {
    await context.close();
  }
}

/** Elsewhere it loops slowly around the moment; Space, slider and button stop it at once. */
export function loops(browser, path) {
  return moving(browser, path, "", async (page) => {
    let now = await facts(page);
    demand(now.looping && !now.playing, "it does not loop");
    const seen = [];
    const began = Date.now();
    for (let k = 0; k < 6; k++) {
      seen.push((await facts(page)).time);
      await page.waitForTimeout(250);
    }
    const wall = (Date.now() - began) / 1000;
    demand(seen.at(-1) > seen[0], "the loop stands still");
    demand(seen.at(-1) - seen[0] < 0.5 * wall, `in ${wall.toFixed(1)} s it shows ${(seen.at(-1) - seen[0]).toFixed(2)} s: that is not slow`);
    demand(seen.every((time) => time > now.moment.t - 0.6 && time < now.moment.t + 1.2), `the loop leaves its moment: ${seen}`);
    // Space, with nothing focused, pauses the loop, and then plays from shortly before the strong motion.
    const label = () => page.locator('[data-act="play"]').first().getAttribute("aria-label");
    demand((await label()) === "Pause", `while it loops, the button says ${await label()}`);
    await page.keyboard.press("Space");
    const paused = await facts(page);
    await page.waitForTimeout(400);
    now = await facts(page);
    demand(!now.looping && !now.playing && now.time === paused.time && (await label()) === "Play", "the first press of space does not pause");
    await page.keyboard.press("Space");
    // A busy machine may draw a frame late.
    for (let k = 0; k < 20; k++) {
      await page.waitForTimeout(150);
      now = await facts(page);
      if (now.playing && !now.looping) break;
    }
    demand(now.playing && !now.looping, "space does not take over from the loop");
    demand(now.time >= now.begins - 0.02 && now.time < now.begins + 1.5, `it plays from ${now.time} s, strong motion begins after ${now.begins} s`);
    await page.keyboard.press("Space");
    demand(!(await facts(page)).playing, "space does not pause");
    // Its button brings the loop back; the slider takes over, too.
    const button = page.locator('[data-act="moment"]').first();
    await button.click();
    demand((await facts(page)).looping && (await button.getAttribute("aria-pressed")) === "true", "the button does not loop");
    const slider = await page.locator("input.scrub").first().boundingBox();
    await page.mouse.click(slider.x + 0.25 * slider.width, slider.y + 0.5 * slider.height);
    now = await facts(page);
    demand(!now.looping && !now.playing, "the slider does not take over from the loop");
    await button.click();
    await button.click();
    now = await facts(page);
    demand(!now.looping && Math.abs(now.time - now.moment.t) < 0.02, "the button does not stop the loop on its moment");
  });
}

/** An address with #t= opens there, and the address follows the reader. */
export function links(browser, path) {
  return moving(browser, path, "#t=6.5", async (page) => {
    let now = await facts(page);
    demand(!now.looping && Math.abs(now.time - 6.5) <= 0.5 / 60 + 1e-3, `#t=6.5 opens at ${now.time} s`);
    await page.evaluate(() => window.barrelstack.player.seek(7.25));
    await page.waitForFunction(() => location.hash !== "#t=6.5", null, { timeout: 3000 });
    now = await facts(page);
    demand(Math.abs(Number(now.hash.slice(3)) - now.time) <= 0.005 + 1e-9, `at ${now.time} s the address says ${now.hash}`);
    await page.evaluate(() => { location.hash = "#t=3"; });
    await page.waitForTimeout(100);
    now = await facts(page);
    demand(Math.abs(now.time - 3) <= 0.5 / 60 + 1e-3, `a changed address leads to ${now.time} s`);
  });
}
