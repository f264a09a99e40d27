// The Court page: a sweep that fills the map while it runs.

import { useEffect, useState } from "preact/hooks";
import type { Folder, Start } from "./api";
import { Refused, get, post, shortName } from "./api";
import { Choice, Tick, TextField } from "./controls";
import type { MapPlace } from "./court_map";
import { CourtMap } from "./court_map";
import { JobCard, isOpen, useJobs } from "./jobs";
import type { ShotState } from "./state";
import { profileToml } from "./state";
import { inSystem, per100, signed } from "./units";

interface Place {
  x_m: number;
  y_m: number;
  name: string | null;
  direct: number | null;
  bank: number | null;
  direct_shot: Nominal | null;
  bank_shot: Nominal | null;
  spin_gain: number | null;
}

export interface Nominal {
  speed_m_s: number;
  pitch_rad: number;
  polar_rad: number;
  backspin_rad_s: number;
}

interface Sweep {
  name: string;
  jobs: number;
  done: number;
  is_running: boolean;
  shooter_toml: string | null;
  places: Place[];
  remarks: string[];
}

const SHOWN = [
  ["best", "better of the two"],
  ["direct", "direct shots"],
  ["bank", "bank shots"],
  ["difference", "bank minus direct"],
  ["spin", "gain from spin"],
] as const;

type Shown = (typeof SHOWN)[number][0];

/** The value of a place on a map, as a fraction. */
function value(place: Place, shown: Shown): number | null {
  const { direct, bank } = place;
  switch (shown) {
    case "direct":
      return direct;
    case "bank":
      return bank;
    case "difference":
      return direct !== null && bank !== null ? bank - direct : null;
    case "spin":
      return place.spin_gain;
    case "best":
      return direct === null && bank === null ? null : Math.max(direct ?? 0, bank ?? 0);
  }
}

// Viridis for makes, and a blue to orange scale about zero for differences: both can be read by
// people who are colour-blind.
const VIRIDIS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"];
const DIVERGING = ["#0b559f", "#4a90c2", "#a6cde3", "#f2f0eb", "#f6c28b", "#e08a3c", "#b0560f"];

function mix(scale: string[], share: number): string {
  const at = Math.min(0.9999, Math.max(0, share)) * (scale.length - 1);
  const [a, b] = [scale[Math.floor(at)]!, scale[Math.floor(at) + 1]!];
  const part = (colour: string, i: number) => parseInt(colour.slice(1 + 2 * i, 3 + 2 * i), 16);
  const mixed = [0, 1, 2].map((i) => Math.round(part(a, i) + (part(b, i) - part(a, i)) * (at % 1)));
  return `rgb(${mixed.join(" ")})`;
}

interface Props {
  start: Start;
  folder: Folder | null;
  state: ShotState;
  openPlace: (x: number, y: number, shot: Nominal | null, player: string | null) => void;
  reload: () => void;
}

