// Opens report pages in a browser and checks what no other test can: that they run.
//
//     NODE_PATH=<folder that holds playwright-core> node check.mjs PAGE...
//
// PAGE is the path of a report.html. Chromium is $CHROMIUM, or /usr/bin/chromium. The module
// playwright-core is looked for in NODE_PATH, beside this file and upward, and in the working
// folder and upward.
//
// A page fails when it
// - writes an error to the console or throws one,
// - asks for anything but its own file,
// - scrolls sideways on a phone, or hides the play button below the first screen of 1280 × 900,
// - shows less than 30 frames a second while it plays,
// - shows another frame than the one nearest to the time asked for, at ten random times, by the
//   slider and by the program; where frames.csv lies beside the page, the poses of every body
//   must agree with it to the page's precision.
//
// Exit status: 0 when all pages pass, 1 when one fails, 2 when node, the module, the browser or a
// page is missing, so that a caller can tell "broken" from "not here".

import { createRequire } from "node:module";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const POSE = 2 ** -14, TIME = 2 ** -20; // what the page rounds to
const LEAST_RATE = 30;

function missing(text) {
  console.error(`check.mjs: ${text}`);
  process.exit(2);
}

function playwright() {
  for (const from of [import.meta.url, pathToFileURL(join(process.cwd(), "x"))]) {
    try {
      return createRequire(from)("playwright-core");
    } catch {
      // The next place may have it.
    }
  }
  return missing("playwright-core is not installed; set NODE_PATH to the folder that holds it");
}

const pages = process.argv.slice(2).map((path) => resolve(path));
if (pages.length === 0) missing("name at least one page");
for (const page of pages) if (!existsSync(page)) missing(`${page} is not there`);
const executablePath = process.env.CHROMIUM || "/usr/bin/chromium";
if (!existsSync(executablePath)) missing(`${executablePath} is not there; set CHROMIUM to the browser`);
const { chromium } = playwright();

// The same times on every machine.
let state = 20080727;
function random() {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return state / 2 ** 32;
}

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

async function scrubbing(page, path, fail) {
  const times = await page.evaluate(() => window.barrelstack.player.times());
  const csv = framesBeside(path);
  if (csv && csv.times.length !== times.length) {
    fail(`frames.csv has ${csv.times.length} frames, the page ${times.length}`);
    return "";
  }
  const source = csv ? csv.times : times;
  let worst = 0;
  for (let k = 0; k < 10; k++) {
    const bySlider = k % 2 === 0;
    const wish = bySlider ? Math.floor(random() * times.length) : times[0] + random() * (times.at(-1) - times[0]);
    const shown = await page.evaluate(([wish, bySlider]) => {
      const player = window.barrelstack.player;
      if (bySlider) {
        const slider = document.querySelector(".player input.scrub");
        slider.value = wish;
        slider.dispatchEvent(new Event("input", { bubbles: true }));
      } else {
        player.seek(wish);
      }
      const clock = document.querySelector(".player .clock").textContent;
      return { frame: player.frame(), time: player.time(), poses: player.poses(), clock };
    }, [wish, bySlider]);
    const wanted = bySlider ? wish : nearest(times, wish);
    const asked = bySlider ? `frame ${wish}` : `${wish} s`;
    if (shown.frame !== wanted) fail(`asked for ${asked} it shows frame ${shown.frame}, not ${wanted}`);
    if (Math.abs(shown.time - source[shown.frame]) > TIME) fail(`frame ${shown.frame} has the time ${shown.time}, not ${source[shown.frame]}`);
    if (shown.clock !== `${shown.time.toFixed(2)} s`) fail(`the clock shows ${shown.clock} at ${shown.time} s`);
    if (!csv) continue;
    const flat = shown.poses.flat();
    const truth = csv.poses[shown.frame];
    if (flat.length !== truth.length) fail(`${flat.length} pose numbers, frames.csv has ${truth.length}`);
    flat.forEach((value, at) => { worst = Math.max(worst, Math.abs(value - truth[at])); });
  }
  if (!(worst <= 0.51 * POSE)) fail(`a pose differs from frames.csv by ${worst}`);
  return csv ? `poses within ${worst.toExponential(1)} of frames.csv` : "no frames.csv beside it";
}

// Frames shown in the best of three seconds: a busy machine may steal one, not all.
async function frameRate(page) {
  return page.evaluate(async () => {
    const player = window.barrelstack.player;
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));
    let drawn = 0;
    player.onTime(() => { drawn += 1; });
    const select = document.querySelector('.player [data-act="speed"]');
    // Slow enough that a short run does not end first.
    const times = player.times();
    select.value = times.at(-1) - times[0] > 4 ? "1" : "0.25";
    select.dispatchEvent(new Event("change"));
    player.seek(0.6 * times.at(-1));
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
}

async function check(browser, path) {
  const faults = [];
  const fail = (text) => faults.push(text);
  const notes = [];
  const url = pathToFileURL(path).href;
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  const page = await context.newPage();
  page.on("console", (message) => { if (message.type() === "error") fail(`console: ${message.text()}`); });
  page.on("pageerror", (error) => fail(`error: ${error.message}`));
  page.on("request", (request) => {
    const asked = request.url();
    if (asked !== url && !asked.startsWith("data:") && !asked.startsWith("blob:")) fail(`asks for ${asked}`);
  });
  await page.goto(url);
  const has = await page.evaluate(() => Boolean(window.barrelstack && window.barrelstack.player));
  if (has) {
    const play = await page.locator('.player [data-act="play"]').first().boundingBox();
    if (!play || play.y + play.height > 900) fail("the play button is below the first screen of 1280 × 900");
    notes.push(await scrubbing(page, path, fail));
    const count = await page.evaluate(() => window.barrelstack.player.times().length);
    if (count > 30) {
      for (const name of ["names", "forces", "traces"]) {
        const box = page.locator(`.player [data-act="${name}"]`).first();
        if (await box.isVisible()) await box.check();
      }
      const rate = await frameRate(page);
      notes.push(`${rate.toFixed(0)} frames a second with everything drawn`);
      if (rate < LEAST_RATE) fail(`${rate.toFixed(1)} frames a second, at least ${LEAST_RATE} are due`);
    }
  } else {
    notes.push("no player");
  }
  await page.emulateMedia({ colorScheme: "dark" });
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(400);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (wide > 390) fail(`it is ${wide} px wide on a phone of 390 px`);
  await page.evaluate(() => { for (const fold of document.querySelectorAll("details")) fold.open = true; });
  await page.waitForTimeout(200);
  await context.close();
  console.log(`${faults.length ? "FAIL" : "ok  "} ${path}: ${notes.filter(Boolean).join(", ")}`);
  for (const fault of faults) console.log(`     ${fault}`);
  return faults.length === 0;
}

const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
let sound = true;
for (const path of pages) sound = (await check(browser, path)) && sound;
await browser.close();
process.exit(sound ? 0 : 1);
