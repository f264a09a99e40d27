// Requests that must be refused: by status, without a trace in the folder, and the page still answers.

import assert from "node:assert/strict";
import http from "node:http";
import net from "node:net";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ROOT, newFolder, remove, request, startStudio } from "./support.mjs";

let folder;
let studio;
let port;

before(async () => {
  folder = newFolder();
  studio = await startStudio(folder);
  port = Number(new URL(studio.base).port);
});

after(async () => {
  await studio?.stop();
  if (folder) remove(folder);
});

/** A request with exactly these headers and this path, as no browser would send it. */
const raw = (path, { method = "GET", headers = {}, body } = {}) =>
  new Promise((done, failed) => {
    const sent = http.request({ host: "127.0.0.1", port, path, method, agent: false, headers: { host: `127.0.0.1:${port}`, ...headers }, setHost: false }, (response) => {
      let text = "";
      response.on("data", (data) => (text += data));
      response.on("end", () => done({ status: response.statusCode, headers: response.headers, text }));
    });
    sent.on("error", failed);
    sent.end(body);
  });

const token = () => ({ authorization: `Bearer ${studio.token}` });
const profile = { toml: readFileSync(join(ROOT, "configs/free_throw.toml"), "utf8") };
const question = JSON.stringify({ question: "probability", profile, shot: { speed: "24.3 ft/s", pitch: "53 deg" }, effort: { target: 0.02 } });

const stillAnswers = async () => {
  const response = await request(studio, "/api/answer", { method: "POST", body: question });
  assert.equal(response.status, 200);
  assert.match(await response.text(), /"answer"/);
};

const memory = () => Number(readFileSync(`/proc/${studio.child.pid}/status`, "utf8").match(/VmRSS:\s+(\d+)/)[1]) / 1024;

test("without the token, or with a wrong one", async () => {
  for (const path of ["/api/folder", "/api/start", "/api/jobs", "/api/events", "/files/x.csv", "/api/fits/x"]) {
    assert.equal((await raw(path)).status, 403, path);
    assert.equal((await raw(path, { headers: { authorization: "Bearer 0" } })).status, 403, path);
    assert.equal((await raw(path, { headers: { cookie: `bankshot_${port}=${"0".repeat(32)}` } })).status, 403, path);
  }
  assert.equal((await raw("/?token=wrong")).status, 403);
  assert.equal((await raw("/api/answer", { method: "POST", body: question })).status, 403);
  assert.equal((await raw("/api/uploads/a.csv", { method: "PUT", body: "x" })).status, 403);
});

test("a foreign host or origin", async () => {
  for (const host of ["evil.example", `evil.example:${port}`, `127.0.0.1.evil.example:${port}`, "127.0.0.1:1", ""]) {
    assert.equal((await raw("/api/folder", { headers: { ...token(), host } })).status, 403, host);
    assert.equal((await raw("/", { headers: { host } })).status, 403, host);
  }
  for (const origin of ["http://evil.example", "null", "https://127.0.0.1", `http://localhost:${port + 1}`]) {
    assert.equal((await raw("/api/answer", { method: "POST", headers: { ...token(), origin }, body: question })).status, 403, origin);
  }
  assert.equal((await raw("/api/folder", { headers: { ...token(), "sec-fetch-site": "cross-site" } })).status, 403);
  await stillAnswers();
});

test("paths that lead out of the folder", async () => {
  for (const path of [
    "/files/../../../etc/passwd",
    "/files/..%2f..%2f..%2fetc%2fpasswd",
    "/files/%2e%2e/%2e%2e/etc/passwd",
    "/files//etc/passwd",
    "/files/%2fetc%2fpasswd",
    "/files/x%00.csv",
    "/api/fits/..%2f..",
    "/api/sweeps/..%2f..%2fetc",
  ]) {
    const { status, text } = await raw(path, { headers: token() });
    assert.ok([400, 403, 404].includes(status), `${path}: ${status}`);
    assert.ok(!text.includes("root:"), path);
  }
  for (const name of ["..%2fx.csv", "%2ftmp%2fx.csv", "a%00.csv", ".hidden.csv", "x.exe", "CON.csv", "a%0ab.csv"]) {
    assert.equal((await raw(`/api/uploads/${name}`, { method: "PUT", headers: token(), body: "x" })).status, 400, name);
  }
  const job = (body) => raw("/api/jobs", { method: "POST", headers: token(), body: JSON.stringify(body) });
  for (const body of [
    { job: "sweep", name: "../x", profile, step: "3 ft", inside_three: true },
    { job: "players", name: "x", files: ["../../etc/passwd"] },
    { job: "players", name: "/tmp/x", files: [] },
    { job: "team", name: "x", fits: ["../.."] },
    { job: "advise", name: ".." },
    { job: "continue", name: "../../x" },
  ]) {
    assert.ok([400, 404].includes((await job(body)).status), JSON.stringify(body));
  }
  await raw("/api/uploads/a.csv", { method: "PUT", headers: token(), body: "entry_angle_deg\n1\n" });
  assert.equal((await job({ job: "players", name: "x", files: ["a.csv"], shots: { maps: ["@/etc/passwd"] } })).status, 400);
  assert.deepEqual(readdirSync(folder), ["results"]);
  assert.deepEqual(readdirSync(join(folder, "results")), ["uploads"]);
});

