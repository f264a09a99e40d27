// The Players page: from an export to what a coach takes to the gym.

import { useEffect, useState } from "preact/hooks";
import type { Folder, Job } from "./api";
import { Refused, fileAddress, get, post, upload } from "./api";
import { Choice, TextField } from "./controls";
import { JobCard, isOpen, useJobs } from "./jobs";
import type { Fit as ShotFit } from "./state";
import { per100, signed, valueOf } from "./units";

interface Column {
  name: string;
  target: string | null;
  unit: string | null;
  is_stated: boolean;
  zero: string;
}

interface ShotFile {
  rows: number;
  row_name: string;
  columns: Column[];
  targets: { name: string; units: string[] }[];
  shown: { row: number; cells: string[] }[];
  players: { name: string; shots: number; made: number; places: number; sessions: string[] }[];
  faults: { row: number; message: string }[];
  fault_count: number;
  problem: string | null;
  found: string[];
}

interface Says {
  maps: string[];
  at?: string;
  distance?: string;
  release_height?: string;
  made?: string;
  dates?: string;
}

interface Interval {
  mean: number;
  low: number;
  high: number;
}

interface Advice {
  shooter: string;
  place: string;
  kind: string;
  observed: { shots: number; made: number };
  current_probability: Interval;
  suggested_probability: Interval;
  suggested_gain: Interval | null;
  gain_is_positive: number;
  makes_contradict: boolean;
  current: Record<string, unknown>;
  suggested: Record<string, unknown> | null;
  causes: ({ cause: string; support: string } & Interval)[];
  training: ({ less_scatter_of: string } & Interval)[];
  landings: { current: Record<string, unknown>; suggested: Record<string, unknown> } | null;
  bank_or_direct: { direct: Interval; bank: Interval; bank_is_better: number } | null;
  [key: string]: unknown;
}

interface Fit extends ShotFit {
  advice: Advice[];
}

interface Props {
  folder: Folder | null;
  reload: () => void;
  places: string[];
  openShot: (fit: Fit) => void;
}

const MAX_UPLOAD = 64 * 2 ** 20;

const path = (name: string) => name.split("/").map(encodeURIComponent).join("/");

export function PlayersPage({ folder, reload, places, openShot }: Props) {
  const [file, setFile] = useState("");
  const [problem, setProblem] = useState("");
  const [isOver, setOver] = useState(false);
  const jobs = useJobs(["players", "team", "compare", "advise"]);
  const take = async (files: FileList | null | undefined) => {
    setProblem("");
    for (const one of files ?? []) {
      try {
        if (one.size > MAX_UPLOAD) throw new Error(`${one.name}: is larger than 64 MiB; use bankshot fit in a terminal`);
        setFile(await upload(one));
      } catch (error) {
        setProblem(error instanceof Error ? error.message : String(error));
      }
    }
    reload();
  };
  return (
    <div class="page">
      <section
        class={isOver ? "panel drop over" : "panel drop"}
        aria-label="measured shots"
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={(event) => {
          event.preventDefault();
          setOver(false);
          void take(event.dataTransfer?.files);
        }}
      >
        <h2>Measured shots</h2>
        <p>Drop an export of your shot tracker here: CSV, Excel, Parquet or JSON. The file stays on this machine.</p>
        <label class="button main">
          Choose a file
          <input type="file" class="hidden" multiple accept=".csv,.tsv,.txt,.parquet,.xlsx,.xlsm,.xls,.ods,.json" onChange={(event) => void take(event.currentTarget.files)} />
        </label>
        {problem !== "" && (
          <p class="error" role="alert">
            {problem}
          </p>
        )}
        {folder && folder.uploads.length > 0 && (
          <Choice
            label="or one that is already here"
            value={file}
            options={[["", "choose"], ...folder.uploads.map((name) => [name, name] as const)]}
            onChange={setFile}
          />
        )}
      </section>
      {file !== "" && <ShotFilePanel key={file} file={file} places={places} />}
      {jobs.slice(0, 2).map((job) => (
        <JobResult key={job.id} job={job} />
      ))}
      <Fits folder={folder} openShot={openShot} />
    </div>
  );
}

