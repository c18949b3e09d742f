// Checks of a player: that it shows what the recording holds, plays smoothly, and heeds its keys.

import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { demand, seeded } from "./suite.mjs";

const POSE = 2 ** -14, TIME = 2 ** -20; // what the page rounds to
const LEAST_RATE = 30;
const SPACE = "\u00a0";

function framesBeside(page) {
  const path = join(dirname(page), "frames.csv");
  if (!existsSync(path)) return null;
  const rows = readFileSync(path, "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  return { times: rows.map((row) => row[0]), poses: rows.map((row) => row.slice(1)) };
}

function nearest(times, time) {
  let best = 0;
  times.forEach((t, k) => { if (Math.abs(t - time) < Math.abs(times[best] - time)) best = k; });
  return best;
}

/** Ten random times, by the slider and by the program, against frames.csv beside the page. */
export async function scrubbing(page, path) {
  const times = await page.evaluate(() => window.barrelstack.player.times());
  const csv = framesBeside(path);
  demand(csv, "there is no frames.csv beside the page");
  demand(csv.times.length === times.length, `frames.csv has ${csv.times.length} frames, the page ${times.length}`);
  const random = seeded(20080727);
  let worst = 0;
  for (let k = 0; k < 10; k++) {
    const bySlider = k % 2 === 0;
    const wish = bySlider ? Math.floor(random() * times.length) : times[0] + random() * (times.at(-1) - times[0]);
    const shown = await page.evaluate(([wish, bySlider]) => {
      const player = window.barrelstack.player;
      if (bySlider) {
        const slider = document.querySelector(".player input.scrub");
        slider.value = player.times()[wish];
        slider.dispatchEvent(new Event("input", { bubbles: true }));
      } else {
        player.seek(wish);
      }
      const clock = document.querySelector(".player .clock").textContent;
      return { frame: player.frame(), time: player.time(), poses: player.poses(), clock };
    }, [wish, bySlider]);
    const wanted = bySlider ? wish : nearest(times, wish);
    const asked = bySlider ? `frame ${wish}` : `${wish} s`;
    demand(shown.frame === wanted, `asked for ${asked} it shows frame ${shown.frame}, not ${wanted}`);
    const due = csv.times[shown.frame];
    demand(Math.abs(shown.time - due) <= TIME, `frame ${shown.frame} has the time ${shown.time}, not ${due}`);
    const clock = `${shown.time.toFixed(2)}${SPACE}s`;
    demand(shown.clock === clock, `the clock shows ${shown.clock} at ${clock}`);
    const flat = shown.poses.flat();
    const truth = csv.poses[shown.frame];
    demand(flat.length === truth.length, `${flat.length} pose numbers, frames.csv has ${truth.length}`);
    flat.forEach((value, at) => { worst = Math.max(worst, Math.abs(value - truth[at])); });
  }
  demand(worst <= 0.51 * POSE, `a pose differs from frames.csv by ${worst}`);
  return `poses within ${worst.toExponential(1)} of frames.csv`;
}

/** What is drawn changes with the time: pictures of two frames differ, of one frame are equal. */
export async function drawing(page) {
  const pictures = await page.evaluate(() => {
    const { player } = window.barrelstack;
    const canvas = document.querySelector(".player canvas.scene");
    const at = (share) => {
      player.seek(share * player.times().at(-1));
      return canvas.toDataURL();
    };
    return [at(0), at(0.7), at(0)];
  });
  demand(pictures[0] !== pictures[1], "the picture at the start is that of a later time");
  demand(pictures[0] === pictures[2], "the same frame gives another picture");
}

/** Frames shown in the best of three stretches: a busy machine may steal one, not all. */
export async function frameRate(page) {
  for (const name of ["names", "forces", "traces"]) {
    const box = page.locator(`.player [data-act="${name}"]`).first();
    if (await box.isVisible()) await box.check();
  }
  const rate = await page.evaluate(async () => {
    const player = window.barrelstack.player;
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));
    let drawn = 0;
    player.onTime(() => { drawn += 1; });
    const select = document.querySelector('.player [data-act="speed"]');
    // Slow enough that a short run does not end first.
    const times = player.times();
    select.value = times.at(-1) - times[0] > 4 ? "1" : "0.25";
    select.dispatchEvent(new Event("change"));
    player.seek(0.5 * times.at(-1));
    let best = 0;
    for (let k = 0; k < 3; k++) {
      player.play();
      await wait(150);
      const [count, since] = [drawn, performance.now()];
      await wait(700);
      best = Math.max(best, (1000 * (drawn - count)) / (performance.now() - since));
    }
    player.pause();
    return best;
  });
  demand(rate >= LEAST_RATE, `${rate.toFixed(1)} frames a second, at least ${LEAST_RATE} are due`);
  return `${rate.toFixed(0)} frames a second`;
}

const state = (page) => page.evaluate(() => {
  const { player } = window.barrelstack;
  const act = (name) => document.querySelector(`.player [data-act="${name}"]`);
  return {
    frame: player.frame(), playing: player.isPlaying(), count: player.times().length, time: player.time(),
    camera: act("camera").value, speed: act("speed").value,
    names: act("names").checked, forces: act("forces").checked, traces: act("traces").checked,
    label: act("play").getAttribute("aria-label"),
  };
});

