// A studio in a folder of its own, a browser, and the same questions on the command line.

import { spawn, execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";

export const ROOT = resolve(import.meta.dirname, "../..");
export const PROGRAM = process.env.BANKSHOT ?? join(ROOT, "target/release/bankshot");
const BROWSER = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync) ?? "chromium";

export const newFolder = () => mkdtempSync(join(tmpdir(), "studio-"));

/** Starts a studio. `stop` ends it with a signal and removes nothing. */
export async function startStudio(folder, port = 0) {
  const child = spawn(PROGRAM, ["studio", join(folder, "results"), "--no-browser", "--port", String(port)], {
    cwd: folder,
    stdio: ["ignore", "pipe", "pipe"],
  });
  let said = "";
  child.stderr.on("data", (data) => (said += data));
  const ended = new Promise((done) => child.on("exit", (code, signal) => done({ code, signal })));
  const url = await new Promise((found, failed) => {
    const timer = setInterval(() => {
      const match = said.match(/http:\S+/);
      if (match) {
        clearInterval(timer);
        found(match[0]);
      }
    }, 20);
    ended.then((end) => failed(new Error(`the studio ended (${JSON.stringify(end)}): ${said}`)));
    setTimeout(() => failed(new Error(`no link: ${said}`)), 20_000).unref();
  });
  const [base, token] = url.split("/?token=");
  const stop = (signal = "SIGINT") => {
    child.kill(signal);
    return ended;
  };
  return { url, base, token, child, stop, said: () => said };
}

export const launchBrowser = () =>
  chromium.launch({
    executablePath: BROWSER,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });

/** A page of the studio. What it logs, and requests to other hosts, are kept. */
export async function openPage(browser, studio, hash = "#/shot", options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, reducedMotion: "no-preference", ...options });
  // A busy machine is slow, and no fault of the page.
  context.setDefaultTimeout(150_000);
  const page = await context.newPage();
  page.faults = [];
  page.foreign = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
  page.on("request", (request) => {
    const { protocol, origin } = new URL(request.url());
    if (!["data:", "blob:"].includes(protocol) && origin !== studio.base) page.foreign.push(request.url());
  });
  if (process.env.DIST) for (const f of ["studio.js","studio.css"]) await page.route("**/"+f, (r) => r.fulfill({ path: join(ROOT, "studio/dist", f) }));
  await page.goto(studio.url);
  await page.waitForSelector("main > *");
  await page.goto(`${studio.base}/${hash}`);
  await page.waitForSelector("main > *");
  return page;
}

/** What a command prints. */
export const command = (args, cwd) => execFileSync(PROGRAM, args, { cwd, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 28 });

export const request = (studio, path, init = {}) =>
  fetch(studio.base + path, { ...init, headers: { authorization: `Bearer ${studio.token}`, ...init.headers } });

export const remove = (folder) => rmSync(folder, { recursive: true, force: true });

/** Waits until a condition holds. */
export async function until(condition, what, limit = 150_000) {
  const end = Date.now() + limit;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`waited in vain for ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

/** The value that so large a share of some numbers does not exceed. */
export function quantile(numbers, share) {
  const sorted = [...numbers].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}
