// How high is safe: stacks of two to six levels under the motion at hand at six strengths, each cell by its variants, the
// cell about which least is known first.

const HEIGHTS = [6, 5, 4, 3, 2];
const VELOCITIES = [12, 24, 36, 50, 70, 100]; // cm/s, as in `barrelstack heights`
const CELL = 32; // variants after which a cell is done
const BATCH = 4; // that are run at once
const OTHER = 1e5; // more than there are variants, between numbers of two motions
const ENOUGH = 8; // variants from which a cell is colored, and its neighbors are taken to be like it
const FALLS = 0.9, STANDS = 0.05; // shares from and up to which a cell is said to fall and to stand, as in a verdict

// Of cells, each with its level, its strength, its counts and what runs of it, the one to run next; none when all are done.
//
// What is known of a cell is the width of its interval. One that weaker shaking or a lower stack fells nearly always is
// taken to fall, and one that stronger shaking or a higher stack leaves standing to stand, until all others are done.
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

// `motionsOf` gives the motions for a cellar: that at hand, or all that the reader gave.
function makeHeights(find, { crew, desk, state, refuse, writers, motionsOf }) {
  let cells = [], going = 0;

  // What is known of a cell, in words and a color.
  function tell(cell) {
    const { place, verdict, refused } = cell;
    if (refused) {
      place.replaceChildren("–", make("small", {}, "cannot stand"));
      return;
    }
    if (!verdict) return;
    const { collapsed, variants, interval: [low, high], share } = worstOf(verdict).spread;
    // A few say little.
    place.className = variants < ENOUGH ? "" : share >= FALLS ? "poor" : share <= STANDS ? "good" : "fair";
    place.replaceChildren(`${collapsed} of ${variants} fall`, make("small", {}, `${percentOf(low)} to ${percentOf(high)}`));
  }

  function draw(motions) {
    const head = make("tr", {}, make("th", { scope: "col" }, "levels"), ...VELOCITIES.map((velocity) => {
      const { name } = feels(velocity);
      return make("th", { scope: "col" }, `${velocity} cm/s`, make("br"), make("span", { class: "unit" }, name));
    }));
    const rows = HEIGHTS.map((levels) => make("tr", {}, make("th", { scope: "row" }, String(levels)),
      ...cells.filter((cell) => cell.levels === levels).map(({ place }) => place)));
    const caption = make("caption", {}, make("span", {}, `Variants of a stack that fall in the worse plane, with the 95 % interval of the share of all such stacks; across: peak ground velocity. Shaken by ${motions.join("; ")}.`));
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

  // The variants of a cell in shares, of one motion after the other; numbers of other motions than the first get names of
  // their own, and the stack as it is stated counts once.
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

  // What the engine says of the cellar under each of the motions.
  async function underEach(cellar, look) {
    const motions = motionsOf(cellar);
    if (motions.length < 2) return [{ cellar, look }];
    return Promise.all(motions.map(async (motion) => {
      const shaken = shakenBy(cellar, motion);
      return { cellar: shaken, look: jsonOf(await desk.ask(headOf(shaken, "look"), { records: shaken.records, urgency: 1, group: "heights" })) };
    }));
  }

  // A cellar of so many levels, its motion brought to a peak velocity; one factor for all components, as the slider has it.
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
    if (valuesOf(look)["stack.levels"] === undefined || !look.checked[0].motion) return refuse(new Error("heights need a stack, and a motion that shakes it"));
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
          find("heights-said").textContent = sum("asked") < sum("all") ? `${percentOf(sum("asked") / sum("all"))} done` : "";
        }
      };
      await Promise.all(Array.from({ length: crew.most }, line));
      if (own === going) find("heights-said").textContent = safest();
    } catch (error) {
      if (!error.stopped) refuse(error);
    }
    if (own === going) busy(false);
  }

  // The highest stack that stands, for each strength at which one does.
  function safest() {
    const stands = (velocity) => HEIGHTS.find((levels) => cells.filter((cell) => cell.velocity === velocity && cell.levels <= levels).every((cell) => cell.share <= STANDS && !cell.refused));
    const parts = VELOCITIES.filter(stands).map((velocity) => `${stands(velocity)} levels stand ${velocity} cm/s`);
    return parts.length > 0 ? `${parts.join(", ")}.` : "None of these stands even the weakest of these.";
  }

  find("heights-go").addEventListener("click", go);
  find("heights-stop").addEventListener("click", () => {
    going += 1;
    crew.stop("heights");
    desk.stop("heights");
    busy(false);
    find("heights-said").textContent = "stopped";
  });
}
