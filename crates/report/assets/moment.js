// The opening of a player: a slow loop around the decisive moment; a still picture for readers who
// prefer reduced motion.

const BEFORE = 0.5, AFTER = 1.0; // extent of the loop before and after the moment (s of the run)
const SLOW = 0.25; // speed of the loop
const HOLD = 0.9; // time for which the last picture is held (s)

// `show` draws a time of the run; `marked` receives whether the loop runs.
function makeLoop(screen, time, [start, end], show, marked) {
  const from = Math.max(time - BEFORE, start), to = Math.min(time + AFTER, end);
  const whole = (to - from) / SLOW + HOLD;
  let looping = false, request = 0, since = 0, seen = true;

  function tick(now) {
    const passed = ((now - since) / 1000) % whole;
    show(Math.min(from + passed * SLOW, to));
    request = looping && seen ? requestAnimationFrame(tick) : 0;
  }
  function run() {
    looping = true;
    since = performance.now();
    if (!request) request = requestAnimationFrame(tick);
    marked(true);
  }
  function stop() {
    if (!looping) return;
    looping = false;
    cancelAnimationFrame(request);
    request = 0;
    marked(false);
  }
  // The loop stops while it is out of sight. A player removed from the page is no longer observed,
  // because an observer keeps its targets alive.
  const watch = new IntersectionObserver(([entry]) => {
    seen = entry.isIntersecting;
    if (!screen.isConnected) watch.disconnect();
    if (seen && looping && !request) request = requestAnimationFrame(tick);
  });
  watch.observe(screen);
  return { run, stop, isLooping: () => looping, from, to };
}