export function CourtPage({ start, folder, state, openPlace, reload }: Props) {
  const sweeps = folder?.sweeps ?? [];
  const [chosen, setChosen] = useState("");
  const [sweep, setSweep] = useState<Sweep | null>(null);
  const [shown, setShown] = useState<Shown>("best");
  const [at, setAt] = useState<Place | null>(null);
  const jobs = useJobs(["sweep", "continue"]);
  const running = jobs.find(isOpen);
  const name = chosen || (running ? `${running.folder}/results` : sweeps.at(-1)) || "";

  // While it runs, the map fills.
  const isLive = sweep?.is_running === true || running?.folder === name.replace(/\/results$/, "");
  useEffect(() => {
    if (name === "") return setSweep(null);
    let isGone = false;
    let timer = 0;
    const load = () =>
      get<Sweep>(`/api/sweeps/${name.split("/").map(encodeURIComponent).join("/")}`).then(
        (found) => {
          if (isGone) return;
          setSweep(found);
          if (isLive || found.is_running) timer = window.setTimeout(load, 1000);
        },
        () => {
          // It has not begun yet.
          if (!isGone && isLive) timer = window.setTimeout(load, 500);
        },
      );
    void load();
    return () => {
      isGone = true;
      clearTimeout(timer);
    };
  }, [name, isLive]);
  useEffect(reload, [running?.id]);

  const values = sweep?.places.map((place) => value(place, shown)).filter((one) => one !== null) ?? [];
  const isDifference = shown === "difference" || shown === "spin";
  const most = Math.max(0.02, ...values.map(Math.abs));
  const [low, high] = isDifference ? [-most, most] : [Math.min(0.9, ...values), Math.max(0.1, ...values)];
  const places: MapPlace[] =
    sweep?.places.map((place) => {
      const one = value(place, shown);
      const share = one === null ? 0 : (one - low) / Math.max(1e-9, high - low);
      return {
        x: place.x_m,
        y: place.y_m,
        colour: one === null ? "var(--empty)" : mix(isDifference ? DIVERGING : VIRIDIS, share),
        label: one === null ? "not computed yet" : isDifference ? `${signed(one)} per 100` : `${per100(one)} of 100`,
      };
    }) ?? [];
  const step = spacing(sweep?.places ?? []);
  const choose = (x: number, y: number) => {
    const near = [...(sweep?.places ?? [])].sort((a, b) => Math.hypot(a.x_m - x, a.y_m - y) - Math.hypot(b.x_m - x, b.y_m - y))[0];
    setAt(near && Math.hypot(near.x_m - x, near.y_m - y) < Math.max(step, 0.5) ? near : null);
  };
  const own = name.match(/^sweeps\/([^/]+)\/results$/)?.[1];
  const isComplete = sweep !== null && sweep.done >= sweep.jobs;
  const [problem, setProblem] = useState("");
  const resume = async () => {
    try {
      await post("/api/jobs", { job: "continue", name: own });
      setProblem("");
    } catch (error) {
      setProblem(error instanceof Error ? error.message : String(error));
    }
  };
  return (
    <div class="court-page">
      <section class="panel controls" aria-label="sweep">
        <NewSweep folder={folder} state={state} begun={(name) => setChosen(`sweeps/${name}/results`)} />
        {sweeps.length > 0 && (
          <Choice label="shown sweep" value={name} options={sweeps.map((one) => [one, one.replace(/^sweeps\/|\/results$/g, "")] as const)} onChange={setChosen} />
        )}
        <Choice label="shown on the map" value={shown} options={SHOWN} onChange={(one) => setShown(one as Shown)} />
        {jobs.slice(0, 2).map((job) => (
          <JobCard key={job.id} job={job} />
        ))}
      </section>
      <section class="panel map" aria-label="map of the court">
        {sweep ? (
          <>
            <h2>{sweep.name}</h2>
            <p data-testid="sweep-progress" data-done={sweep.done} data-jobs={sweep.jobs}>
              {isComplete ? `All ${sweep.jobs} shots are found.` : `${sweep.done} of ${sweep.jobs} shots are found.`}{" "}
              {!isComplete && !isLive && own && (
                <button type="button" class="main" onClick={() => void resume()}>
                  Continue
                </button>
              )}
            </p>
            {!isComplete && <progress max={sweep.jobs} value={sweep.done} aria-label="shots that are found" />}
            {problem !== "" && (
              <p class="error" role="alert">
                {problem}
              </p>
            )}
            {sweep.remarks.length > 0 && <pre class="remarks">{sweep.remarks.join("\n")}</pre>}
            <CourtMap court={start.court} places={places} step={step} chosen={at ? { x: at.x_m, y: at.y_m } : undefined} label={`map: ${SHOWN.find(([key]) => key === shown)![1]}`} onChoose={choose} />
            {values.length === 0 && shown === "spin" && sweep.done > 0 && <p>This sweep did not compute the gain from spin: start one with the tick beside it.</p>}
            {values.length > 0 && (
              <div class="scale" aria-hidden="true">
                <span>{isDifference ? signed(low) : per100(low, 0)}</span>
                <span class="ramp" style={{ background: `linear-gradient(90deg, ${(isDifference ? DIVERGING : VIRIDIS).join(", ")})` }} />
                <span>{isDifference ? signed(high) : per100(high, 0)}</span>
                <span>{isDifference ? "per 100" : "of 100 go in"}</span>
              </div>
            )}
            {at && <PlaceLine place={at} state={state} open={(shot) => openPlace(at.x_m, at.y_m, shot, sweep.shooter_toml)} />}
            <PlaceTable places={sweep.places} state={state} choose={setAt} />
          </>
        ) : (
          <p>Start a sweep to find the best shots at every place of the court.</p>
        )}
      </section>
    </div>
  );
}

/** The distance of the nearest two places, m. */
function spacing(places: Place[]): number {
  const first = places[0];
  if (!first) return 0.9;
  const gaps = places.slice(1).map((place) => Math.hypot(place.x_m - first.x_m, place.y_m - first.y_m));
  return Math.min(1.2, ...gaps.filter((gap) => gap > 0.05));
}