test("bodies that are too large, wrong or endless", async () => {
  const long = await raw("/api/answer", { method: "POST", headers: token(), body: "x".repeat(2 << 20) }).catch((error) => ({ status: error.code }));
  // The server may close before all is sent.
  assert.ok([413, "EPIPE", "ECONNRESET"].includes(long.status), String(long.status));
  for (const body of ["", "{", "[]", "null", '{"question":"x"}', "\0", '{"question":"probability"}', "[".repeat(100_000)]) {
    assert.equal((await raw("/api/answer", { method: "POST", headers: token(), body })).status, 400, body.slice(0, 30));
  }
  const huge = Buffer.alloc(100 << 20, 97);
  assert.equal((await raw("/api/uploads/huge.csv", { method: "PUT", headers: { ...token(), "content-length": huge.length }, body: huge })).status, 413);
  // Without a length the upload is counted as it comes.
  const chunked = await new Promise((done) => {
    const sent = http.request({ host: "127.0.0.1", port, path: "/api/uploads/huge.csv", method: "PUT", agent: false, headers: { ...token(), host: `127.0.0.1:${port}` } }, (response) => {
      response.resume();
      done(response.statusCode);
    });
    sent.on("error", (error) => done(error.code));
    const block = Buffer.alloc(1 << 20, 97);
    let left = 100;
    const more = () => {
      while (left-- > 0) if (!sent.write(block)) return void sent.once("drain", more);
      sent.end();
    };
    more();
  });
  assert.equal(chunked, 413);
  assert.ok(!existsSync(join(folder, "results/uploads/huge.csv")));
  assert.ok(memory() < 300, `${memory().toFixed(0)} MB`);
  await stillAnswers();
});

test("many requests, slow clients and broken requests", async () => {
  // Slow clients that never finish their request.
  const slow = Array.from({ length: 100 }, () => {
    const socket = net.connect(port, "127.0.0.1");
    socket.on("error", () => {});
    socket.write("POST /api/answer HTTP/1.1\r\nHost: 127");
    return socket;
  });
  for (const text of ["\0\0\0\0", "GET / HTTP/9.9\r\n\r\n", `GET /${"a".repeat(100_000)} HTTP/1.1\r\n\r\n`, "A".repeat(1 << 20)]) {
    const socket = net.connect(port, "127.0.0.1");
    socket.on("error", () => {});
    socket.end(text);
  }
  const agent = new http.Agent({ keepAlive: true, maxSockets: 60 });
  const one = (path, options = {}) =>
    new Promise((done) => {
      const sent = http.request({ host: "127.0.0.1", port, path, agent, headers: { host: `127.0.0.1:${port}`, ...token() }, ...options }, (response) => {
        response.resume();
        response.on("end", () => done(response.statusCode));
      });
      sent.on("error", () => done(0));
      sent.end(options.body);
    });
  const seconds = 10;
  const counts = {};
  const end = Date.now() + 1000 * seconds;
  const pending = new Set();
  let sent = 0;
  while (Date.now() < end) {
    for (let i = 0; i < 10; i++) {
      const promise = one(...(sent++ % 10 === 0 ? ["/api/answer", { method: "POST", body: question }] : ["/api/jobs"])).then((status) => {
        counts[status] = (counts[status] ?? 0) + 1;
        pending.delete(promise);
      });
      pending.add(promise);
    }
    await new Promise((done) => setTimeout(done, 10));
  }
  await Promise.all(pending);
  console.log(`${sent} requests in ${seconds} s: ${JSON.stringify(counts)}; ${memory().toFixed(0)} MB`);
  const known = Object.keys(counts).every((status) => ["200", "503"].includes(status));
  assert.ok(known, JSON.stringify(counts));
  assert.ok(memory() < 300, `${memory().toFixed(0)} MB`);
  await stillAnswers();
  for (const socket of slow) socket.destroy();
  agent.destroy();
});

test("answers say what a browser may do with them", async () => {
  const page = await raw("/");
  assert.match(page.headers["content-security-policy"], /default-src 'none'/);
  assert.ok(!page.headers["content-security-policy"].includes("unsafe"));
  assert.equal(page.headers["x-content-type-options"], "nosniff");
  const file = await raw("/files/uploads/a.csv", { headers: token() });
  assert.equal(file.status, 200);
  assert.match(file.headers["content-security-policy"], /^sandbox /);
  const visit = await raw(`/?token=${studio.token}`);
  assert.equal(visit.status, 303);
  assert.match(visit.headers["set-cookie"][0], /HttpOnly; SameSite=Strict/);
});
