// Numbers of a page, read back and compared with the JSON document of the same run.

import { demand } from "./suite.mjs";

const GRAVITY = 9.80665;
const VIEWS = { "across the barrels": "transverse", "along the barrels": "longitudinal" };
const PLACES = Object.fromEntries(Object.entries(VIEWS).map(([words, view]) => [view, words]));

/** The numbers in a text, each with its text; "< 0.1" has a bound. */
function numbersIn(text) {
  const plain = text.replaceAll("−", "-").replace(/(\d)–(?=\d)/g, "$1 ");
  return [...plain.matchAll(/(<|less than|>|more than)?\s*(-?\d+(?:\.\d+)?)/g)].map(([, bound, digits]) => ({ bound, digits }));
}

/** Whether a number as shown is a value, rounded to the digits that are shown; counts are below 1000. */
function shows({ bound, digits }, value) {
  if (bound === "<" || bound === "less than") return Math.abs(value) < Number(digits);
  if (bound) return value > Number(digits);
  const [whole, decimals = ""] = digits.replace("-", "").split(".");
  // Measured numbers have three significant digits where these are fewer than all.
  const step = 10 ** (decimals ? -decimals.length : Math.max(0, whole.length - 3));
  return Math.abs(Number(digits) - value) <= 0.5000001 * step;
}

/** Compares the numbers of pages with values, and counts the comparisons. */
class Reading {
  constructor() {
    this.count = 0;
    this.faults = [];
  }

  /** The first numbers of a text are these values; a null is a dash. */
  are(what, text, values) {
    this.count += values.length;
    const shown = values.every((value) => value === null) ? [] : numbersIn(text);
    const dash = shown.length === 0 && text.trim() === "–";
    const right = values.every((value, at) => (value === null ? dash : shown[at] && shows(shown[at], value)));
    if (!right) this.faults.push(`${what}: the page states "${text}", the JSON ${JSON.stringify(values)}`);
  }

  close() {
    demand(this.faults.length === 0, this.faults.join("\n"));
    demand(this.count > 0, "nothing was compared");
    return `${this.count} numbers`;
  }
}

/** Headline, heads of panes, and all tables of a page as text. */
async function contents(page) {
  return page.evaluate(() => {
    const text = (element) => element.textContent.replaceAll("\u00a0", " ");
    return {
      headline: text(document.querySelector("h1")),
      rest: text(document.querySelector(".account .rest") ?? document.createElement("p")),
      heads: [...document.querySelectorAll(".screen .pane-head")].map(text),
      tables: [...document.querySelectorAll("table")].map((table) => ({
        caption: text(table.caption),
        head: [...table.tHead.rows[0].cells].map(text),
        rows: [...table.tBodies[0].rows].map((row) => [...row.cells].map(text)),
      })),
    };
  });
}

function tablesOf({ tables }, begin) {
  const found = tables.filter(({ caption }) => caption.replace(/^Table \d+\. /, "").startsWith(begin));
  demand(found.length > 0, `no table begins with "${begin}"`);
  return found;
}

const percents = (shares) => shares.map((share) => 100 * share);