function where(place: Place, state: ShotState): string {
  const distance = inSystem(Math.hypot(place.x_m, place.y_m), "length", state.units).toFixed(1);
  const angle = (Math.atan2(place.y_m, place.x_m) * 180) / Math.PI;
  const side = Math.abs(angle) < 0.5 ? "straight in front" : `${Math.abs(angle).toFixed(0)} deg to the ${angle > 0 ? "right" : "left"}`;
  return place.name ?? `${distance} ${state.units === "imperial" ? "ft" : "m"}, ${side}`;
}

function PlaceLine({ place, state, open }: { place: Place; state: ShotState; open: (shot: Nominal | null) => void }) {
  const better = (place.bank ?? 0) > (place.direct ?? 0) ? place.bank_shot : place.direct_shot;
  return (
    <p class="place-line" data-testid="place">
      {where(place, state)}: direct {place.direct === null ? "\u2013" : per100(place.direct)}, bank {place.bank === null ? "\u2013" : per100(place.bank)} of 100.{" "}
      <button type="button" onClick={() => open(better)}>
        Open on the Shot page
      </button>
    </p>
  );
}

/** The same as the map, for those who cannot see it, and to look numbers up. */
function PlaceTable({ places, state, choose }: { places: Place[]; state: ShotState; choose: (place: Place) => void }) {
  return (
    <details>
      <summary>Table of the places</summary>
      <div class="scroll tall" tabIndex={0} role="region" aria-label="table of the places">
        <table>
          <thead>
            <tr>
              <th scope="col" class="text">
                place
              </th>
              <th scope="col">direct</th>
              <th scope="col">bank</th>
              <th scope="col">bank minus direct</th>
            </tr>
          </thead>
          <tbody>
            {places.map((place) => {
              const difference = value(place, "difference");
              return (
                <tr key={`${place.x_m} ${place.y_m}`}>
                  <td class="text">
                    <button type="button" class="link" onClick={() => choose(place)}>
                      {where(place, state)}
                    </button>
                  </td>
                  <td>{place.direct === null ? "" : per100(place.direct)}</td>
                  <td>{place.bank === null ? "" : per100(place.bank)}</td>
                  <td>{difference === null ? "" : signed(difference)}</td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
    </details>
  );
}

function NewSweep({ folder, state, begun }: { folder: Folder | null; state: ShotState; begun: (name: string) => void }) {
  const feet = state.units === "imperial";
  const [name, setName] = useState("half court");
  const [player, setPlayer] = useState("");
  const [step, setStep] = useState("3 ft");
  const [isInside, setInside] = useState(true);
  const [spin, setSpin] = useState(false);
  const [refused, setRefused] = useState<Refused | null>(null);
  const begin = async () => {
    try {
      let profile: object = { toml: profileToml(state), origin: "the Shot page" };
      if (player !== "") {
        const fit = await get<{ profiles: string[] }>(`/api/fits/${player.split("/").map(encodeURIComponent).join("/")}`);
        profile = { toml: fit.profiles[0], origin: player };
      }
      await post("/api/jobs", { job: "sweep", name, profile, step, inside_three: isInside, spin });
      setRefused(null);
      begun(name);
    } catch (error) {
      if (error instanceof Refused) setRefused(error);
    }
  };
  return (
    <>
      <h2>New sweep</h2>
      <TextField label="name" value={name} error={refused?.of("name")} onChange={setName} />
      <Choice label="shooter" value={player} options={[["", "the numbers of the Shot page"], ...(folder?.fits ?? []).map((one) => [one, shortName(one)] as const)]} onChange={(one) => {
          setPlayer(one);
          setName(one === "" ? "half court" : `half court ${one.split("/").at(-1)}`);
        }} />
      <Choice
        label="a place every"
        value={step}
        options={[...new Set([step, ...(feet ? ["5 ft", "3 ft", "2 ft", "1 ft"] : ["1.5 m", "1 m", "0.6 m", "0.3 m"])])].map((one) => [one, one] as const)}
        error={refused?.of("step")}
        onChange={setStep}
      />
      <Tick label="up to the three-point line only" value={isInside} onChange={setInside} />
      <Tick label="also the gain from spin" value={spin} onChange={setSpin} />
      {refused && !refused.of("name") && !refused.of("step") && (
        <pre class="error" role="alert">
          {refused.message}
        </pre>
      )}
      <button type="button" class="main" onClick={() => void begin()}>
        Start the sweep
      </button>
    </>
  );
}
