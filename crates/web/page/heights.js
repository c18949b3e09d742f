// How high is safe: stacks of two to six levels under the current motion at six strengths. Each
// cell is run in its variants, the cell with the least certain result first.

const HEIGHTS = [6, 5, 4, 3, 2];
const VELOCITIES = [12, 24, 36, 50, 70, 100]; // cm/s, as in `barrelstack heights`
const CELL = 32; // number of variants after which a cell is finished
const BATCH = 4; // number of variants that are run together
const OTHER = 1e5; // offset between the variant numbers of two motions; exceeds the number of variants
const ENOUGH = 8; // minimum number of variants for coloring a cell, and for conclusions about its neighbors
const FALLS = 0.9, STANDS = 0.05; // minimum share of "falls" and maximum share of "stands", as in a verdict

// Returns the cell to run next, given cells with level, strength, counts and pending runs; none if
// all are finished.
//
// The uncertainty of a cell is the width of its interval. A cell that nearly always falls under
// weaker shaking or with fewer levels is assumed to fall, and a cell that stands under stronger
// shaking or with more levels is assumed to stand, until all other cells are finished.
function nextCell(cells) {
  const sure = (cell) => {
    const beside = (other) => other !== cell && other.run >= ENOUGH;
    const easier = (other) => other.levels <= cell.levels && other.velocity <= cell.velocity;
    const harder = (other) => other.levels >= cell.levels && other.velocity >= cell.velocity;
    return cells.some((other) => beside(other) && ((easier(other) && other.share >= FALLS) || (harder(other) && other.share <= STANDS)));
  };
  const middle = (cell) => -0.01 * (Math.abs(cell.levels - 4) + Math.abs(VELOCITIES.indexOf(cell.velocity) - 2.5));
  const worth = (cell) => cell.width - (sure(cell) ? 1 : 0) - 0.5 * cell.running + middle(cell);
  const open = cells.filter((cell) => !cell.refused && cell.shares.length > 0);
  return open.reduce((best, cell) => (best && worth(best) >= worth(cell) ? best : cell), null);
}