/** The page of a run, in planes or in space. */
export async function ofRun(page, summary) {
  const shown = await contents(page), reading = new Reading();
  const planes = [summary, summary.other_plane].filter(Boolean);
  const spreads = planes.filter(({ ensemble }) => ensemble);
  for (const { ensemble } of spreads) {
    const { collapsed, variants, interval } = ensemble;
    const said = collapsed === variants ? `all ${variants}` : collapsed === 0 ? `(?:none of|0 of) (?:the )?${variants}` : `${collapsed} of ${variants}`;
    const counts = shown.headline.match(new RegExp(`${said}\\D[^(]*\\(([^)]*)\\)`));
    demand(counts, `the headline does not state ${collapsed} of ${variants}: ${shown.headline}`);
    // If all or none fall, only the other end of the interval is stated.
    const stated = counts[1].replace("95 % confidence: ", "");
    const bounds = stated.includes("at least") ? [interval[0]] : stated.includes("at most") ? [interval[1]] : interval;
    reading.are("interval in the headline", stated, percents(bounds));
  }
  if (spreads.length > 0) {
    const [table] = tablesOf(shown, "Range");
    const row = (name) => table.rows.find(([first]) => first === name);
    table.head.slice(1).forEach((head, at) => {
      const plane = planes.find(({ view }) => PLACES[view] === head.toLowerCase()) ?? summary;
      const { variants, collapsed, share, interval, range, first_loss: loss, first_fall: fall, barrels_fallen: fallen, barrels } = plane.ensemble;
      const cell = (name, values) => reading.are(`${name}, ${head}`, row(name)[at + 1], values);
      cell("variants with a verdict", [variants]);
      cell("variants that collapse", [collapsed]);
      cell("share of variants that collapse, with its 95 % interval", percents([share, ...interval]));
      if (range) cell("range of this share over the uncertain constants", percents(range));
      if (loss) cell("first loss of a seat", [loss.p05, loss.p95]);
      if (fall) cell("first fall", [fall.p05, fall.p95]);
      if (fallen) cell("barrels fallen in a collapse", [fallen.p05, fallen.p95, barrels]);
    });
  }
  if (summary.remedy) {
    const [table] = tablesOf(shown, "Changes that were tried");
    demand(table.rows.length === summary.remedy.tried.length, "the page lists other changes than the JSON");
    summary.remedy.tried.forEach(({ failed, variants, share, interval, range, better_than_as_it_is }, at) => {
      const [name, counts, shares, , over, better] = table.rows[at];
      // If not all variants were run, the page states that at least so many of all variants fall, if any did.
      const least = failed ? [failed, summary.remedy.variants] : [];
      reading.are(name, counts, share === null ? least : [failed, variants]);
      reading.are(name, shares, share === null ? [null] : percents([share, ...interval]));
      reading.are(name, over, range === null ? [null] : percents(range));
      reading.are(name, better, better_than_as_it_is === null ? [null] : percents([better_than_as_it_is]));
    });
  }
  const inSpace = summary.bodies.some((body) => "drop" in body);
  const tables = tablesOf(shown, inSpace ? "Slips are" : "The largest slip");
  demand(tables.length === planes.length, `${tables.length} tables of bodies in ${planes.length} planes`);
  tables.forEach((table, plane) => {
    const { bodies } = planes[plane], column = (begin) => table.head.findIndex((head) => head.startsWith(begin));
    for (const row of table.rows) {
      const body = bodies.find(({ name }) => name === row[0]);
      demand(body, `the JSON has no body ${row[0]}`);
      reading.are(`${body.name} leaves its seat`, row[1], [body.left_seat_at]);
      reading.are(`${body.name} falls`, row[column(inSpace ? "falls" : "fell")], [body.fell_at]);
      reading.are(`${body.name} slips`, row[column("largest slip")], [100 * body.peak_slip]);
      if (!inSpace) {
        reading.are(`${body.name} falls by`, row[column("fall height")], [body.fall_height]);
        reading.are(`${body.name} at the end`, row[column("at the end")], [100 * body.residual_displacement]);
      }
    }
  });
  for (const { outcome, view } of planes.filter(({ outcome }) => outcome.kind === "collapse" && outcome.barrels_fallen > 1)) {
    const head = shown.heads.find((text) => text.toLowerCase().includes(PLACES[view]));
    const { barrels_fallen: fallen, barrels, time } = outcome;
    const said = head?.match(/(\d.*)$/)?.[1] ?? "";
    if (head && fallen < barrels) reading.are(`outcome ${view}`, said, [fallen, barrels, time]);
  }
  return reading.close();
}

/** The page of a comparison of two stacks. */
export async function ofComparison(page, { paired }) {
  const { headline } = await contents(page), reading = new Reading();
  demand(paired.length > 0, "no run is paired");
  for (const { both, only_first: first, only_second: second, neither, view } of paired) {
    const [from, to, all] = [both + first, both + second, both + first + second + neither];
    const counts = from === to ? [to, all] : [to, all, from];
    const clause = headline.split("; ").find((text) => paired.length === 1 || text.includes(PLACES[view]));
    // A plane in which nothing collapses is not named.
    if (clause || from + to > 0) reading.are(`headline, ${view}`, clause ?? "", counts);
  }
  return reading.close();
}

