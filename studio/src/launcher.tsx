// The Launcher page: a table of best shots for a machine, its curves, and its sources.

import { useEffect, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Folder, Start } from "./api";
import { Refused, fileAddress, get, post } from "./api";
import { Choice, Tick, TextField } from "./controls";
import { JobCard, isOpen, useJobs } from "./jobs";
import { colour, useTheme } from "./theme";
import { per100, valueOf } from "./units";

type Row = Record<string, unknown> & { kind: string; probability: number | null; has_shot: boolean };

interface Table {
  kind: string;
  shots: Row[];
}

const START = {
  name: "launcher",
  distances: "6 ft to 20 ft by 2 ft",
  kind: "direct",
  height: "3 ft",
  sdSpeed: "1 %",
  sdPitch: "0.5 deg",
  sdPolar: "0.5 deg",
  sdBackspin: "5 %",
  maxBackspin: "4 rev/s",
  pitchMin: "45 deg",
  pitchMax: "70 deg",
  speedMax: "",
  pitch: "",
  backspin: "",
  physics: "ncaa",
};

type Form = typeof START;

function toml(form: Form): string {
  const quoted = (value: string) => JSON.stringify(value);
  const search = [
    form.pitchMin && `pitch_min = ${quoted(form.pitchMin)}`,
    form.pitchMax && `pitch_max = ${quoted(form.pitchMax)}`,
    form.speedMax && `speed_max = ${quoted(form.speedMax)}`,
  ].filter(Boolean);
  const first = form.distances.match(/^\s*[\d.]+\s*[a-z]+/i)?.[0]?.trim() ?? "12 ft";
  return (
    `[shooter]\nname = "launcher"\nrelease_height = ${quoted(form.height)}\nmax_backspin = ${quoted(form.maxBackspin)}\n\n` +
    `[shooter.errors]\nspeed = ${quoted(form.sdSpeed)}\npitch = ${quoted(form.sdPitch)}\npolar = ${quoted(form.sdPolar)}\nbackspin = ${quoted(form.sdBackspin)}\n\n` +
    `[location]\ndistance = ${quoted(first)}\nangle = "0 deg"\n\n[search]\n${search.join("\n")}\n\n[physics]\npreset = ${quoted(form.physics)}\n`
  );
}

