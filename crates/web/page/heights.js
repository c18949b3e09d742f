// How high is safe: stacks of two to six levels under the motion at hand at six strengths, each cell by its variants, the
// cell about which least is known first.

const HEIGHTS = [6, 5, 4, 3, 2];
const VELOCITIES = [12, 24, 36, 50, 70, 100]; // cm/s, as in `barrelstack heights`
const CELL = 32; // variants after which a cell is done
const BATCH = 4; // that are run at once
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
  const open = cells.filter((cell) => !cell.refused && cell.asked < cell.order.length);
  return open.reduce((best, cell) => (best && worth(best) >= worth(cell) ? best : cell), null);
}

function makeHeights(find, { crew, desk, state, refuse }) {
  let cells = [], going = 0;

  // What is known of a cell, in words and a color.
  function tell(cell) {
    const { place, verdict, refused } = cell;
    if (refused) {
      place.replaceChildren("–", make("small", {}, "cannot stand"));
      return;
    }
    if (!verdict) return;
    const [worst] = [...verdict.planes].sort((a, b) => (b.spread.share ?? -1) - (a.spread.share ?? -1));
    const { collapsed, variants, interval: [low, high], share } = worst.spread;
    // A few say little.
    place.className = variants < ENOUGH ? "" : share >= FALLS ? "poor" : share <= STANDS ? "good" : "fair";
    place.replaceChildren(`${collapsed} of ${variants} fall`, make("small", {}, `${percentOf(low)} to ${percentOf(high)}`));
  }

  function draw() {
    const head = make("tr", {}, make("th", { scope: "col" }, "levels"), ...VELOCITIES.map((velocity) => {
      const { name } = feels(velocity);
      return make("th", { scope: "col" }, `${velocity} cm/s`, make("br"), make("span", { class: "unit" }, name));
    }));
    const rows = HEIGHTS.map((levels) => make("tr", {}, make("th", { scope: "row" }, String(levels)),
      ...cells.filter((cell) => cell.levels === levels).map(({ place }) => place)));
    const caption = make("caption", {}, make("span", {}, "Variants of a stack that fall in the worse plane, with the 95 % interval of the share of all such stacks; across: peak ground velocity."));
    find("heights-table").replaceChildren(caption, make("thead", {}, head), make("tbody", {}, ...rows));
    find("heights-table").parentElement.hidden = false;
  }

  function busy(on) {
    find("heights-stop").hidden = !on;
    find("heights-go").hidden = on;
  }

  async function runCell(cell, own) {
    const numbers = cell.order.slice(cell.asked, cell.asked + BATCH);
    cell.asked += numbers.length;
    cell.running += 1;
    try {
      const answer = await crew.ask(headOf(cell.cellar, "variants", { numbers }), { records: cell.cellar.records, group: "heights" });
      cell.tally.add(numbers, jsonOf(answer));
      cell.verdict = await cell.tally.verdict("heights");
      if (own !== going) return;
      const shares = cell.verdict.planes.map(({ spread }) => spread);
      const worst = shares.reduce((a, b) => ((b.share ?? -1) > (a.share ?? -1) ? b : a));
      Object.assign(cell, { run: worst.variants, share: worst.share ?? 1, width: worst.interval[1] - worst.interval[0] });
    } catch (error) {
      if (error.stopped || error.broken) throw error;
      cell.refused = error.message;
    } finally {
      cell.running -= 1;
    }
    tell(cell);
  }

  async function go() {
    const { cellar, look } = state();
    const values = valuesOf(look), motion = look.checked[0].motion;
    if (values["stack.levels"] === undefined || !motion) return refuse(new Error("heights need a stack, and a motion that shakes it"));
    const own = (going += 1);
    const strapped = Number(values["stack.strap.levels"] || 0) > 0;
    const factor = Number(values["motion.scale.factor"] ?? 1);
    cells = HEIGHTS.flatMap((levels) => VELOCITIES.map((velocity) => {
      const one = copied(cellar);
      one.changes["stack.levels"] = String(levels);
      if (strapped) one.changes["stack.strap"] = `{ levels = ${levels}, ties = "${values["stack.strap.ties"]}", pretension = "${values["stack.strap.pretension"]}" }`;
      // One factor for all components, as the slider has it.
      if (values["motion.scale.pgv"] !== undefined) one.changes["motion.scale.pgv"] = `"${velocity} cm/s"`;
      else one.changes["motion.scale.factor"] = String(Number(((factor * velocity) / (100 * motion.pgv)).toPrecision(6)));
      const order = orderOf(look.variants).slice(0, CELL + 1);
      return { levels, velocity, cellar: one, order, asked: 0, running: 0, run: 0, share: 0.5, width: 1, tally: makeTally(desk, one), verdict: null, place: make("td", {}, "…") };
    }));
    draw();
    busy(true);
    window.barrelstack.heights = cells;
    const line = async () => {
      for (let cell = nextCell(cells); cell && own === going; cell = nextCell(cells)) {
        await runCell(cell, own);
        const done = cells.reduce((sum, { asked }) => sum + asked, 0), all = cells.reduce((sum, { order }) => sum + order.length, 0);
        find("heights-said").textContent = done < all ? `${percentOf(done / all)} done` : "";
      }
    };
    try {
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
