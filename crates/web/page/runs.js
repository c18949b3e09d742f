// Runs: the stack in motion, the results of its variants as they arrive, and the earlier runs.

const SLOW = 60; // duration (s) above which a run is announced
const KEPT = 4; // number of runs whose pictures and results are kept
const LISTED = 24; // number of runs in the list

// `state` is { cellar, look }, where `look` is the resolved cellar; `apply` makes a cellar the
// current one; `devices` shows the devices of a run.
function makeRuns(find, { crew, desk, picture, state, apply, change, refuse, controls, devices }) {
  const past = [];
  let now = null; // the run that is shown
  let cost = 4e-7; // time (s) of a step of a body, as measured
  let marks = {}; // times (ms) of milestones, for measurements

  const lasts = (look, variants) => (cost * look.work * variants) / crew.most;

  // Announces the expected duration of a long run.
  function forecast(look) {
    const due = lasts(look, look.variants + 1), slow = due > SLOW;
    find("costs").hidden = !slow;
    find("costs").textContent = slow ? t("This takes about {1} on this computer; the first picture comes after about {2}.", lasting(due), lasting(cost * look.work)) : "";
  }

  function busy(on) {
    find("stop").hidden = !on;
    find("progress").hidden = !on;
    find("go").textContent = on ? t("Shake it again") : t("Shake it");
  }

  // Stopped work has no verdict.
  function stop() {
    crew.stop("run");
    desk.stop("run");
    busy(false);
    if (now && !now.done) Object.assign(now, { stopped: true, verdict: null });
  }

  const previous = () => past[past.indexOf(now) - 1];

  function tell(run) {
    const before = past[past.indexOf(run) - 1];
    const cards = [];
    // The picture keeps its place when text appears.
    const { variants } = run.look, done = Math.max(run.tally ? run.tally.count() - 1 : 0, 0);
    const waits = run.stopped ? t("Stopped after {1} of {2} variants, so there is no verdict.", done, variants) : t("Shaking the stack and {1} variants of it.", variants);
    if (!run.verdict && variants > 0) cards.push(make("div", { class: "card waits" }, make("p", { class: "when" }, run.label), make("p", { class: "headline" }, waits)));
    const label = run.done ? run.label : t("{1}, variants so far", run.label);
    if (run.verdict) cards.push(cardOf(run.verdict, before ? t("now: {1}", label) : label, false));
    if (run.verdict && before && before.verdict) cards.push(cardOf(before.verdict, t("before: {1}", before.label), true));
    find("verdicts").replaceChildren(...cards);
    find("sentences").textContent = run.shown ? run.shown.sentences.slice(run.verdict ? 1 : 0).join(" ") : "";
    const warnings = run.shown ? run.shown.warnings : [];
    find("warnings").hidden = warnings.length === 0;
    find("warnings").replaceChildren(...warnings.map((text) => make("li", {}, text)));
    offerWhich(run);
    offerChanges(run);
    list();
  }

  // Offers the notable runs of an ensemble.
  function offerWhich(run) {
    const box = find("which");
    box.hidden = !(run.done && run.verdict && run.verdict.planes.length > 0);
    if (box.hidden) return;
    const { typical, gentlest, worst } = run.verdict.planes[0].spread;
    const offers = new Map([[0, t("the stack as you chose it")]]);
    for (const [one, name] of [[typical, t("the most typical variant")], [gentlest, t("the gentlest")], [worst, t("the worst")]]) {
      offers.set(one, offers.has(one) ? `${offers.get(one)}, ${name}` : name);
    }
    box.replaceChildren(make("span", {}, t("You see")), ...[...offers].map(([one, name]) => {
      const button = make("button", { type: "button", class: "tool", "aria-pressed": String(run.shown && run.shown.variant === one) }, name);
      button.addEventListener("click", () => show(run, one).then(() => tell(run)).catch(refuse));
      return button;
    }));
  }

  // Offers single changes to the reader.
  function offerChanges(run) {
    const values = valuesOf(run.look), levels = Number(values["stack.levels"] || 0);
    find("next").hidden = !run.shown || levels === 0;
    if (find("next").hidden) return devices.hide();
    const { writers } = controls;
    const velocity = run.look.checked[0].motion ? 100 * run.look.checked[0].motion.pgv : 0;
    const offers = [
      [levels > 1, t("One level less"), (cellar) => writers.levels(cellar, levels - 1)],
      [levels < 12, t("One level more"), (cellar) => writers.levels(cellar, levels + 1)],
      [values["stack.rack.base"] !== "rack-on-rack", t("Racks on posts"), (cellar) => { cellar.changes["stack.rack"] = '"rack-on-rack"'; }],
      [velocity > 0, t("Half the shaking"), (cellar) => writers.strength(cellar, velocity / 2)],
    ];
    find("changes").replaceChildren(...offers.filter(([fits]) => fits).map(([, name, write]) => {
      const button = make("button", { type: "button", class: "tool" }, name);
      button.addEventListener("click", () => change(write, true));
      return button;
    }));
    devices.show(run);
  }

  function list() {
    find("past").hidden = past.length < 2;
    find("undo").disabled = !previous();
    find("history").replaceChildren(...past.map((run) => {
      const button = make("button", { type: "button" }, make("span", {}, run.label), make("span", {}, run.verdict ? run.done ? briefly(run.verdict) : t("{1} so far", briefly(run.verdict)) : run.stopped ? t("stopped") : run.done ? t("shaken once") : t("being shaken")));
      if (run === now) button.setAttribute("aria-current", "true");
      button.addEventListener("click", () => back(run));
      return make("li", {}, button);
    }).reverse());
  }

  // Shows an earlier run again and makes its scenario the current one.
  async function back(run) {
    stop();
    now = run;
    await apply(copied(run.cellar), run.look);
    tell(run);
    if (run.shown && run.shown.stage) await picture.put(run.shown.stage, {});
    else await show(run, run.shown ? run.shown.variant : 0).catch(refuse);
  }

  // Shows a variant in motion: first its opening, then the whole run.
  async function show(run, variant) {
    const { cellar, look } = run, first = !run.shown;
    const asked = (shorter) => crew.ask(headOf({ ...cellar, changes: { ...cellar.changes, ...shorter } }, "show", { numbers: [variant] }), {
      records: cellar.records, urgency: shorter ? 3 : 2, group: "run", draws: true,
      told: (done, of) => { if (!run.shown) find("sofar").textContent = t("shaking the stack: {1}", percentOf(done / of)); },
    });
    const put = async (answer, options) => {
      const shown = jsonOf(answer);
      if (run === now) await picture.put(shown.stage, options);
      return shown;
    };
    const long = look.opening !== null && look.checked[0].motion.duration > 2 * look.opening && valuesOf(look)["run.duration"] === undefined;
    const whole = asked();
    let opened = false;
    if (first && long) {
      const opening = asked({ "run.duration": `"${look.opening} s"` }).catch(() => null);
      const there = await Promise.race([opening, whole.then(() => null)]);
      if (there && run === now) {
        await put(there, { ghost: past.length > 1 });
        opened = true;
        marks.moved = performance.now();
      }
    }
    const answer = await whole;
    cost = answer.took / 1000 / Math.max(look.work, 1);
    run.shown = await put(answer, opened ? { ghost: past.length > 1, goesOn: true } : { ghost: first && past.length > 1 });
    if (run === now && !opened) marks.moved = performance.now();
    // The oldest runs keep only their texts.
    const full = past.filter((one) => one !== run && one !== now && one.shown && one.shown.stage);
    for (const one of full.slice(0, Math.max(full.length + 1 - KEPT, 0))) one.shown.stage = one.tally = null;
  }

  // Returns the known results of the variants of a cellar: those of the shown run, if it is of that
  // cellar.
  function tallyOf(cellar) {
    const same = now && now.tally && keyOf(now.cellar) === keyOf(cellar) && now.cellar.records.every((record, at) => record === cellar.records[at]);
    return same ? now.tally : makeTally(desk, cellar, true);
  }

  // Starts a run of the current cellar and returns it.
  function run() {
    stop();
    const { look } = state(), cellar = copied(state().cellar);
    const mine = { cellar, look, label: labelOf(look), verdict: null, shown: null, done: false, tally: makeTally(desk, cellar, true) };
    // A run that was stopped before it was shown is forgotten.
    const at = past.indexOf(now), seen = Boolean(now && now.shown);
    past.splice(seen ? at + 1 : Math.max(at, 0), now && !seen ? 1 : 0, mine);
    if (past.length > LISTED) past.splice(past[0] === now ? 1 : 0, 1);
    now = mine;
    busy(true);
    const from = performance.now();
    marks = { from };
    window.barrelstack.marks = marks;
    find("bar").value = 0;
    find("sofar").textContent = t("shaking the stack");
    tell(mine);
    // On a phone the stack is below the choices.
    if (find("result").getBoundingClientRect().top > 0.5 * window.innerHeight) find("result").scrollIntoView({ block: "start" });
    follow(mine);
    return mine;
  }

  // Shows a run and the results of its variants, until all are finished.
  async function follow(mine) {
    const { cellar, look } = mine;
    const heard = (verdict, count, last) => {
      mine.verdict = verdict;
      mine.done = last;
      if (mine !== now) return;
      marks.variants = count - 1;
      marks.last = performance.now();
      const of = look.variants;
      find("bar").value = count / (of + 1);
      find("sofar").textContent = t("{1} of {2} variants so far", count - 1, of);
      tell(mine);
    };
    try {
      const showing = show(mine, 0).then(() => tell(mine));
      const varying = look.variants > 0 ? runAll({ crew, cellar, tally: mine.tally, count: look.variants, group: "run", heard }) : null;
      await Promise.all([showing, varying]);
      mine.done = true;
      const typical = mine.verdict && mine.verdict.planes[0] ? mine.verdict.planes[0].spread.typical : 0;
      // The nominal case may behave unlike nearly all variants.
      const collapses = mine.shown.outcomes.some(({ kind }) => kind === "collapse");
      if (mine.verdict && collapses !== (mine.verdict.tone === "falls") && typical !== 0) await show(mine, typical);
      if (mine === now) {
        busy(false);
        tell(mine);
        find("said").textContent = mine.verdict ? mine.verdict.headline : mine.shown.sentences[0];
      }
    } catch (error) {
      if (error.stopped) return;
      stop();
      refuse(error);
    }
  }

  find("ask").addEventListener("submit", (event) => {
    event.preventDefault();
    run();
  });
  find("stop").addEventListener("click", () => {
    stop();
    if (now) tell(now);
  });
  find("undo").addEventListener("click", () => { if (previous()) back(previous()); });
  return { run, stop, forecast, lasts, tallyOf, past: () => past, now: () => now };
}