/** The page of heights. */
export async function ofHeights(page, { heights }) {
  const shown = await contents(page), reading = new Reading();
  const at = (levels, direction, pgv) => heights.find((one) => one.levels === levels && one.direction === direction)
    ?.at.find((one) => Math.abs(one.pgv - pgv) < 1e-9);
  const cells = (table, use) => {
    for (const row of table.rows) {
      table.head.forEach((head, column) => {
        const levels = Number(head.match(/^(\d+) levels$/)?.[1]);
        if (levels) use(row[column], levels, Number(numbersIn(row[0])[0].digits) / 100, `${head} at ${row[0]}`);
      });
    }
  };
  const [worst] = tablesOf(shown, "Chance that a stack");
  cells(worst, (text, levels, pgv, what) => {
    const both = Object.values(VIEWS).map((view) => at(levels, view, pgv)).filter(Boolean);
    const high = Math.max(...both.map(({ interval }) => interval[1]));
    const possible = both.filter(({ interval }) => interval[1] === high);
    const { collapsed, cases, interval } = possible.at(-1);
    reading.are(what, text, percents([collapsed / cases, ...interval]));
  });
  for (const [words, view] of Object.entries(VIEWS)) {
    const [table] = tablesOf(shown, `Collapse under shaking ${words}`);
    cells(table, (text, levels, pgv, what) => {
      const { collapsed, cases } = at(levels, view, pgv);
      reading.are(`${what}, ${words}`, text, [collapsed, cases]);
    });
  }
  const [margins] = tablesOf(shown, "Static margin");
  for (const [levels, pushed, margin] of margins.rows) {
    const { static_margin: value } = heights.find((one) => one.levels === Number(levels) && one.direction === VIEWS[pushed]);
    reading.are(`static margin of ${levels} levels ${pushed}`, margin, [value / GRAVITY]);
  }
  return reading.close();
}

/** The page of a study. */
export async function ofStudy(page, decision) {
  const shown = await contents(page), reading = new Reading();
  isHeadline(shown, decision);
  const [table] = tablesOf(shown, 'Cases that reach the limit state "collapse'), { raw, median, median_interval: interval } = decision.fragility[0];
  reading.are("median in the headline", shown.headline, [median, ...interval].map((value) => 100 * value));
  demand(table.rows.length === raw.length, "the page has other levels than the JSON");
  raw.forEach(({ intensity, cases, failures, interval }, at) => {
    const [level, count, failed, share, wilson] = table.rows[at];
    // Three digits of a velocity in cm/s.
    reading.are("level", level, [100 * intensity]);
    reading.are(`cases at ${level}`, count, [cases]);
    reading.are(`failures at ${level}`, failed, [failures]);
    reading.are(`share at ${level}`, share, percents([failures / cases]));
    reading.are(`interval at ${level}`, wilson, percents(interval));
  });
  return reading.close();
}

/** Finds the rows of a table by the text of their first cells, and the cells of a row by the beginnings of their heads. */
function cellsOf({ head, rows }, name) {
  const row = rows.find(([first]) => first.replace(/^•\s*/, "") === name);
  demand(row, `no row is called ${name}`);
  return (begin, nth = 0) => {
    const columns = head.flatMap((text, at) => (text.startsWith(begin) ? [at] : []));
    demand(columns.length > nth, `no column begins with "${begin}"`);
    return row[columns[nth]];
  };
}

/** A long headline goes on below the picture. */
function isHeadline({ headline, rest }, document) {
  const whole = document.headline === headline || document.headline === `${headline} ${rest}`;
  demand(whole, `the headlines are "${headline} ${rest}" and "${document.headline}"`);
}

