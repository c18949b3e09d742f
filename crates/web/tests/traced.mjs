// What the thread of a page works on: its tasks, by the time of the processor that each takes, which other programs on
// the machine do not change.

/** Does something with a page under Chromium's trace; gives the tasks of its thread (ms of processor time), in order. */
export async function traced(page, use) {
  const session = await page.context().newCDPSession(page);
  const events = [];
  session.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  await session.send("Tracing.start", { transferMode: "ReportEvents", traceConfig: { includedCategories: ["toplevel", "blink.user_timing"] } });
  const result = await use();
  const complete = new Promise((done) => { session.once("Tracing.tracingComplete", done); });
  await session.send("Tracing.end");
  await complete;
  await session.detach();
  const main = events.filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain");
  const tasks = ({ pid, tid }) => events.filter((one) => one.ph === "X" && one.pid === pid && one.tid === tid && one.name.endsWith("RunTask") && one.tdur !== undefined);
  // Of several pages the one that works.
  const sum = (list) => list.reduce((all, { tdur }) => all + tdur, 0);
  const busiest = main.map(tasks).reduce((a, b) => (sum(b) > sum(a) ? b : a), []);
  return { tasks: busiest.map(({ tdur }) => tdur / 1000), marks: events.filter(({ cat }) => cat === "blink.user_timing"), result };
}
