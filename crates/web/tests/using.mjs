// How the page is used: opened, typed into, dropped on, and read.

import { pathToFileURL } from "node:url";
import { DESKTOP } from "../../report/tests/browser/lib/browser.mjs";
import { demand } from "../../report/tests/browser/lib/suite.mjs";

export const PATIENCE = 300_000; // ms: other programs may have the cores

/** A page of the file, with everything it must not do noted in `faults`. */
export async function opened(browser, file, options = {}, hash = "") {
  const context = await browser.newContext({ viewport: DESKTOP, reducedMotion: "no-preference", ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  const url = pathToFileURL(file).href;
  const faults = [];
  // What the driver of the graphics says of its pace is none of the page.
  page.on("console", (message) => { if (!message.text().includes("GL Driver Message")) faults.push(`console: ${message.text()}`); });
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("request", (request) => {
    if (request.url().split("#")[0] !== url && !/^(data|blob):/.test(request.url())) faults.push(`asks for ${request.url()}`);
  });
  await page.goto(url + hash);
  await page.waitForFunction(() => window.barrelstack?.started > 0);
  return { page, faults, context };
}

/** Waits until as many runs are there and the last is done. */
export const idle = (page, runs) => page.waitForFunction((runs) => {
  const past = window.barrelstack.runs.past();
  return document.getElementById("stop").hidden && past.length === runs && past.at(-1).done;
}, runs);
export const look = (page) => page.evaluate(() => window.barrelstack.state().look);
export const last = (page) => page.evaluate(() => {
  const { verdict, label, shown } = window.barrelstack.runs.past().at(-1);
  return { verdict, label, variant: shown.variant };
});

/** Sets fields as an engineer types them. */
export async function type(page, changes) {
  await page.evaluate(() => { document.getElementById("engineer-fold").open = true; });
  for (const [path, value] of Object.entries(changes)) {
    await page.fill(`#fields input[aria-label="${path}"]`, value);
    await page.waitForFunction(([path, value]) => window.barrelstack.state().cellar.changes[path] === value, [path, value]);
    await page.waitForFunction((path) => window.barrelstack.state().look.settings.some((one) => one.path === path), path);
  }
  await page.waitForTimeout(400);
}

/** What is changed, for the command; its record goes by an option. */
export const sets = async (page) => {
  const changes = await page.evaluate(() => Object.entries(window.barrelstack.state().cellar.changes));
  return changes.filter(([path]) => path !== "motion.record").flatMap(([path, value]) => ["--set", `${path}=${value}`]);
};

/** Drops files on the page. */
export const drop = (page, files) => page.evaluate((files) => {
  const data = new DataTransfer();
  for (const [name, base64] of files) data.items.add(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], name));
  document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true, bubbles: true }));
}, files.map(([name, bytes]) => [name, Buffer.from(bytes).toString("base64")]));

/** With the keys of all objects in order. */
export const sorted = (value) => {
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return value.map(sorted);
  return Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1)).map(([name, one]) => [name, sorted(one)]));
};

/** The spread of each plane by its name, of a summary. */
export const spreads = ({ view, ensemble, other_plane: other }) => ({ [view]: ensemble, ...(other ? spreads(other) : {}) });
export const sameSpreads = (verdict, summary) => {
  const found = Object.fromEntries(verdict.planes.map(({ view, spread }) => [view, spread]));
  const expected = spreads(summary);
  for (const view of Object.keys(expected)) {
    demand(JSON.stringify(found[view]) === JSON.stringify(expected[view]), `${view}: ${JSON.stringify(found[view])}\nexpected ${JSON.stringify(expected[view])}`);
  }
};
