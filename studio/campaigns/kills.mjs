// Kills the studio at random moments of a sweep, starts it again, and lets the sweep go on: the
// table has the bytes of the command line. `node studio/campaigns/kills.mjs 100` (a campaign).

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { PROGRAM, ROOT, newFolder, remove, request, startStudio } from "../tests/support.mjs";

const wanted = Number(process.argv[2] ?? 100);
const folder = newFolder();
const profile = { toml: readFileSync(join(ROOT, "configs/free_throw.toml"), "utf8") };
const post = (studio, body) =>
  request(studio, "/api/jobs", { method: "POST", body: JSON.stringify(body), headers: { "content-type": "application/json" } });
let kills = 0;
let rounds = 0;
let first;
while (kills < wanted) {
  const name = `court ${rounds}`;
  let job = { job: "sweep", name, profile, step: "6 ft", inside_three: true };
  for (;;) {
    const studio = await startStudio(folder);
    const answer = await post(studio, job);
    assert.ok(answer.ok, await answer.text());
    const end = Date.now() + 1500 * Math.random();
    let state = "";
    while (Date.now() < end && state !== "done") {
      const jobs = await (await request(studio, "/api/jobs")).json();
      state = jobs.at(-1).stage;
      assert.notEqual(state, "failed", JSON.stringify(jobs.at(-1)));
      await new Promise((done) => setTimeout(done, 20));
    }
    await studio.stop("SIGKILL");
    if (state === "done") break;
    kills += 1;
    if (existsSync(join(folder, "results/sweeps", name, "sweep.toml"))) job = { job: "continue", name };
  }
  rounds += 1;
  const table = readFileSync(join(folder, "results/sweeps", name, "results", "best_shots.csv"));
  if (first === undefined) {
    execFileSync(PROGRAM, ["sweep", join(folder, "results/sweeps", name, "sweep.toml"), "--quiet", "-o", join(folder, "whole")]);
    first = readFileSync(join(folder, "whole", "best_shots.csv"));
  }
  assert.ok(table.equals(first), name);
}
console.log(`studio: ${kills} kills, ${rounds} sweeps with the same bytes`);
remove(folder);
