// The four pages in a real browser, against the command line.

import assert from "node:assert/strict";
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import axe from "axe-core";
import { ROOT, command, launchBrowser, newFolder, openPage, quantile, remove, request, startStudio, until } from "./support.mjs";

let browser;
let folder;
let studio;

before(async () => {
  folder = newFolder();
  studio = await startStudio(folder);
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  await studio?.stop();
  if (folder) remove(folder);
});

const makes = (page) => page.getByTestId("makes");
const sharp = (page) => page.waitForSelector('.answer[data-sharp="yes"]');

/** Moves a slider as a person does: each step is an event. */
const slide = (page, label, value) =>
  page
    .locator(".slider", { hasText: label })
    .locator("input[type=range]")
    .first()
    .evaluate((input, value) => {
      input.value = value;
      input.dispatchEvent(new Event("input", { bubbles: true }));
    }, String(value));

/** The answer of the command for what the page shows, by the text that the page copies. */
async function fromCommand(page) {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.getByRole("button", { name: "Copy as TOML" }).click();
  await page.waitForSelector('button[data-copied="yes"]');
  const toml = await page.evaluate(() => navigator.clipboard.readText());
  const file = join(folder, "player.toml");
  writeFileSync(file, toml);
  await page.getByRole("button", { name: "Copy as command" }).click();
  await until(() => page.evaluate(async () => (await navigator.clipboard.readText()).startsWith("bankshot")), "the command");
  const words = await page.evaluate(() => navigator.clipboard.readText());
  const args = [...words.matchAll(/'([^']*)'|(\S+)/g)].map((match) => match[1] ?? match[2]).slice(1);
  return { toml, answer: JSON.parse(command([...args, "--json", "--quiet"], folder)) };
}

test("200 moves of a slider are followed, and the last number is that of the command line, bit for bit", async () => {
  const page = await openPage(browser, studio);
  await sharp(page);
  const latencies = await page.evaluate(async () => {
    const input = document.querySelector(".slider input[type=range]");
    const shown = document.querySelector('[data-testid="makes"]');
    const pause = (ms) => new Promise((done) => setTimeout(done, ms));
    const latencies = [];
    let sent = 0;
    let value = shown.dataset.value;
    const observer = new MutationObserver(() => {
      if (shown.dataset.value === value) return;
      value = shown.dataset.value;
      if (sent > 0) latencies.push(performance.now() - sent);
      sent = 0;
    });
    observer.observe(shown, { attributes: true });
    for (let move = 0; move < 200; move++) {
      const begun = performance.now();
      input.value = String(22 + 0.05 * (move % 100));
      if (sent === 0) sent = begun;
      input.dispatchEvent(new Event("input", { bubbles: true }));
      await pause(Math.max(0, 50 - (performance.now() - begun)));
    }
    input.value = "24.45";
    input.dispatchEvent(new Event("input", { bubbles: true }));
    return latencies;
  });
  await until(() => page.locator('.answer[data-sharp="no"]').count().then((n) => n === 0), "the last number");
  await page.waitForTimeout(300);
  await sharp(page);
  console.log(`moves that showed a new number: ${latencies.length}; 50 % within ${quantile(latencies, 0.5).toFixed(0)} ms, 95 % within ${quantile(latencies, 0.95).toFixed(0)} ms`);
  assert.ok(latencies.length > 50, `only ${latencies.length} numbers were shown`);
  const { answer } = await fromCommand(page);
  assert.equal(await makes(page).getAttribute("data-value"), String(answer.probability));
  assert.equal(answer.nominal.speed_ft_s, 24.45);
  assert.deepEqual(page.faults, []);
  assert.deepEqual(page.foreign, []);
  await page.context().close();
});

