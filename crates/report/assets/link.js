// Links to an instant: the address of the page ends in #t=6.5 if its player is at 6.5 s.

// Returns the time (s) in the address; none if the address has another fragment or none.
function linkedTime() {
  const found = /^#t=(\d+(?:\.\d+)?)$/.exec(location.hash);
  return found ? Number(found[1]) : null;
}

// Returns a function that writes a time into the address once the reader pauses there.
function makeLink(seek) {
  let waiting = 0;
  window.addEventListener("hashchange", () => {
    const time = linkedTime();
    if (time !== null) seek(time);
  });
  return (time) => {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      try {
        history.replaceState(null, "", `#t=${time.toFixed(2)}`);
      } catch {
        // An embedded page has no address of its own.
      }
    }, 250);
  };
}