// `motionsOf` returns the motions for a cellar: the current one, or all that the reader gave.
function makeHeights(find, { crew, desk, state, refuse, writers, motionsOf }) {
  let cells = [], going = 0;

  // Returns the known result of a cell, in words and a color.
  function tell(cell) {
    const { place, verdict, refused } = cell;
    if (refused) {
      place.replaceChildren("–", make("small", {}, t("cannot stand")));
      return;
    }
    if (!verdict) return;
    const { collapsed, variants, interval: [low, high], share } = worstOf(verdict).spread;
    // Too few variants get no color.
    place.className = variants < ENOUGH ? "" : share >= FALLS ? "poor" : share <= STANDS ? "good" : "fair";
    place.replaceChildren(t("{1} of {2} fall", collapsed, variants), make("small", {}, t("{1} to {2}", percentOf(low), percentOf(high))));
  }

  function draw(motions) {
    const head = make("tr", {}, make("th", { scope: "col" }, t("levels")), ...VELOCITIES.map((velocity) => {
      const { name } = feels(velocity);
      return make("th", { scope: "col" }, `${velocity} cm/s`, make("br"), make("span", { class: "unit" }, name));
    }));
    const rows = HEIGHTS.map((levels) => make("tr", {}, make("th", { scope: "row" }, String(levels)),
      ...cells.filter((cell) => cell.levels === levels).map(({ place }) => place)));
    const caption = make("caption", {}, make("span", {}, t("Variants that fall in the worse plane, with the 95 % interval of their share; columns: peak ground velocity. Shaken by {1}.", motions.join("; "))));
    find("heights-table").replaceChildren(caption, make("thead", {}, head), make("tbody", {}, ...rows));
    find("heights-table").parentElement.hidden = false;
  }

  function busy(on) {
    find("heights-stop").hidden = !on;
    find("heights-go").hidden = on;
  }

  // Runs the next variants of a cell, under one motion.
  async function runCell(cell, own) {
    const batch = cell.shares.shift();
    cell.asked += batch.numbers.length;
    cell.running += 1;
    try {
      const { cellar, numbers, names } = batch;
      cell.tally.add(names, await crew.ask(headOf(cellar, "variants", { numbers }), { records: cellar.records, group: "heights" }));
      cell.verdict = await cell.tally.verdict("heights");
      if (own !== going || !cell.verdict) return;
      const { spread } = worstOf(cell.verdict);
      Object.assign(cell, { run: spread.variants, share: spread.share ?? 1, width: spread.interval[1] - spread.interval[0] });
    } catch (error) {
      if (error.stopped || error.broken) throw error;
      cell.refused = error.message;
    } finally {
      cell.running -= 1;
    }
    tell(cell);
  }

  // Returns the variants of a cell in shares, one motion after the other. Variants under further
  // motions get numbers of their own, and the nominal case counts once.
  function sharesOf(cellars, count) {
    const order = orderOf(count), shares = [];
    const each = Math.min(Math.ceil(CELL / cellars.length), count);
    for (let at = 0; at <= each; at += BATCH) {
      cellars.forEach((cellar, motion) => {
        const numbers = order.slice(Math.max(at, motion > 0 ? 1 : 0), Math.min(at + BATCH, each + 1));
        if (numbers.length > 0) shares.push({ cellar, numbers, names: numbers.map((number) => number + OTHER * motion) });
      });
    }
    return shares;
  }

  // Returns the resolved cellar under each of the motions.
  async function underEach(cellar, look) {
    const motions = motionsOf(cellar);
    if (motions.length < 2) return [{ cellar, look }];
    return Promise.all(motions.map(async (motion) => {
      const shaken = shakenBy(cellar, motion);
      return { cellar: shaken, look: jsonOf(await desk.ask(headOf(shaken, "look"), { records: shaken.records, urgency: 1, group: "heights" })) };
    }));
  }

  // Returns a cellar with a number of levels, its motion scaled to a peak velocity by one factor
  // for all components, like the slider.
  function cellAt({ cellar, look }, levels, velocity) {
    const one = copied(cellar), values = valuesOf(look);
    writers.levels(one, levels, look);
    if (values["motion.scale.pgv"] !== undefined) one.changes["motion.scale.pgv"] = `"${velocity} cm/s"`;
    else {
      const factor = Number(values["motion.scale.factor"] ?? 1);
      one.changes["motion.scale.factor"] = String(Number(((factor * velocity) / (100 * look.checked[0].motion.pgv)).toPrecision(6)));
    }
    return one;
  }

  async function go() {
    const { cellar, look } = state();
    if (valuesOf(look)["stack.levels"] === undefined || !look.checked[0].motion) return refuse(new Error(t("this computation needs a stack and a ground motion")));
    const own = (going += 1);
    busy(true);
    try {
      const under = await underEach(cellar, look);
      cells = HEIGHTS.flatMap((levels) => VELOCITIES.map((velocity) => {
        const cellars = under.map((one) => cellAt(one, levels, velocity));
        const shares = sharesOf(cellars, look.variants), all = shares.reduce((sum, { numbers }) => sum + numbers.length, 0);
        return { levels, velocity, shares, all, asked: 0, running: 0, run: 0, share: 0.5, width: 1, tally: makeTally(desk, cellars[0]), verdict: null, place: make("td", {}, "…") };
      }));
      draw(under.map((one) => one.look.checked[0].motion.name));
      window.barrelstack.heights = cells;
      const line = async () => {
        for (let cell = nextCell(cells); cell && own === going; cell = nextCell(cells)) {
          await runCell(cell, own);
          const sum = (of) => cells.reduce((sum, cell) => sum + cell[of], 0);
          find("heights-said").textContent = sum("asked") < sum("all") ? t("{1} done", percentOf(sum("asked") / sum("all"))) : "";
        }
      };
      await Promise.all(Array.from({ length: crew.most }, line));
      if (own === going) find("heights-said").textContent = safest();
    } catch (error) {
      if (!error.stopped) refuse(error);
    }
    if (own === going) busy(false);
  }

  // Returns the highest stack that stands, for each strength at which one does.
  function safest() {
    const stands = (velocity) => HEIGHTS.find((levels) => cells.filter((cell) => cell.velocity === velocity && cell.levels <= levels).every((cell) => cell.share <= STANDS && !cell.refused));
    const parts = VELOCITIES.filter(stands).map((velocity) => t("{1} levels withstand {2} cm/s", stands(velocity), velocity));
    return parts.length > 0 ? `${parts.join(", ")}.` : t("None of these stacks stands even under the weakest of these motions.");
  }

  find("heights-go").addEventListener("click", go);
  find("heights-stop").addEventListener("click", () => {
    going += 1;
    crew.stop("heights");
    desk.stop("heights");
    busy(false);
    find("heights-said").textContent = t("stopped");
  });
}