test("the best shot has a draft, and then the numbers of the command line", async () => {
  const page = await openPage(browser, studio, "#/shot?distance=10&angle=30");
  await sharp(page);
  const [draft, whole] = await page.evaluate(async () => {
    const begun = performance.now();
    const best = document.querySelector(".best");
    const times = {};
    const done = new Promise((done) => {
      new MutationObserver(() => {
        times[best.dataset.draft] ??= performance.now() - begun;
        if (best.dataset.draft === "no") done();
      }).observe(best, { attributes: true });
    });
    best.querySelector("button").click();
    await done;
    return [times.yes, times.no];
  });
  assert.ok(draft < whole);
  console.log(`best shot: a draft after ${draft.toFixed(0)} ms, the answer after ${whole.toFixed(0)} ms`);
  const { toml } = await fromCommand(page);
  const file = join(folder, "place.toml");
  writeFileSync(file, toml);
  const best = JSON.parse(command(["best", file, "--json", "--quiet", "--output", join(folder, "best")], folder));
  const text = await page.getByTestId("best").innerText();
  for (const kind of ["direct", "bank"]) {
    assert.ok(text.includes(`Best ${kind} shot: ${(100 * best[kind].probability).toFixed(1)} of 100`), `${kind}: ${text}`);
    assert.ok(text.includes(`${best[kind].speed_ft_s.toFixed(2)} ft/s`), text);
  }
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("the address says the shot, and metres say the same as feet", async () => {
  const page = await openPage(browser, studio, "#/shot?speed=24.9&pitch=50&backspin=2");
  await sharp(page);
  const before = await makes(page).getAttribute("data-value");
  const address = await page.evaluate(() => location.href);
  const other = await page.context().newPage();
  await other.goto(address);
  await sharp(other);
  assert.equal(await makes(other).getAttribute("data-value"), before);
  await other.getByRole("button", { name: "Use metres" }).click();
  await until(() => other.evaluate(() => location.hash.includes("units=metric")), "the address");
  await sharp(other);
  // Six decimals are kept.
  const after = Number(await makes(other).getAttribute("data-value"));
  assert.ok(Math.abs(after - Number(before)) < 0.001, `${before} and ${after}`);
  await other.getByRole("button", { name: "Use feet" }).click();
  await until(() => other.evaluate(() => !location.hash.includes("units=metric")), "the address");
  await sharp(other);
  assert.equal(await makes(other).getAttribute("data-value"), before);
  await page.context().close();
});

test("a wrong value has the message of the command line at its field", async () => {
  const page = await openPage(browser, studio);
  await sharp(page);
  await page.getByLabel("speed, ft/s").first().fill("-5");
  const message = await page.waitForSelector(".slider.wrong .error");
  assert.match(await message.innerText(), /must be/);
  assert.equal(await makes(page).innerText(), "\u2013", "no number stands beside an error");
  await page.getByLabel("speed, ft/s").first().fill("24");
  await until(() => page.locator(".slider.wrong").count().then((n) => n === 0), "the message to go");
  await page.context().close();
});

test("the swarm is drawn", async () => {
  const page = await openPage(browser, studio);
  await sharp(page);
  await until(() => page.getByRole("img", { name: /60 simulated shots/ }).count(), "the swarm");
  const drawn = () => page.locator(".canvas canvas").evaluate((canvas) => canvas.drawnFrames);
  const begun = await drawn();
  await page.waitForTimeout(2000);
  const rate = ((await drawn()) - begun) / 2;
  console.log(`frames a second, by software rendering: ${rate.toFixed(0)}`);
  assert.ok(rate > 1);
  // The picture that is saved is more than a background.
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save picture" }).click()]);
  const png = readFileSync(await download.path());
  const colours = await page.evaluate(async (base64) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    return new Set(new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer)).size;
  }, png.toString("base64"));
  assert.ok(colours > 100, `${colours} colours`);
  await page.context().close();
});

test("an export is dropped, fitted, and ends in the numbers of the command line", async () => {
  const page = await openPage(browser, studio, "#/players");
  await page.setInputFiles("input[type=file]", join(ROOT, "docs/data/gym_sensor.csv"));
  await page.getByText("125 shots").waitFor();
  await page.getByRole("button", { name: "Fit the player" }).click();
  // A page that is loaded again in the middle loses nothing.
  await page.waitForSelector(".job.running");
  await page.reload();
  await page.waitForSelector(".job");
  await page.waitForSelector(".job.done", { timeout: 120_000 });
  const row = page.getByRole("row", { name: /gym_sensor/ });
  await row.getByText("89 of 125").waitFor();
  const fit = JSON.parse(readFileSync(join(folder, "results/players/gym_sensor/players/gym-sensor/fit.json")));
  const own = JSON.parse(command(["fit", join(ROOT, "docs/data/gym_sensor.csv"), "--json", "--quiet", "--output", join(folder, "own")], folder));
  assert.deepEqual(fit.parameters, own.parameters);
  const advice = JSON.parse(command(["advise", join(folder, "own"), "--json", "--quiet"], folder));
  await row.getByText(`${(100 * advice.current_probability.mean).toFixed(0)} (`).first().waitFor();
  await row.getByRole("button", { name: "Show" }).click();
  await page.locator(".player img").first().waitFor();
  await until(() => page.locator(".player img").evaluateAll((images) => images.filter((i) => i.loading !== "lazy" || i.complete).every((i) => i.naturalWidth > 0)), "the pictures");
  await row.getByRole("button", { name: "Shot page" }).click();
  await sharp(page);
  assert.match(await page.evaluate(() => location.hash), /player=/);
  // The number and its interval are those of the command, with the uncertainty of the fit.
  const { answer, toml } = await fromCommand(page);
  assert.equal(await makes(page).getAttribute("data-value"), String(answer.probability));
  assert.equal(await makes(page).innerText(), (100 * answer.over_draws.mean).toFixed(1));
  assert.ok((await page.getByTestId("interval").innerText()).includes(`${(100 * answer.over_draws.low).toFixed(0)} to ${(100 * answer.over_draws.high).toFixed(0)}`));
  const own_speed = fit.parameters.find((one) => one.name === "speed_mean").mean;
  assert.ok(Math.abs(answer.nominal.speed_ft_s - own_speed) < 0.001, "the page opens with the player's own shot");
  writeFileSync(join(folder, "fitted.toml"), toml);
  const same = JSON.parse(command(["shot", join(folder, "fitted.toml"), "--json", "--quiet"], folder));
  assert.ok(Math.abs(same.probability - answer.probability) < 1e-9, "the copied TOML is the shot of the page");
  assert.deepEqual(page.faults, []);
  assert.deepEqual(page.foreign, []);
  await page.context().close();
});