export function LauncherPage({ start, folder }: { start: Start; folder: Folder | null }) {
  const [form, setForm] = useState(START);
  const [isDraft, setDraft] = useState(true);
  const [refused, setRefused] = useState<Refused | null>(null);
  const [shown, setShown] = useState("");
  const jobs = useJobs(["table"]);
  const set = (field: keyof Form) => (value: string) => setForm({ ...form, [field]: value });
  const error = (...fields: string[]) => fields.map((field) => refused?.of(field)).find((message) => message !== undefined);
  const known = ["name", "distances", "shooter.release_height", "shooter.errors.speed", "shooter.errors.pitch", "shooter.errors.polar", "shooter.errors.backspin", "shooter.max_backspin", "search.pitch_min", "search.pitch_max", "search.speed_max"];
  const [isTaken, setTaken] = useState(false);
  const begin = async (replace: boolean) => {
    try {
      const optional = (value: string) => (value.trim() === "" ? undefined : value);
      await post("/api/jobs", {
        job: "table",
        name: form.name,
        profile: { toml: toml(form), origin: "the launcher" },
        distances: form.distances,
        kind: form.kind,
        pitch: optional(form.pitch),
        backspin: optional(form.backspin),
        draft: isDraft,
        replace,
      });
      setRefused(null);
      setTaken(false);
      setShown("");
    } catch (error) {
      if (error instanceof Refused) {
        setRefused(error);
        setTaken(error.status === 409);
      }
    }
  };
  const tables = (folder?.files ?? []).map((file) => file.name.match(/^(launchers\/[^/]+)\/table\.json$/)?.[1]).filter((name) => name !== undefined);
  const newest = jobs.find((job) => job.stage === "done")?.folder;
  const table = shown || (newest && tables.includes(newest) ? newest : tables.at(-1)) || "";
  const written = folder?.files.find((file) => file.name === `${table}/table.json`)?.written_s ?? 0;
  const rest = refused?.faults.filter((fault) => fault.field === null || !known.includes(fault.field)) ?? [];
  return (
    <div class="launcher-page">
      <section class="panel controls" aria-label="launcher">
        <h2>Launcher</h2>
        <TextField label="name" value={form.name} error={error("name")} onChange={set("name")} />
        <TextField label="distances" value={form.distances} help="a list or a range: 8 ft, 12 ft or 6 ft to 20 ft by 1 ft" error={error("distances")} onChange={set("distances")} />
        <Choice
          label="shots"
          value={form.kind}
          options={[
            ["direct", "direct"],
            ["bank", "bank"],
            ["best", "the better kind at each distance"],
          ]}
          onChange={set("kind")}
        />
        <TextField label="release height" value={form.height} error={error("shooter.release_height")} onChange={set("height")} />
        <h3>Hood and wheels</h3>
        <div class="pair">
          <TextField label="least angle" value={form.pitchMin} error={error("search.pitch_min")} onChange={set("pitchMin")} />
          <TextField label="greatest angle" value={form.pitchMax} error={error("search.pitch_max")} onChange={set("pitchMax")} />
          <TextField label="fixed angle" placeholder="none" value={form.pitch} onChange={set("pitch")} />
          <TextField label="fixed backspin" placeholder="none" value={form.backspin} onChange={set("backspin")} />
          <TextField label="greatest speed" placeholder="none" value={form.speedMax} error={error("search.speed_max")} onChange={set("speedMax")} />
          <TextField label="most backspin" value={form.maxBackspin} error={error("shooter.max_backspin")} onChange={set("maxBackspin")} />
        </div>
        <h3>Scatter (one standard deviation)</h3>
        <div class="pair">
          <TextField label="speed" value={form.sdSpeed} error={error("shooter.errors.speed")} onChange={set("sdSpeed")} />
          <TextField label="angle" value={form.sdPitch} error={error("shooter.errors.pitch")} onChange={set("sdPitch")} />
          <TextField label="direction" value={form.sdPolar} error={error("shooter.errors.polar")} onChange={set("sdPolar")} />
          <TextField label="backspin" value={form.sdBackspin} error={error("shooter.errors.backspin")} onChange={set("sdBackspin")} />
        </div>
        <Choice label="ball and hoop" value={form.physics} options={start.physics.map((physics) => [physics.name, `${physics.name}: ${physics.description}`] as const)} onChange={set("physics")} />
        <Tick label="a first look, without checks between the distances" value={isDraft} onChange={setDraft} />
        {rest.length > 0 && (
          <pre class="error" role="alert">
            {rest.map((fault) => (fault.field ? `${fault.field}: ${fault.message}` : fault.message)).join("\n")}
          </pre>
        )}
        <button type="button" class="main" disabled={jobs.some(isOpen)} onClick={() => void begin(false)}>
          Make the table
        </button>
        {isTaken && (
          <button type="button" onClick={() => void begin(true)}>
            Replace the old table
          </button>
        )}
      </section>
      <div class="view">
        {jobs.slice(0, 2).map((job) => (
          <JobCard key={job.id} job={job} />
        ))}
        {tables.length > 1 && <Choice label="shown table" value={table} options={tables.map((name) => [name, name] as const)} onChange={setShown} />}
        {table !== "" ? <TablePanel key={`${table} ${written}`} name={table} files={folder?.files.map((file) => file.name) ?? []} /> : <p class="panel">The table appears here, with its curves and its sources.</p>}
      </div>
    </div>
  );
}

