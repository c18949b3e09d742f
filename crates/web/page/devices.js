// Devices that could be added to the stack, each with its effect compared with the stack without
// it.

const GLANCE = 8; // number of variants for a first estimate of the effect of a device

// Returns the plane in which most variants fall.
const worstOf = (verdict) => verdict.planes.reduce((a, b) => ((b.spread.share ?? -1) > (a.spread.share ?? -1) ? b : a));

// `lasts` returns the expected duration (s) of a number of variants of a stack.
function makeDevices(find, { crew, desk, change, writers, states, refuse, lasts }) {
  let now = null, going = 0; // the run whose devices are shown, and the number of estimates started

  const group = "devices";
  const tableOf = (changes) => changes[0].split(".")[1];
  const tell = (verdict) => {
    const { collapsed, variants } = worstOf(verdict).spread;
    return t("{1} of {2} fall", collapsed, variants);
  };

  const unknown = ({ glance, run, refused }) => !glance && !run && !refused;

  // Returns the known effect of a device, from a run with it or from a first estimate.
  function effectOf(candidate) {
    if (candidate.refused) return t("does not fit this stack");
    if (candidate.run && candidate.run.verdict) return tell(candidate.run.verdict);
    if (candidate.glance) return tell(candidate.glance);
    return candidate.running ? "…" : "";
  }

  function row(candidate) {
    const button = make("button", { type: "button", class: "tool" }, t("Try it"));
    button.setAttribute("aria-label", t("Try it: {1}", candidate.name));
    button.addEventListener("click", async () => {
      candidate.run = await change((cellar) => writers.device(cellar, tableOf(candidate.changes), candidate.changes), true);
    });
    candidate.place = make("td", {}, effectOf(candidate));
    return make("tr", {}, make("th", { scope: "row" }, candidate.name), candidate.place, make("td", {}, button));
  }

  function draw() {
    const { present, candidates } = now.devices;
    find("off").replaceChildren(...present.filter(({ table }) => removable(table)).map(({ name, table }) => {
      const button = make("button", { type: "button", class: "tool" }, t("Without the {1}", name));
      button.addEventListener("click", () => change((cellar) => writers.device(cellar, table, Number(states(`stack.${table}.levels`) || 0) > 0 ? [`stack.${table}.levels=0`] : []), true));
      return button;
    }));
    const head = make("tr", {}, ...[t("device"), t("with it"), ""].map((name) => (name ? make("th", { scope: "col" }, name) : make("td"))));
    const plain = make("tr", {}, make("th", { scope: "row" }, t("none (the stack as it is)")), make("td", {}, now.verdict && now.verdict.planes.length > 0 ? tell(now.verdict) : ""), make("td"));
    find("devices").replaceChildren(make("thead", {}, head), make("tbody", {}, plain, ...candidates.map(row)));
    find("devices-box").hidden = candidates.length === 0 && present.length === 0;
    const open = candidates.filter(unknown).length;
    find("devices-go").disabled = open === 0;
    if (open > 0) find("devices-said").textContent = t("{1} devices in {2} variants each: about {3}", open, GLANCE, lasting(lasts(now.look, open * (GLANCE + 1))));
  }

  // Whether a device can be removed by leaving out changes, or by setting its number of levels.
  const removable = (table) => states(`stack.${table}.levels`) !== undefined || Object.keys(now.cellar.changes).some((path) => path.startsWith(`stack.${table}`));

  // Shows the devices of a run; the engine is asked when it has nothing else to do.
  async function show(run) {
    if (now !== run) {
      stop();
      find("devices-box").hidden = true;
    }
    now = run;
    if (!run.devices) {
      if (!(run.done || run.stopped) || run.asking) return;
      run.asking = true;
      try {
        // A reader who goes on at once does not need the devices.
        await new Promise((next) => setTimeout(next, 300));
        if (run !== now) return;
        run.devices = jsonOf(await desk.ask(headOf(run.cellar, "devices"), { records: run.cellar.records }));
      } catch (error) {
        if (!error.stopped) refuse(error);
        return;
      } finally {
        run.asking = false;
      }
    }
    if (run === now) draw();
  }

  // Runs a few variants with each device, shared among all engines.
  async function glance() {
    const own = (going += 1), { cellar, look, devices: { candidates } } = now;
    const numbers = orderOf(look.variants).slice(0, GLANCE + 1);
    busy(true);
    let done = 0;
    const one = async (candidate) => {
      const tried = copied(cellar);
      writers.device(tried, tableOf(candidate.changes), candidate.changes);
      const tally = makeTally(desk, tried);
      candidate.running = true;
      try {
        tally.add(numbers, await crew.ask(headOf(tried, "variants", { numbers }), { records: tried.records, group }));
        candidate.glance = await tally.verdict(group);
      } catch (error) {
        if (error.stopped || error.broken) throw error;
        candidate.refused = error.message;
      } finally {
        candidate.running = false;
      }
      if (own !== going) return;
      candidate.place.textContent = effectOf(candidate);
      find("devices-said").textContent = t("{1} of {2} devices tried", (done += 1), candidates.length);
    };
    try {
      await Promise.all(candidates.filter(unknown).map(one));
      if (own === going) find("devices-said").textContent = t("Each device was run in {1} variants only; try a device to run all variants with it.", GLANCE);
    } catch (error) {
      if (!error.stopped) refuse(error);
    }
    if (own === going) busy(false);
  }

  function busy(on) {
    find("devices-stop").hidden = !on;
    find("devices-go").hidden = on;
  }

  function stop() {
    going += 1;
    crew.stop(group);
    desk.stop(group);
    busy(false);
    find("devices-said").textContent = "";
  }

  find("devices-go").addEventListener("click", glance);
  find("devices-stop").addEventListener("click", stop);
  return { show, hide: () => { find("devices-box").hidden = true; } };
}