test("results are not replaced without a question", async () => {
  const page = await openPage(browser, studio, "#/players");
  await page.getByLabel("or one that is already here").selectOption("gym_sensor.csv");
  await page.getByText("125 shots").waitFor();
  await page.getByRole("button", { name: "Fit the player" }).click();
  await page.getByText("there are results named gym_sensor already").waitFor();
  await page.getByRole("button", { name: "Replace the old results" }).waitFor();
  await page.context().close();
});

test("side spin and metres are in the copied TOML", async () => {
  const page = await openPage(browser, studio, "#/shot?side=2&units=metric&distance=4.2&height=2.1&speed=7.4&sdSpeed=0.08");
  await sharp(page);
  const { toml } = await fromCommand(page);
  writeFileSync(join(folder, "side.toml"), toml);
  const same = JSON.parse(command(["shot", join(folder, "side.toml"), "--json", "--quiet"], folder));
  assert.equal(await makes(page).getAttribute("data-value"), String(same.probability));
  await page.context().close();
});

test("posters are made, and print as a PDF", async () => {
  const page = await openPage(browser, studio, "#/players");
  await page.getByLabel(/a poster for/).first().check();
  await page.getByRole("button", { name: "Make posters" }).click();
  const link = page.getByRole("link", { name: "Posters to print" });
  await link.waitFor({ timeout: 120_000 });
  const [posters] = await Promise.all([page.waitForEvent("popup"), link.click()]);
  await posters.waitForLoadState();
  const pdf = await posters.pdf();
  writeFileSync(join(folder, "posters.pdf"), pdf);
  assert.ok(pdf.length > 10_000);
  // The poster cannot use the studio: it is in a sandbox of its own.
  const reached = await posters.evaluate(() => fetch("/api/folder").then((r) => r.status, () => "refused"));
  assert.notEqual(reached, 200);
  await page.context().close();
});

