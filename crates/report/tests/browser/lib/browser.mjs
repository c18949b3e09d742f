// The browser, the pages in it, and what a page must never do.

import { createRequire } from "node:module";
import { existsSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

export const DESKTOP = { width: 1280, height: 900 };
export const PHONE = { width: 390, height: 844 };

/** Ends the program with the status of "not here", which differs from "broken". */
export function missing(text) {
  console.error(`check.mjs: ${text}`);
  process.exit(2);
}

const require = createRequire(import.meta.url);

/** The browser of $CHROMIUM, or the usual one. Text is drawn the same way on every machine. */
export async function launch(more = []) {
  const executablePath = process.env.CHROMIUM || "/usr/bin/chromium";
  if (!existsSync(executablePath)) missing(`${executablePath} is not there; set CHROMIUM to the browser`);
  let playwright;
  try {
    playwright = require("playwright-core");
  } catch {
    missing("playwright-core is not installed; run `npm ci` in crates/report/tests/browser");
  }
  const args = ["--no-sandbox", "--font-render-hinting=none", "--disable-lcd-text", "--force-color-profile=srgb", ...more];
  return playwright.chromium.launch({ executablePath, args });
}

// The font of all pictures, since those of machines differ; pages themselves carry none. Its parts
// are families of their own, so that a letter is looked for in one after the other.
const WEIGHTS = [400, 600, 700];
const PARTS = { latin: "Golden", "latin-ext": "GoldenExtended", greek: "GoldenGreek", math: "GoldenMath", symbols: "GoldenSymbols" };
const FAMILIES = Object.values(PARTS).join(",");

function fontFace(part, weight) {
  const file = require.resolve(`@fontsource/roboto/files/roboto-${part}-${weight}-normal.woff2`);
  const data = readFileSync(file).toString("base64");
  return `@font-face{font-family:${PARTS[part]};font-weight:${weight};src:url(data:font/woff2;base64,${data})}`;
}

/**
 * Opens a page and hands it to `use`; adds to `faults` whatever the page must not do: write an
 * error, throw one, ask for anything but its own file.
 *
 * With `pinned` the page uses one and the same font on every machine. Unless it is `deep` it opens on its flat picture,
 * which is measured, as a reader can ask for in the address.
 */
export async function open(browser, path, { viewport = DESKTOP, colorScheme = "light", pinned = false, strict = true, deep = false, touch = false }, use) {
  const faults = [];
  const context = await browser.newContext({ viewport, colorScheme, bypassCSP: pinned, deviceScaleFactor: 1, reducedMotion: "reduce", hasTouch: touch });
  const page = await context.newPage();
  const url = addressOf(path, deep);
  page.on("console", (message) => { if (message.type() === "error") faults.push(`console: ${message.text()}`); });
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("request", (request) => {
    const asked = request.url();
    if (asked !== url && !/^(data|blob):/.test(asked)) faults.push(`asks for ${asked}`);
  });
  if (pinned) await pin(page);
  try {
    await page.goto(url);
    await page.evaluate(() => window.barrelstack?.deep);
    if (pinned) await settleFonts(page);
    await use(page);
  } finally {
    await context.close();
  }
  if (strict && faults.length > 0) throw new Error(faults.join("\n"));
  return faults;
}

/** The address of a page, in three dimensions where it can be drawn so, or flat. */
export const addressOf = (path, deep = false) => `${pathToFileURL(path).href}${deep ? "" : "?view=flat"}`;

async function pin(page) {
  await page.addInitScript((families) => {
    // Canvases name their fonts themselves.
    const own = Object.getOwnPropertyDescriptor(CanvasRenderingContext2D.prototype, "font");
    Object.defineProperty(CanvasRenderingContext2D.prototype, "font", {
      get: own.get,
      set(value) { own.set.call(this, value.replace(/system-ui.*$/, families)); },
    });
    // A picture of the whole page is taken in a window as high as the page, in which a player would be higher, if it
    // had the time to notice.
    Object.defineProperty(window, "innerHeight", { value: window.innerHeight });
  }, FAMILIES);
}

async function settleFonts(page) {
  const faces = Object.keys(PARTS).flatMap((part) => WEIGHTS.map((weight) => fontFace(part, weight)));
  await page.addStyleTag({ content: `${faces.join("\n")}*{font-family:${FAMILIES},sans-serif!important}` });
  await page.evaluate(async () => {
    await Promise.all([...document.fonts].map((face) => face.load()));
    for (const player of window.barrelstack?.players ?? []) player.refresh();
  });
}

/** Scrolls through the page, so that everything that waits to be seen is drawn. */
export async function unroll(page) {
  await page.evaluate(async () => {
    const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
    for (let y = 0; y < document.documentElement.scrollHeight; y += 700) {
      window.scrollTo(0, y);
      await frame();
    }
    window.scrollTo(0, 0);
    await frame();
  });
}