/** A job, and where its results are. */
function JobResult({ job }: { job: Job }) {
  return (
    <>
      <JobCard job={job} />
      {job.stage === "done" && job.request.job === "team" && (
        <p class="links">
          <a href={fileAddress(`${job.folder}/posters.html`)} target="_blank" rel="noopener">
            Posters to print
          </a>{" "}
          <a href={fileAddress(`${job.folder}/team.html`)} target="_blank" rel="noopener">
            Team page
          </a>
        </p>
      )}
      {job.stage === "done" && job.request.job === "players" && (
        <p class="links">
          <a href={fileAddress(`${job.folder}/sheet.html`)} target="_blank" rel="noopener">
            Sheet to print
          </a>
        </p>
      )}
      {job.stage === "done" && job.request.job === "compare" && (
        <section class="panel">
          <h2>{job.request.name}</h2>
          <pre class="text">{job.answer}</pre>
          <img class="plot" src={fileAddress(`${job.folder}/sessions.svg`)} alt="the values of both sessions, and what each change adds" />
        </section>
      )}
    </>
  );
}

function ShotFilePanel({ file, places }: { file: string; places: string[] }) {
  const [says, setSays] = useState<Says>({ maps: [] });
  const [changes, setChanges] = useState<Record<string, { target: string; unit: string }>>({});
  const [content, setContent] = useState<ShotFile | null>(null);
  const [refused, setRefused] = useState<Refused | null>(null);
  const [name, setName] = useState(file.replace(/\.[^.]*$/, ""));
  const [sessions, setSessions] = useState<[string, string]>(["", ""]);
  const [only, setOnly] = useState("");
  const [shooter, setShooter] = useState("");
  const [taken, setTaken] = useState<object | null>(null);
  const jobs = useJobs(["players", "compare"]);

  const request = { ...says, maps: Object.entries(changes).map(([column, { target, unit }]) => `${target}=${column}${unit === "" ? "" : `:${unit}`}`) };
  const key = JSON.stringify(request);
  useEffect(() => {
    let isOld = false;
    const timer = setTimeout(() => {
      post<ShotFile>(`/api/uploads/${encodeURIComponent(file)}`, request).then(
        (found) => isOld || (setContent(found), setRefused(null)),
        (error: unknown) => isOld || (error instanceof Refused && setRefused(error)),
      );
    }, 150);
    return () => {
      isOld = true;
      clearTimeout(timer);
    };
  }, [key]);

  const say = (key: keyof Says, value: string) => {
    const next = { ...says, [key]: value };
    if (value === "") delete next[key];
    setSays(next);
  };
  const start = async (job: object) => {
    try {
      await post<Job>("/api/jobs", job);
      setRefused(null);
      setTaken(null);
    } catch (error) {
      if (error instanceof Refused) {
        setRefused(error);
        setTaken(error.status === 409 ? job : null);
      }
    }
  };
  const isBusy = jobs.some(isOpen);
  const isReady = content !== null && content.problem === null && content.players.length > 0;
  const named = content?.players.flatMap((player) => player.sessions) ?? [];
  const all = [...new Set(named)];
  return (
    <section class="panel" aria-label={`the file ${file}`}>
      <h2>{file}</h2>
      {content && (
        <>
          <p>
            {content.rows.toLocaleString("en")} {content.rows === 1 ? content.row_name : `${content.row_name}s`}
            {content.players.length > 0 &&
              `, ${content.players.map((player) => `${player.name || "one player"}: ${player.shots} shots${player.made > 0 ? `, ${player.made} went in` : ""}`).join("; ")}`}
            .
          </p>
          {content.found.length > 0 && <p class="faint">Found: {content.found.join(", ")}.</p>}
          {content.problem !== null && (
            <pre class="error" role="alert" data-testid="problem">
              {content.problem}
            </pre>
          )}
          {content.fault_count > 0 && (
            <p class="warning">
              {content.fault_count} {content.fault_count === 1 ? `${content.row_name} is` : `${content.row_name}s are`} left out; the reasons are in the table.
            </p>
          )}
          <ShotTable content={content} changes={changes} setChanges={setChanges} />
        </>
      )}
      <div class="fields">
        <Choice
          label="place, if the file does not say it"
          value={says.at ?? ""}
          options={[["", "in the file"], ...places.map((place) => [place, place] as const)]}
          onChange={(value) => say("at", value)}
        />
        <TextField label="release height, if the file does not say it" placeholder="7 ft" value={says.release_height ?? ""} onChange={(value) => say("release_height", value)} />
        <Choice
          label="dates such as 03/04/2026"
          value={says.dates ?? ""}
          options={[
            ["", "as the file has them"],
            ["dmy", "day first"],
            ["mdy", "month first"],
          ]}
          onChange={(value) => say("dates", value)}
        />
        <TextField label="text of a make, if it is unusual" placeholder="1" value={says.made ?? ""} onChange={(value) => say("made", value)} />
        {all.length > 1 && <Choice label="fit the shots of" value={only} options={[["", "all sessions"], ...all.map((one) => [one, one] as const)]} onChange={setOnly} />}
        <TextField label="name of the results" value={name} error={refused?.of("name")} onChange={setName} />
      </div>
      {refused && !refused.of("name") && (
        <pre class="error" role="alert">
          {refused.message}
        </pre>
      )}
      <div class="buttons">
        <button type="button" class="main" disabled={!isReady || isBusy} onClick={() => void start({ job: "players", name, files: [file], sessions: only === "" ? [] : [only], shots: request })}>
          Fit {content && content.players.length > 1 ? `${content.players.length} players` : "the player"}
        </button>
        {taken && (
          <button type="button" onClick={() => void start({ ...taken, replace: true })}>
            Replace the old results
          </button>
        )}
      </div>
      {all.length > 1 && (
        <div class="fields">
          {content && content.players.length > 1 && <Choice label="of the player" value={shooter} options={[["", "choose"], ...content.players.map((player) => [player.name, player.name] as const)]} onChange={setShooter} />}
          <Choice label="compare session" value={sessions[0]} options={[["", "choose"], ...all.map((one) => [one, one] as const)]} onChange={(one) => setSessions([one, sessions[1]])} />
          <Choice label="with session" value={sessions[1]} options={[["", "choose"], ...all.map((one) => [one, one] as const)]} onChange={(one) => setSessions([sessions[0], one])} />
          <button
            type="button"
            disabled={isBusy || sessions.includes("") || sessions[0] === sessions[1] || (content !== null && content.players.length > 1 && shooter === "")}
            onClick={() => void start({ job: "compare", name: `${name} ${shooter} sessions`.replace(/ +/g, " "), file, sessions, shots: request, ...(shooter === "" ? {} : { shooter }) })}
          >
            Compare sessions
          </button>
        </div>
      )}
    </section>
  );
}