test("three broken files show what is wrong, at the row where there is one", async () => {
  const page = await openPage(browser, studio, "#/players");
  const lines = readFileSync(join(ROOT, "docs/data/gym_sensor.csv"), "utf8").split("\n");
  const broken = [...lines];
  broken[4] = broken[4].replace(/^4,[^,]*/, "4,steep");
  const files = {
    "wrong_cell.csv": [broken.join("\n"), async () => assert.match(await page.locator("tr.why").first().innerText(), /steep/)],
    "no_columns.csv": ["a,b\n1,2\n3,4\n", async () => assert.match(await page.getByTestId("problem").innerText(), /column/)],
    "empty.csv": ["", async () => assert.match(await page.getByTestId("problem").innerText(), /empty/)],
  };
  for (const [name, [text, check]] of Object.entries(files)) {
    await page.setInputFiles("input[type=file]", { name, mimeType: "text/csv", buffer: Buffer.from(text) });
    await page.getByRole("heading", { name }).waitFor();
    await page.locator("tr.why, [data-testid=problem]").first().waitFor();
    await check();
  }
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("names of strangers stay text", async () => {
  const names = ['<img src=x onerror="window.hacked=1">', '"><script>window.hacked=2</script>', "</script>' onmouseover='window.hacked=3' ="];
  const cell = (text) => `"${text.replaceAll('"', '""')}"`;
  const lines = readFileSync(join(ROOT, "docs/data/gym_sensor.csv"), "utf8").trim().split("\n");
  const rows = lines.slice(1, 91).map((line, number) => `${cell(names[number % 3])},${cell(names[1])},${line.replace(/^[^,]*,/, "")},x`);
  const header = `shooter,session,${lines[0].replace(/^[^,]*,/, "")},${cell(names[0])}`;
  const page = await openPage(browser, studio, "#/players");
  await page.setInputFiles("input[type=file]", { name: "<img src=x onerror=hacked()>'s #1.csv", mimeType: "text/csv", buffer: Buffer.from([header, ...rows].join("\n")) });
  await page.getByText("90 lines").first().waitFor();
  await page.getByRole("button", { name: /^Fit/ }).click();
  await page.waitForSelector(".job.done", { timeout: 120_000 });
  const row = page.getByRole("row").filter({ hasText: names[0] });
  await row.first().waitFor();
  await page.getByRole("button", { name: "Show" }).first().click();
  await page.locator(".player img").first().waitFor();
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator("img[src=x], script:not([src]):not([type])").count(), 0);
  assert.deepEqual(page.faults, []);
  assert.deepEqual(page.foreign, []);
  await page.context().close();
});

test("the meaning of a column can be changed by a menu", async () => {
  const page = await openPage(browser, studio, "#/players");
  const text = readFileSync(join(ROOT, "docs/data/gym_sensor.csv"), "utf8").replace("depth_in", "Q");
  await page.setInputFiles("input[type=file]", { name: "odd.csv", mimeType: "text/csv", buffer: Buffer.from(text) });
  await page.getByTestId("problem").waitFor();
  await page.getByLabel("meaning of the column Q").selectOption("depth");
  await page.getByLabel("unit of the column Q").selectOption("in");
  await page.getByText("125 shots").waitFor();
  assert.equal(await page.getByTestId("problem").count(), 0);
  // A column can be left out again.
  await page.getByLabel("meaning of the column Q").selectOption("");
  await page.getByTestId("problem").waitFor();
  await page.context().close();
});

test("a launcher's table has its curves, and its files are those of the command line", async () => {
  const page = await openPage(browser, studio, "#/launcher");
  const distances = page.getByLabel("distances", { exact: true });
  await distances.fill("8 ft, 10 ft, 12 ft");
  await page.getByRole("button", { name: "Make the table" }).click();
  await page.locator(".curve canvas").first().waitFor({ timeout: 120_000 });
  const made = join(folder, "results/launchers/launcher");
  const own = join(folder, "own_table");
  mkdirSync(own);
  copyFileSync(join(made, "launcher.toml"), join(own, "launcher.toml"));
  command(["table", join(own, "launcher.toml"), "--distances", "8 ft, 10 ft, 12 ft", "--draft", "-o", join(own, "table.csv"), "-o", join(own, "table.json")], folder);
  for (const file of ["table.csv", "table.json"]) {
    assert.equal(readFileSync(join(made, file), "utf8"), readFileSync(join(own, file), "utf8"), file);
  }
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: "Java" }).click()]);
  assert.equal(readFileSync(await download.path(), "utf8"), readFileSync(join(made, "ShotTable.java"), "utf8"));
  await page.getByLabel("name", { exact: true }).fill("far away");
  await distances.fill("8 parsecs");
  await page.getByRole("button", { name: "Make the table" }).click();
  await page.locator(".job.failed, .error").first().waitFor();
  assert.match(await page.locator(".job.failed, .error").first().innerText(), /parsecs/);
  await page.context().close();
});

