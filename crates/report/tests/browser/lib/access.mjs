// Checks for readers of screens and keyboards: axe, whose rules are those of WCAG 2.2 and good practice.

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { DESKTOP, PHONE, missing, unroll } from "./browser.mjs";
import { demand } from "./suite.mjs";

let source = null;

function axe() {
  try {
    source ??= readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
  } catch {
    missing("axe-core is not installed; run `npm ci` in crates/report/tests/browser");
  }
  return source;
}

// What axe finds on a page as it is now, one line for each rule.
async function findings(page) {
  await page.evaluate(axe());
  return page.evaluate(async () => {
    const { violations, passes } = await window.axe.run(document, { resultTypes: ["violations"] });
    const lines = violations.map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.length} such as ${nodes[0].html.slice(0, 120)}`);
    return { lines, rules: violations.length + passes.length };
  });
}

/** No finding with everything unfolded, in light and dark, on a desk and on a phone. */
export async function accessible(page) {
  await page.evaluate(() => { for (const fold of document.querySelectorAll("details")) fold.open = true; });
  const faults = [];
  let rules = 0;
  for (const [viewport, colorScheme] of [[DESKTOP, "light"], [DESKTOP, "dark"], [PHONE, "light"]]) {
    await page.setViewportSize(viewport);
    await page.emulateMedia({ colorScheme });
    await unroll(page);
    const found = await findings(page);
    rules = Math.max(rules, found.rules);
    faults.push(...found.lines.map((line) => `${viewport.width} px, ${colorScheme}: ${line}`));
  }
  await page.setViewportSize(DESKTOP);
  await page.emulateMedia({ colorScheme: "light" });
  demand(rules > 20, `only ${rules} rules had anything to look at`);
  demand(faults.length === 0, faults.join("\n"));
  return `${rules} rules`;
}

/** A page spoiled on purpose, so that a scan which sees nothing is noticed. */
export async function spoiled(page) {
  await page.evaluate(() => {
    document.querySelector("table th").textContent = "";
    document.querySelector("p.text, p.lead").style.color = "#ddd";
  });
  const { lines } = await findings(page);
  for (const rule of ["empty-table-header", "color-contrast"]) {
    demand(lines.some((line) => line.startsWith(rule)), `${rule} is not found on a page that breaks it`);
  }
}
