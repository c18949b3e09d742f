// A list of named checks, and the count of what came of them.

export class Suite {
  constructor() {
    this.passed = 0;
    this.failed = 0;
    this.faults = [];
  }

  /** Runs a check; it fails by throwing, and may return a note such as a measured value. */
  async check(name, run) {
    const start = performance.now();
    try {
      const note = await run();
      this.passed += 1;
      const seconds = ((performance.now() - start) / 1000).toFixed(1);
      console.log(`ok    ${name}${note ? `: ${note}` : ""} (${seconds} s)`);
    } catch (error) {
      this.failed += 1;
      this.faults.push([`FAIL  ${name}`, ...String(error.message).split("\n").map((line) => `      ${line}`)].join("\n"));
      console.log(this.faults.at(-1));
    }
  }

  /** Says how many passed, and once more what failed, since a long log may be cut to its end. */
  close() {
    for (const fault of this.faults) console.log(fault);
    console.log(`${this.passed} passed, ${this.failed} failed`);
    return this.failed === 0;
  }
}

export function demand(holds, text) {
  if (!holds) throw new Error(text);
}

/** Numbers from 0 to 1, the same on every machine. */
export function seeded(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}