/** The page of a ranking of protections. */
export async function ofProtection(page, document) {
  const shown = await contents(page), reading = new Reading();
  isHeadline(shown, document);
  const [table] = tablesOf(shown, "The stack as it is and all");
  demand(table.rows.length === document.protections.length, "the page has other protections than the JSON");
  for (const { name, cost, collapse, barrels_fallen: fallen, barrels_saved: saved, motions } of document.protections) {
    const cell = cellsOf(table, name), ends = ({ mean, low, high }) => [mean, low, high];
    reading.are(`cost of ${name}`, cell("cost"), cost[0] === cost[1] ? [cost[0]] : cost);
    reading.are(`collapse with ${name}`, cell("collapse"), percents(ends(collapse)));
    reading.are(`barrels fallen with ${name}`, cell("barrels fallen"), ends(fallen));
    reading.are(`barrels saved by ${name}`, cell("barrels saved"), saved === null ? [null] : ends(saved));
    reading.are(`motions of ${name}`, cell("motions"), [motions]);
  }
  return reading.close();
}

/** The sheet of a score. */
export async function ofScore(page, { score, velocities, states }) {
  const shown = await contents(page), reading = new Reading();
  reading.are("headline", shown.headline, [score]);
  const [table] = tablesOf(shown, "Velocity at which");
  demand(table.rows.length === states.length, "the sheet has other states than the JSON");
  const first = table.head.findIndex((head) => head.startsWith("at "));
  states.forEach(({ state, direction, velocity, interval, found, collapsed }, at) => {
    const row = table.rows[at];
    demand(row[0] === state && row[1] === PLACES[direction], `row ${at} is that of "${row[0]}", ${row[1]}`);
    if (found === "curve") reading.are(`${state}, ${row[1]}`, row[2], [velocity, ...(interval ?? [])].map((v) => 100 * v));
    collapsed.forEach((share, level) => {
      reading.are("level", table.head[first + level], [100 * velocities[level]]);
      reading.are(`${state}, ${row[1]}, ${table.head[first + level]}`, row[first + level], percents([share]));
    });
  });
  return reading.close();
}

/** The page of a record before and after processing, and the document of the record as written. */
export async function ofMotion(page, { records: [{ channels: [{ measures, duration }] }] }) {
  const shown = await contents(page), reading = new Reading();
  const [table] = tablesOf(shown, "Measures of the motion");
  const after = (name, value) => {
    const row = table.rows.find(([first]) => first === name);
    demand(row, `no row is called ${name}`);
    reading.are(name, row.at(-1), [value]);
  };
  after("length", duration);
  for (const [name, key, unit] of [
    ["PGA", "pga", 1 / GRAVITY], ["PGV", "pgv", 100], ["PGD", "pgd", 100], ["PGV/PGA", "pgv/pga", 1], ["Arias intensity", "arias", 1],
    ["CAV", "cav", 1], ["duration D5-75", "d5-75", 1], ["duration D5-95", "d5-95", 1], ["mean period Tm", "tm", 1],
  ]) after(name, unit * measures[key].value);
  return reading.close();
}

const shareOf = ({ share, interval }) => percents([share, ...interval]);

/** The page of a cellar. */
export async function ofCellar(page, document) {
  const shown = await contents(page), reading = new Reading();
  isHeadline(shown, document);
  const [stacks] = tablesOf(shown, "All stacks"), [aisles] = tablesOf(shown, "Times are counted"), [rows] = tablesOf(shown, "For each row:");
  const times = (found) => (found === null ? [null] : found.least === found.most ? [found.p50] : [found.p05, found.p95]);
  demand(stacks.rows.length === document.stacks.length && rows.rows.length === document.rows.length, "the page has other stacks than the JSON");
  for (const one of document.stacks) {
    const cell = cellsOf(stacks, one.name);
    reading.are(`${one.name} falls`, cell("falls"), shareOf(one.falls));
    reading.are(`${one.name} falls by itself`, cell("by itself"), percents([one.by_itself.share]));
    reading.are(`${one.name} is knocked over`, cell("knocked over"), percents([one.knocked_over.share]));
    reading.are(`${one.name} falls after`, cell("falls after"), times(one.falls_at));
    reading.are(`barrels of ${one.name}`, cell("barrels fallen"), [one.barrels_fallen]);
    reading.are(`wine of ${one.name}`, cell("wine lost"), [1000 * one.wine_lost]);
  }
  for (const one of document.aisles) {
    const cell = cellsOf(aisles, one.name);
    reading.are(`a barrel comes into ${one.name}`, cell("a barrel comes in"), shareOf(one.entered));
    reading.are(`${one.name} is blocked`, cell("blocked at the end"), shareOf(one.blocked));
    reading.are(`${one.name} is blocked after`, cell("blocked after"), times(one.blocked_at));
    reading.are(`first barrel in ${one.name}`, cell("first barrel"), times(one.first_barrel));
  }
  for (const one of document.rows) {
    const cell = cellsOf(rows, String(one.row));
    reading.are(`row ${one.row} starts it`, cell("collapse starts here"), shareOf(one.starts));
    reading.are(`row ${one.row} by itself`, cell("fall by themselves"), [one.by_themselves]);
    reading.are(`row ${one.row} knocked over`, cell("knocked over"), [one.knocked_over]);
  }
  return reading.close();
}