test("a sweep fills the map, survives a kill, and ends with the bytes of the command line", async () => {
  const own = newFolder();
  let live = await startStudio(own);
  let page = await openPage(browser, live, "#/court");
  await page.getByLabel("name").fill("court");
  await page.getByLabel("a place every").selectOption("5 ft");
  await page.getByRole("button", { name: "Start the sweep" }).click();
  const progress = () => page.getByTestId("sweep-progress");
  const share = async () => Number(await progress().getAttribute("data-done")) / Number(await progress().getAttribute("data-jobs"));
  await progress().waitFor();
  await until(async () => (await share()) > 0.3, "a third of the sweep");
  await live.stop("SIGKILL");
  await page.context().close();
  live = await startStudio(own);
  page = await openPage(browser, live, "#/court");
  await progress().waitFor();
  const kept = await share();
  assert.ok(kept > 0.25 && kept < 1, `${kept} of the sweep was kept`);
  await page.getByRole("button", { name: "Continue" }).click();
  await page.getByText(/All \d+ shots are found/).waitFor({ timeout: 180_000 });
  await until(() => existsSync(join(own, "results/sweeps/court/results/best_shots.csv")), "the table");
  command(["sweep", join(own, "results/sweeps/court/sweep.toml"), "--quiet", "--output", join(own, "again")], own);
  for (const file of ["best_shots.csv", "best_shots.parquet"]) {
    assert.ok(readFileSync(join(own, "results/sweeps/court/results", file)).equals(readFileSync(join(own, "again", file))), file);
  }
  // A place of the map opens on the Shot page.
  await page.locator(".map .court-map rect[fill^=rgb]").nth(3).click();
  await page.getByTestId("place").getByRole("button").click();
  await sharp(page);
  assert.deepEqual(page.foreign, []);
  await page.context().close();
  const end = await live.stop("SIGINT");
  assert.equal(end.code, 130);
  remove(own);
});

test("two pages do not disturb each other", async () => {
  const [a, b] = [await openPage(browser, studio, "#/shot?speed=24"), await openPage(browser, studio, "#/shot?speed=25")];
  for (let i = 0; i < 10; i++) {
    await slide(a, "angle", 45 + i);
    await slide(b, "angle", 60 - i);
  }
  for (const page of [a, b]) {
    await page.waitForTimeout(200);
    await sharp(page);
  }
  for (const [page, speed, pitch] of [[a, 24, 54], [b, 25, 51]]) {
    const { answer } = await fromCommand(page);
    assert.equal(answer.nominal.speed_ft_s, speed);
    assert.equal(answer.nominal.pitch_deg, pitch);
    assert.equal(await makes(page).getAttribute("data-value"), String(answer.probability));
    await page.context().close();
  }
});

test("a job is stopped at once", async () => {
  const start = await request(studio, "/api/jobs", {
    method: "POST",
    body: JSON.stringify({ job: "sweep", name: "to stop", profile: { toml: readFileSync(join(ROOT, "configs/free_throw.toml"), "utf8") }, step: "1 ft", inside_three: true }),
  });
  const { id } = await start.json();
  const stage = async () => (await (await request(studio, "/api/jobs")).json()).find((job) => job.id === id).stage;
  await until(async () => (await stage()) === "running", "the job to run");
  await new Promise((done) => setTimeout(done, 1500));
  const begun = Date.now();
  assert.equal((await request(studio, `/api/jobs/${id}`, { method: "DELETE" })).status, 204);
  await until(async () => (await stage()) === "stopped", "the job to stop");
  console.log(`stopped after ${Date.now() - begun} ms`);
});

for (const scheme of ["light", "dark"]) {
  test(`no page scrolls sideways, and axe finds nothing serious (${scheme})`, async () => {
    for (const name of ["shot", "players", "court", "launcher"]) {
      const page = await openPage(browser, studio, `#/${name}`, { colorScheme: scheme });
      await page.waitForTimeout(400);
      for (const width of [360, 390, 768, 1280, 1920, 2560]) {
        await page.setViewportSize({ width, height: 900 });
        const [wide, seen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
        assert.ok(wide <= seen, `${name} at ${width}: ${wide} px wide`);
      }
      await page.setViewportSize({ width: 1280, height: 900 });
      await page.evaluate(axe.source).catch(() => {});
      const { violations } = await page.evaluate(() => window.axe.run());
      const serious = violations.filter((one) => ["serious", "critical"].includes(one.impact));
      assert.deepEqual(
        serious.map((one) => [one.id, one.nodes.map((node) => node.html).slice(0, 3)]),
        [],
        name,
      );
      await page.context().close();
    }
  });
}

test("every control can be reached by the keyboard", async () => {
  const page = await openPage(browser, studio);
  await sharp(page);
  const reached = new Set();
  for (let i = 0; i < 90; i++) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => `${document.activeElement?.tagName} ${document.activeElement?.textContent?.slice(0, 20)}`));
  }
  for (const button of ["Best shot", "Pause", "From above", "Copy link", "Save picture"]) {
    assert.ok([...reached].some((one) => one.includes(button)), `${button}: ${[...reached].join("; ")}`);
  }
  await page.context().close();
});

test("the bundle is small", () => {
  const dist = join(ROOT, "studio/dist");
  const bytes = readdirSync(dist).reduce((sum, file) => sum + statSync(join(dist, file)).size, 0);
  assert.ok(bytes <= 1.5e6, `${bytes} bytes`);
});