function TablePanel({ name, files }: { name: string; files: string[] }) {
  const [table, setTable] = useState<Table | null>(null);
  useEffect(() => {
    get<Table>(fileAddress(`${name}/table.json`)).then(setTable, () => setTable(null));
  }, [name]);
  if (table === null) return null;
  const rows = table.shots.filter((row) => row.has_shot);
  const number = (row: Row, key: string, decimals: number) => valueOf(row, key)?.toFixed(decimals) ?? "";
  const first = rows[0];
  const unitOf = (key: string) => (first ? (Object.keys(first).find((one) => one.startsWith(`${key}_`)) ?? "").slice(key.length + 1).replace("_", "/") : "");
  const sources = [
    ["ShotTable.java", "Java"],
    ["shot_table.hpp", "C++"],
    ["shot_table.py", "Python"],
    ["table.csv", "CSV"],
    ["table.txt", "text"],
    ["launcher.toml", "profile"],
  ].filter(([file]) => files.includes(`${name}/${file}`));
  return (
    <section class="panel" aria-label="table">
      <h2>{name.replace("launchers/", "")}</h2>
      {files.includes(`${name}/table.txt`) && <TableText name={name} />}
      <p class="links">
        {sources.map(([file, words]) => (
          <a key={file} href={fileAddress(`${name}/${file}`)} download={file}>
            {words}
          </a>
        ))}
      </p>
      <div class="curves">
        <Curve rows={rows} values={["speed"]} label={`speed, ${unitOf("speed")}`} />
        <Curve rows={rows} values={["pitch"]} label={`angle, ${unitOf("pitch")}`} />
        <Curve rows={rows} values={["probability"]} label="makes per 100" factor={100} />
      </div>
      <div class="scroll" tabIndex={0} role="region" aria-label="rows of the table">
        <table>
          <thead>
            <tr>
              <th scope="col">distance, {unitOf("distance")}</th>
              <th scope="col" class="text">
                kind
              </th>
              <th scope="col">speed, {unitOf("speed")}</th>
              <th scope="col">angle, {unitOf("pitch")}</th>
              <th scope="col">backspin, {unitOf("backspin")}</th>
              <th scope="col">makes per 100</th>
            </tr>
          </thead>
          <tbody>
            {table.shots.map((row, index) => (
              <tr key={index}>
                <td>{number(row, "distance", 2)}</td>
                <td class="text">{row.has_shot ? row.kind : "no shot"}</td>
                <td>{number(row, "speed", 2)}</td>
                <td>{number(row, "pitch", 1)}</td>
                <td>{number(row, "backspin", 2)}</td>
                <td>{typeof row.probability === "number" ? per100(row.probability) : ""}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

/** The table as the terminal prints it, with its remarks. */
function TableText({ name }: { name: string }) {
  const [text, setText] = useState("");
  useEffect(() => {
    fetch(fileAddress(`${name}/table.txt`)).then(
      async (response) => setText(response.ok ? await response.text() : ""),
      () => setText(""),
    );
  }, [name]);
  return text === "" ? null : (
    <details>
      <summary>Remarks, and the table as text</summary>
      <pre class="text">{text}</pre>
    </details>
  );
}

function Curve({ rows, values, label, factor = 1 }: { rows: Row[]; values: string[]; label: string; factor?: number }) {
  const box = useRef<HTMLDivElement>(null);
  const theme = useTheme();
  useEffect(() => {
    const element = box.current!;
    const x = rows.map((row) => valueOf(row, "distance") ?? 0);
    const series = values.map((value) => rows.map((row) => (valueOf(row, value) ?? 0) * factor));
    const axis = { stroke: colour("ink"), grid: { stroke: colour("grid") }, ticks: { stroke: colour("grid") } };
    const size = () => ({ width: Math.max(220, element.clientWidth), height: 200 });
    const plot = new uPlot(
      {
        ...size(),
        legend: { show: false },
        scales: { x: { time: false } },
        axes: [{ ...axis }, { ...axis, label, labelSize: 18, size: 46 }],
        series: [{ label: "distance" }, ...values.map((value) => ({ label: value, stroke: colour("made"), width: 2, points: { show: true } }))],
      },
      [x, ...series],
      element,
    );
    const observer = new ResizeObserver(() => plot.setSize(size()));
    observer.observe(element);
    return () => {
      observer.disconnect();
      plot.destroy();
    };
  }, [rows.length, theme]);
  return <div class="curve" ref={box} role="img" aria-label={`${label} along the distance; the table below has the numbers`} />;
}