/** The page of layouts of a cellar. */
export async function ofLayouts(page, document) {
  const shown = await contents(page), reading = new Reading();
  isHeadline(shown, document);
  const [loss] = tablesOf(shown, "Loss against capacity"), [ways] = tablesOf(shown, "How the stacks fall");
  const mean = ({ mean, interval }) => [mean, ...(interval && interval[0] < interval[1] ? interval : [])];
  for (const one of document.layouts) {
    const cell = cellsOf(loss, one.name), way = cellsOf(ways, one.name);
    reading.are(`barrels in ${one.name}`, cell("barrels"), [one.capacity]);
    reading.are(`barrels that fall in ${one.name}`, cell("fall"), mean(one.barrels_fallen));
    reading.are(`share that falls in ${one.name}`, cell("share"), percents([one.share_lost.mean]));
    reading.are(`wine lost in ${one.name}`, cell("wine lost"), [1000 * one.wine_lost]);
    reading.are(`cost of ${one.name}`, cell("cost"), one.cost);
    reading.are(`stacks of ${one.name}`, way("stacks"), [one.stacks]);
    reading.are(`by themselves in ${one.name}`, way("fall by themselves"), mean(one.by_themselves));
    reading.are(`knocked over in ${one.name}`, way("knocked over"), mean(one.knocked_over));
  }
  return reading.close();
}

/** The page of aftershocks. */
export async function ofAftershocks(page, document) {
  const shown = await contents(page), reading = new Reading();
  isHeadline(shown, document);
  const [shocks] = tablesOf(shown, "Aftershocks after"), [order] = tablesOf(shown, "Stacks in the order");
  demand(document.inspection.length > 0, "no stack is left to inspect");
  for (const { factor, shock } of document.aftershocks) {
    const cell = cellsOf(shocks, String(factor)), plain = (text) => text.replace("95 % interval", "");
    reading.are(`stand before ${factor}`, cell("stacks standing before"), [shock.stood]);
    reading.are(`fall under ${factor}`, cell("fall by themselves"), [shock.by_themselves]);
    reading.are(`are knocked over under ${factor}`, cell("knocked over"), [shock.knocked_over]);
    reading.are(`survive ${factor}`, plain(cell("survive")), shock.share_survive ? percents([shock.share_survive.mean, ...shock.share_survive.interval]) : [null]);
    reading.are(`all survive ${factor}`, cell("all survive"), shareOf(shock.all_survive));
  }
  document.inspection.forEach(({ name, stands, falls }, at) => {
    demand(order.rows[at][0] === name, `place ${at} is that of ${order.rows[at][0]}`);
    const cell = cellsOf(order, name);
    reading.are(`${name} stands`, cell("stands after"), shareOf(stands));
    falls.forEach((one, k) => reading.are(`${name} falls`, cell(`falls under strength ${document.aftershocks[k].factor}`), shareOf(one)));
  });
  return reading.close();
}

/** The page of a reproduction: its headline counts the rows of its table. */
export async function ofReproduction(page) {
  const shown = await contents(page), reading = new Reading();
  const [{ rows }] = tablesOf(shown, "All numbers and findings");
  const count = (verdict) => rows.filter((row) => row.at(-1) === verdict).length;
  const compared = rows.length - count("not compared");
  const published = rows.filter((row) => !row.includes("not stated")).length;
  const some = compared < published;
  reading.are("headline", shown.headline, some ? [compared, published, count("agrees")] : [count("agrees"), compared]);
  return reading.close();
}