interface TableProps {
  content: ShotFile;
  changes: Record<string, { target: string; unit: string }>;
  setChanges: (changes: Record<string, { target: string; unit: string }>) => void;
}

/** The first rows with a menu over each column, and the wrong rows with what is wrong. */
function ShotTable({ content, changes, setChanges }: TableProps) {
  const units = (target: string) => content.targets.find((one) => one.name === target)?.units ?? [];
  const set = (column: Column, target: string, unit: string) => {
    const next = { ...changes };
    if (target === "") next[column.name] = { target: "unused", unit: "" };
    else next[column.name] = { target, unit: units(target).includes(unit) ? unit : (units(target)[0] ?? "") };
    setChanges(next);
  };
  const fault = (row: number) => content.faults.find((one) => one.row === row);
  return (
    <div class="scroll" tabIndex={0} role="region" aria-label="the first rows">
      <table class="shots">
        <thead>
          <tr>
            <th scope="col">{content.row_name}</th>
            {content.columns.map((column) => {
              const changed = changes[column.name];
              const target = (changed?.target === "unused" ? "" : changed?.target) ?? column.target ?? "";
              const unit = changed?.unit ?? column.unit ?? "";
              return (
                <th scope="col" key={column.name} class={target === "" ? "unused" : column.is_stated ? "stated" : "proposed"}>
                  <span class="column-name">{column.name}</span>
                  <select aria-label={`meaning of the column ${column.name}`} value={target} onChange={(event) => set(column, event.currentTarget.value, unit)}>
                    <option value="">not used</option>
                    {content.targets.map((one) => (
                      <option key={one.name} value={one.name}>
                        {one.name.replaceAll("_", " ")}
                      </option>
                    ))}
                  </select>
                  {units(target).length > 0 && (
                    <select aria-label={`unit of the column ${column.name}`} value={unit} onChange={(event) => set(column, target, event.currentTarget.value)}>
                      {unit === "" && <option value="">unit?</option>}
                      {units(target).map((one) => (
                        <option key={one} value={one}>
                          {one.replace("_", "/")}
                        </option>
                      ))}
                    </select>
                  )}
                  {target !== "" && !column.is_stated && !changed && <span class="hint">proposed</span>}
                  {column.zero !== "" && <span class="hint">{column.zero}</span>}
                </th>
              );
            })}
          </tr>
        </thead>
        <tbody>
          {content.shown.map((row) => {
            const wrong = fault(row.row);
            return (
              <>
                <tr key={row.row} class={wrong ? "wrong" : ""}>
                  <th scope="row">{row.row}</th>
                  {content.columns.map((column, index) => (
                    <td key={column.name}>{row.cells[index] ?? ""}</td>
                  ))}
                </tr>
                {wrong && (
                  <tr class="wrong why">
                    <td colSpan={content.columns.length + 1}>
                      {content.row_name} {row.row} {wrong.message}
                    </td>
                  </tr>
                )}
              </>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}

function Fits({ folder, openShot }: { folder: Folder | null; openShot: (fit: Fit) => void }) {
  const [fits, setFits] = useState<Fit[]>([]);
  const [chosen, setChosen] = useState<string[]>([]);
  const [shown, setShown] = useState("");
  const [problem, setProblem] = useState("");
  const advising = useJobs(["advise"]).some(isOpen);
  const written = folder?.files.filter((file) => /(fit|advice)\.json$/.test(file.name)).map((file) => file.written_s) ?? [];
  const key = JSON.stringify([folder?.fits, written]);
  useEffect(() => {
    let isOld = false;
    Promise.all((folder?.fits ?? []).map((name) => get<Fit>(`/api/fits/${path(name)}`).catch(() => null))).then((all) => {
      if (!isOld) setFits(all.filter((fit) => fit !== null));
    });
    return () => {
      isOld = true;
    };
  }, [key]);
  if (fits.length === 0) return null;
  const choose = (name: string, isOn: boolean) => setChosen(isOn ? [...chosen, name] : chosen.filter((one) => one !== name));
  const add = async (job: object) => {
    try {
      await post("/api/jobs", job);
      setProblem("");
    } catch (error) {
      setProblem(error instanceof Error ? error.message : String(error));
    }
  };
  const posters = () => {
    const name = chosen.length === 1 ? chosen[0]!.split("/").at(-1)! : "team";
    return add({ job: "team", name, fits: chosen });
  };
  const fit = fits.find((fit) => fit.name === shown);
  return (
    <>
      <section class="panel" aria-label="players">
        <h2>Players</h2>
        <div class="scroll">
          <table>
            <thead>
              <tr>
                <th scope="col">poster</th>
                <th scope="col" class="text">
                  player
                </th>
                <th scope="col">measured</th>
                <th scope="col">current shot, makes per 100</th>
                <th scope="col">suggested shot</th>
                <th scope="col">gain per 100</th>
                <th scope="col" />
              </tr>
            </thead>
            <tbody>
              {fits.map((one) => {
                const advice = one.advice[0];
                return (
                  <tr key={one.name} class={one.name === shown ? "chosen" : ""}>
                    <td>
                      <input type="checkbox" aria-label={`a poster for ${one.fit.shooter}`} checked={chosen.includes(one.name)} onChange={(event) => choose(one.name, event.currentTarget.checked)} />
                    </td>
                    <td class="text">
                      {one.fit.shooter}
                      <span class="faint"> {one.name}</span>
                    </td>
                    <td>{advice && advice.observed.shots > 0 ? `${advice.observed.made} of ${advice.observed.shots}` : ""}</td>
                    <td>{advice && interval(advice.current_probability)}</td>
                    <td>{advice && interval(advice.suggested_probability)}</td>
                    <td>{advice ? (advice.makes_contradict ? "makes do not fit" : isSuggested(advice) ? signed(advice.suggested_gain!.mean) : "keep") : ""}</td>
                    <td>
                      {!advice && (
                        <button type="button" class="quiet" disabled={advising} onClick={() => void add({ job: "advise", name: one.name })}>
                          Get advice
                        </button>
                      )}{" "}
                      <button type="button" class="quiet" onClick={() => setShown(one.name === shown ? "" : one.name)}>
                        {one.name === shown ? "Hide" : "Show"}
                      </button>{" "}
                      <button type="button" class="quiet" onClick={() => openShot(one)}>
                        Shot page
                      </button>
                    </td>
                  </tr>
                );
              })}
            </tbody>
          </table>
        </div>
        <div class="buttons">
          <button type="button" disabled={chosen.length === 0} onClick={() => void posters()}>
            Make posters
          </button>
        </div>
        {problem !== "" && (
          <p class="error" role="alert">
            {problem}
          </p>
        )}
      </section>
      {fit && <PlayerPanel fit={fit} files={folder?.files.map((file) => file.name) ?? []} />}
    </>
  );
}

const interval = (one: Interval) => `${per100(one.mean, 0)} (${per100(one.low, 0)} to ${per100(one.high, 0)})`;

/** Whether the data support a change. */
const isSuggested = (advice: Advice) => advice.suggested !== null && advice.suggested_gain !== null && advice.suggested_gain.mean >= 0.0005;

/** How much a value changes, in a coach's words. */
function change(current: number | undefined, suggested: number | undefined, more: string, less: string, unit: string, decimals = 1): string | null {
  if (current === undefined || suggested === undefined) return null;
  const by = suggested - current;
  const number = Math.abs(by).toFixed(decimals);
  return Number(number) === 0 ? null : `${number} ${unit} ${by > 0 ? more : less}`;
}

function PlayerPanel({ fit, files }: { fit: Fit; files: string[] }) {
  const plots = [
    ["make_zone", "the make zone with every shot"],
    ["intervals", "how certain each value is"],
    ["drift", "the shots in their order"],
    ["reliability", "makes that the fit expects, against those that were counted"],
  ] as const;
  const has = (name: string) => files.includes(`${fit.name}/${name}`);
  return (
    <section class="panel player" aria-label={`player ${fit.fit.shooter}`}>
      <h2>{fit.fit.shooter}</h2>
      {fit.advice.map((advice) => (
        <AdviceText key={advice.place} advice={advice} isOnly={fit.advice.length === 1} />
      ))}
      <div class="plots">
        {plots
          .filter(([name]) => has(`plots/${name}.svg`))
          .map(([name, words]) => (
            <figure key={name}>
              <img src={fileAddress(`${fit.name}/plots/${name}.svg`)} alt={words} loading="lazy" />
              <figcaption>{words}</figcaption>
            </figure>
          ))}
      </div>
      {has("report.html") && (
        <p class="links">
          <a href={fileAddress(`${fit.name}/report.html`)} target="_blank" rel="noopener">
            The whole report
          </a>
        </p>
      )}
    </section>
  );
}

function AdviceText({ advice, isOnly }: { advice: Advice; isOnly: boolean }) {
  const falls = advice.landings;
  const of = (name: string) => [falls && valueOf(falls.current, name), falls && valueOf(falls.suggested, name)] as [number | undefined, number | undefined];
  const unitOf = (name: string) => (falls && Object.keys(falls.current).find((key) => key.startsWith(`${name}_`))?.endsWith("_cm") ? "cm" : "in");
  const changes = [
    change(...of("entry_angle"), "steeper at the rim", "flatter at the rim", "deg"),
    change(...of("depth"), "deeper", "shorter", unitOf("depth")),
    change(...of("left_right"), "further right", "further left", unitOf("left_right")),
  ].filter((one) => one !== null);
  const release = (name: string, more: string, less: string, decimals: number) => {
    const key = Object.keys(advice.current).find((key) => key.startsWith(`${name}_`)) ?? name;
    const unit = key.slice(name.length + 1).replace("_", "/");
    return advice.suggested ? change(valueOf(advice.current, name), valueOf(advice.suggested, name), more, less, unit, decimals) : null;
  };
  const lab = [
    release("speed", "faster", "slower", 2),
    release("pitch", "higher release angle", "lower release angle", 1),
    release("polar", "further left", "further right", 1),
    release("backspin", "more backspin", "less backspin", 1),
  ].filter((one) => one !== null);
  const what = [...changes, ...(changes.length === 0 ? lab : [])].join(", ");
  const train = [...advice.training].sort((a, b) => b.mean - a.mean)[0];
  const bank = advice.bank_or_direct;
  return (
    <div class="advice">
      {!isOnly && <h3>{advice.place || "one place"}</h3>}
      <p class="answer-line">
        {advice.makes_contradict
          ? `No advice yet: ${advice.observed.made} of ${advice.observed.shots} went in, and the measured shots do not predict that. Check the tracker's zero, the ring, the release height and the place.`
          : isSuggested(advice) && advice.suggested_gain && what !== ""
          ? `Suggested: ${what}. That adds ${signed(advice.suggested_gain.mean)} per 100 (95 % interval ${signed(advice.suggested_gain.low)} to ${signed(advice.suggested_gain.high)}).`
          : "Keep the current shot: the data support no change."}
      </p>
      <ul>
        <li>
          {per100(advice.current_probability.mean, 0)} of 100 go in with the current shot (95 % interval {per100(advice.current_probability.low, 0)} to {per100(advice.current_probability.high, 0)}).
        </li>
        {isSuggested(advice) && lab.length > 0 && <li>At the release: {lab.join(", ")}.</li>}
        {train && !advice.makes_contradict && (
          <li>
            Train the {train.less_scatter_of === "aim" ? "direction" : train.less_scatter_of === "pitch" ? "angle" : train.less_scatter_of}: 10 % less scatter there adds {per100(train.mean)} per 100.
          </li>
        )}
        {bank && !advice.makes_contradict && (
          <li>
            Direct {per100(bank.direct.mean, 0)}, bank {per100(bank.bank.mean, 0)} of 100 with the best shots: bank is better with a probability of {(100 * bank.bank_is_better).toFixed(0)} %.
          </li>
        )}
      </ul>
    </div>
  );
}
