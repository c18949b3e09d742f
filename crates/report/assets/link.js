// Links to an instant: the address of the page ends in #t=6.5 where its player stands at 6.5 s.

// The time (s) in the address; none where it holds another place or no place.
function linkedTime() {
  const found = /^#t=(\d+(?:\.\d+)?)$/.exec(location.hash);
  return found ? Number(found[1]) : null;
}

// Gives a function that writes a time into the address, once the reader rests on it.
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
        // A page inside another has no address of its own.
      }
    }, 250);
  };
}
