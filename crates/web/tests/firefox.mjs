// Firefox, driven by what it has itself: Marionette, JSON over a socket.
// https://firefox-source-docs.mozilla.org/testing/marionette/Protocol.html

import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as wait } from "node:timers/promises";

/** Where Firefox is on this machine; none where it is not. */
export function firefox() {
  const names = ["firefox-esr", "firefox"];
  const found = (process.env.PATH ?? "").split(":").flatMap((folder) => names.map((name) => join(folder, name)));
  return process.env.FIREFOX ?? found.find(existsSync);
}

/** Starts it; gives what runs a command, and what ends it. */
export async function drive(path) {
  const profile = mkdtempSync(join(tmpdir(), "barrelstack-firefox-"));
  writeFileSync(join(profile, "user.js"), 'user_pref("marionette.port", 0);\nuser_pref("browser.shell.checkDefaultBrowser", false);\nuser_pref("datareporting.policy.dataSubmissionEnabled", false);\n');
  const child = spawn(path, ["--headless", "--marionette", "--no-remote", "--profile", profile], { stdio: "ignore", env: { ...process.env, HOME: profile, MOZ_HEADLESS: "1" } });
  const place = join(profile, "MarionetteActivePort");
  for (let tries = 0; !existsSync(place); tries += 1) {
    if (tries > 300 || child.exitCode !== null) throw new Error("Firefox does not start");
    await wait(200);
  }
  const socket = connect(Number(readFileSync(place, "utf8")), "127.0.0.1");
  const waiting = new Map();
  let heard = Buffer.alloc(0), next = 0, greeted;
  const greeting = new Promise((done) => { greeted = done; });
  socket.on("data", (bytes) => {
    heard = Buffer.concat([heard, bytes]);
    for (;;) {
      const colon = heard.indexOf(":");
      const length = Number(heard.subarray(0, colon).toString());
      if (colon < 0 || heard.length < colon + 1 + length) return;
      const message = JSON.parse(heard.subarray(colon + 1, colon + 1 + length).toString());
      heard = heard.subarray(colon + 1 + length);
      if (!Array.isArray(message)) greeted();
      else {
        const [, id, error, result] = message;
        const { done, fail } = waiting.get(id);
        waiting.delete(id);
        if (error) fail(new Error(error.message));
        else done(result.value ?? result);
      }
    }
  });
  // Who ends before the last answer gives none.
  let gone = null;
  const left = new Promise((_, fail) => {
    socket.on("close", () => {
      gone = new Error(`Firefox has ended (${child.exitCode ?? child.signalCode ?? "it still runs, without its socket"})`);
      fail(gone);
      for (const { fail } of waiting.values()) fail(gone);
    });
  });
  left.catch(() => {});
  await Promise.race([greeting, left]);
  const command = (name, parameters = {}) => new Promise((done, fail) => {
    if (gone) return fail(gone);
    waiting.set((next += 1), { done, fail });
    const text = JSON.stringify([0, next, name, parameters]);
    socket.write(`${Buffer.byteLength(text)}:${text}`);
  });
  await command("WebDriver:NewSession", {});
  await command("WebDriver:SetTimeouts", { script: 300_000, pageLoad: 120_000 });
  return {
    command,
    /** Runs the body of an asynchronous function in the page, which finds what it is given as `args`. */
    run: (body, ...args) => command("WebDriver:ExecuteAsyncScript", {
      script: `const done = arguments[arguments.length - 1], args = [...arguments].slice(0, -1); (async () => { ${body} })().then((value) => done({ value }), (error) => done({ error: String(error) }));`,
      args,
    }).then(({ value, error }) => {
      if (error) throw new Error(error);
      return value;
    }),
    async close() {
      await command("Marionette:Quit", { flags: ["eForceQuit"] }).catch(() => {});
      socket.destroy();
      child.kill();
      await wait(500);
      rmSync(profile, { recursive: true, force: true });
    },
  };
}