/** Every key that the player's label names. */
export async function keyboard(page) {
  await page.locator(".player .screen").first().focus();
  const press = async (key) => {
    await page.keyboard.press(key);
    return state(page);
  };
  let now = await press("Home");
  demand(now.frame === 0, `Home leads to frame ${now.frame}`);
  const last = now.count - 1;
  now = await press("ArrowRight");
  demand(now.frame === 1, `the right arrow leads from 0 to ${now.frame}`);
  now = await press("Shift+ArrowRight");
  demand(now.frame === 11, `with shift the right arrow leads from 1 to ${now.frame}`);
  now = await press("ArrowLeft");
  demand(now.frame === 10, `the left arrow leads from 11 to ${now.frame}`);
  now = await press("End");
  demand(now.frame === last, `End leads to ${now.frame} of ${last}`);
  now = await press("ArrowRight");
  demand(now.frame === last, "beyond the last frame there is another");
  await press("Home");
  now = await press("Space");
  demand(now.playing && now.label === "Pause", "space does not play");
  await page.waitForTimeout(250);
  now = await press("Space");
  demand(!now.playing && now.label === "Play" && now.frame > 0, "space does not pause, or nothing moved");
  const before = now;
  now = await press("<");
  demand(Number(now.speed) < Number(before.speed), "< does not slow down");
  now = await press(">");
  demand(now.speed === before.speed, "> does not undo <");
  for (const [key, name] of [["n", "names"], ["f", "forces"], ["p", "traces"]]) {
    const was = (await state(page))[name];
    now = await press(key);
    const there = await page.locator(`.player [data-act="${name}"]`).first().isVisible();
    demand((now[name] !== was) === there, `${key} ${there ? "does not change" : "changes what is not there:"} ${name}`);
    await press(key);
  }
  const seen = new Set([now.camera]);
  for (let k = 0; k < 2; k++) seen.add((await press("c")).camera);
  demand(seen.size === 3, `c reaches the cameras ${[...seen].join(", ")}`);
  demand((await press("c")).camera === now.camera, "c does not return to the first camera");
  // Every control can be reached with the tabulator and has a name.
  const nameless = await page.evaluate(() => [...document.querySelectorAll("button, select, input, canvas, [role=group], [role=region]")]
    .filter((element) => !element.closest("[hidden], .live:empty") && element.getAttribute("aria-hidden") !== "true")
    .filter((element) => !(element.getAttribute("aria-label") || element.closest("label")?.textContent.trim() || element.textContent.trim()))
    .filter((element) => !element.closest(".u-wrap"))
    .map((element) => element.outerHTML.slice(0, 80)));
  demand(nameless.length === 0, `without a name for readers of screens: ${nameless.join(" ")}`);
}

/** The fixed camera lets the ground move; the one on the ground holds it still. */
export async function cameras(page) {
  const shifts = await page.evaluate(() => {
    const { player } = window.barrelstack;
    const pane = player.panes[0];
    const select = document.querySelector('.player [data-act="camera"]');
    // The place on the screen of the first body of the ground, from the view that draws it.
    const ground = pane.data.bodies.findIndex((body) => body.role === "ground");
    const at = (camera, time) => {
      select.value = camera;
      select.dispatchEvent(new Event("change"));
      player.seek(time);
      const view = pane.stage.viewAt(pane.frame());
      return (pane.data.poses[3 * ground][pane.frame()] - view.x) * view.scale;
    };
    const times = player.times();
    let far = 0;
    times.forEach((t, k) => {
      const x = pane.data.poses[3 * ground];
      if (Math.abs(x[k] - x[0]) > Math.abs(x[far] - x[0])) far = k;
    });
    const moved = (camera) => at(camera, times[far]) - at(camera, times[0]);
    const result = { fixed: moved("fixed"), ground: moved("ground"), stack: moved("stack") };
    select.value = "fixed";
    select.dispatchEvent(new Event("change"));
    return result;
  });
  demand(Math.abs(shifts.fixed) > 5, `under the fixed camera the ground moves by ${shifts.fixed} px`);
  demand(Math.abs(shifts.ground) < 0.01, `under the camera on the ground it moves by ${shifts.ground} px`);
  demand(Math.abs(shifts.stack) < Math.abs(shifts.fixed), `the camera that follows moves with nothing: ${shifts.stack} px`);
  return `the ground moves by ${shifts.fixed.toFixed(0)}, ${shifts.ground.toFixed(0)} and ${shifts.stack.toFixed(0)} px`;
}

/** Several panes: each shows its own frame nearest to the one time, and one button plays all. */
export async function together(page) {
  const found = await page.evaluate(async () => {
    const { player } = window.barrelstack;
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));
    const nearest = (times, t) => times.reduce((best, v, k) => (Math.abs(v - t) < Math.abs(times[best] - t) ? k : best), 0);
    const faults = [];
    for (const share of [0, 0.21, 0.5, 0.77, 1]) {
      player.seek(share * player.times().at(-1));
      for (const [at, pane] of player.panes.entries()) {
        const wanted = nearest(Array.from(pane.data.times), player.time());
        if (pane.frame() !== wanted) faults.push(`at ${player.time()} s pane ${at + 1} shows frame ${pane.frame()}, not ${wanted}`);
      }
    }
    player.seek(0);
    document.querySelector('.player [data-act="play"]').click();
    await wait(400);
    player.pause();
    const moved = player.panes.every((pane) => pane.frame() > 0);
    if (!moved) faults.push("one pane stood still while the others played");
    const scales = player.panes.map((pane) => pane.stage.viewAt(0).scale);
    if (Math.max(...scales) - Math.min(...scales) > 1e-6 * scales[0]) faults.push(`the scales differ: ${scales}`);
    return { faults, panes: player.panes.length, sliders: document.querySelectorAll("input.scrub").length };
  });
  demand(found.faults.length === 0, found.faults.join("\n"));
  demand(found.panes >= 2 && found.sliders === 1, `${found.panes} panes and ${found.sliders} sliders`);
  const heads = await page.locator(".pane .pane-head").allTextContents();
  demand(heads.length === found.panes && heads.every((text) => text.trim().length > 10), "a pane has no verdict of its own");
}
