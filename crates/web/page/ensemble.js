// All variants of a stack, shared among the engines; after each share, one engine combines the
// results so far.

const SHARE = 4; // number of variants that an engine takes at a time: half a second of work for a stack of the catalog
const FEWEST = 8; // minimum number of variants for a verdict before all have finished

// Returns the variant numbers in running order: the nominal case first, then alternately from both
// halves, because in both planes the second half has the components of the record exchanged.
function orderOf(count) {
  const half = Math.ceil(count / 2), order = [0];
  for (let at = 1; at <= half; at += 1) {
    order.push(at);
    if (half + at <= count) order.push(half + at);
  }
  return order;
}

// Collects results of variants and requests their combined verdict; if `reports` is set, keeps the
// data that a report needs.
function makeTally(desk, cellar, reports) {
  const results = new Map(); // by variant number, the results in each plane
  const trails = []; // trails of the barrels, as bytes, for a report
  const planes = () => (results.get(0) || []).length;
  // Returns the results of the given numbers, or all known results, in the form that the engine
  // reads.
  const given = (some) => {
    const numbers = [...(some ?? results.keys())].sort((a, b) => a - b);
    return { numbers, cases: Array.from({ length: planes() }, (_, plane) => numbers.map((number) => results.get(number)[plane])) };
  };
  return {
    count: () => results.size,
    has: (number) => results.has(number),
    given, trails,
    // Adds an answer about variants, whose numbers in this tally may differ from those in the
    // answer.
    add(numbers, answer) {
      const { head, rest } = partsOf(answer);
      numbers.forEach((number, at) => results.set(number, head.map((plane) => plane[at])));
      if (reports) trails.push(rest);
    },
    // Returns the verdict of the given numbers, or of all known ones; none until the nominal case
    // is among them.
    async verdict(group, numbers) {
      if (!results.has(0)) return null;
      return jsonOf(await desk.ask(headOf(cellar, "verdict", given(numbers)), { records: cellar.records, urgency: 1, group }));
    },
  };
}

// Runs all variants that a tally lacks. After each share, `heard` receives the verdict so far, the
// number of results, and whether this was the last share.
//
// There is no verdict of fewer than FEWEST variants while more are to come. A verdict counts only
// the variants that lead the order without a gap: those that finish first are not a fair sample,
// because runs that collapse end sooner.
async function runAll({ crew, cellar, tally, count, group, heard }) {
  const whole = orderOf(count), order = whole.filter((number) => !tally.has(number));
  const leading = () => {
    const gap = whole.findIndex((number) => !tally.has(number));
    return gap < 0 ? whole : whole.slice(0, gap);
  };
  const shares = [];
  for (let at = 0; at < order.length; at += SHARE) shares.push(order.slice(at, at + SHARE));
  if (shares.length === 0) return heard(await tally.verdict(group), tally.count(), true);
  let asking = false, behind = false, left = shares.length, ended;
  const all = new Promise((resolve, reject) => { ended = { resolve, reject }; });

  // One verdict at a time, of the results available when it is requested.
  async function tell() {
    if (asking) {
      behind = true;
      return;
    }
    asking = true;
    do {
      behind = false;
      const last = left === 0;
      const numbers = leading();
      const verdict = last || numbers.length > FEWEST ? await tally.verdict(group, numbers) : null;
      if (tally.has(0)) heard(verdict, tally.count(), last);
      if (last) ended.resolve();
    } while (behind);
    asking = false;
  }

  for (const numbers of shares) {
    crew.ask(headOf(cellar, "variants", { numbers }), { records: cellar.records, group }).then((answer) => {
      tally.add(numbers, answer);
      left -= 1;
      return tell();
    }).catch(ended.reject);
  }
  return all;
}
