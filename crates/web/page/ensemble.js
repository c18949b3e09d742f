// All variants of a stack, shared among the engines; what they say so far is told by one of them after each share.

const SHARE = 4; // variants that an engine takes at once: half a second of work for a stack of the catalog
const FEWEST = 8; // variants from which a verdict is stated before all are in

// Numbers in the order in which they are run: the stack as it is stated first, then from both halves in turn, since the
// second half of a stack that is looked at in both planes has the components of the record exchanged.
function orderOf(count) {
  const half = Math.ceil(count / 2), order = [0];
  for (let at = 1; at <= half; at += 1) {
    order.push(at);
    if (half + at <= count) order.push(half + at);
  }
  return order;
}

// Collects results of variants, and asks what they say together; keeps what a report needs where `reports` says so.
function makeTally(desk, cellar, reports) {
  const results = new Map(); // by number, a result in each plane
  const trails = []; // where barrels were, as bytes, for a report
  const planes = () => (results.get(0) || []).length;
  // The results of these numbers, or all that are known, as the engine takes them.
  const given = (some) => {
    const numbers = [...(some ?? results.keys())].sort((a, b) => a - b);
    return { numbers, cases: Array.from({ length: planes() }, (_, plane) => numbers.map((number) => results.get(number)[plane])) };
  };
  return {
    count: () => results.size,
    has: (number) => results.has(number),
    given, trails,
    // Takes an answer about variants, whose numbers may be others here than there.
    add(numbers, answer) {
      const { head, rest } = partsOf(answer);
      numbers.forEach((number, at) => results.set(number, head.map((plane) => plane[at])));
      if (reports) trails.push(rest);
    },
    // The verdict of these numbers, or of all that are known; none before the stack as it is stated is among them.
    async verdict(group, numbers) {
      if (!results.has(0)) return null;
      return jsonOf(await desk.ask(headOf(cellar, "verdict", given(numbers)), { records: cellar.records, urgency: 1, group }));
    },
  };
}

// Runs all variants that a tally has not; after each share `heard` gets the verdict so far, how many results there are, and
// whether that was the last share. There is no verdict of fewer than FEWEST variants while more are to come, and it counts
// those alone that lead the order without a gap: what ends first is no fair sample, since runs that collapse end sooner.
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

  // One verdict at a time, of what is there when it is asked for.
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
