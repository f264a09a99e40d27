// The Shot page: the probability follows the controls.

import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Folder, Start } from "./api";
import { Refused, ask, get, post, shortName } from "./api";
import { Choice, CopyButton, Slider } from "./controls";
import { CourtMap } from "./court_map";
import type { Path } from "./scene";
import { CourtScene } from "./scene";
import type { Fit, ShotState } from "./state";
import { inUnits, playersShot, profileToml, shotFlags, shotRequest } from "./state";
import { inSystem, per100, text, unit, valueOf } from "./units";
import { sceneColours, useTheme } from "./theme";

interface Probability {
  probability: number;
  standard_error: number;
  interval_95: [number, number];
  shots: number;
  shares: Record<string, number>;
  /** With the uncertainty of a fit. */
  over_draws?: { mean: number; low: number; high: number };
  [key: string]: unknown;
}

interface SwarmShot {
  made: boolean;
  path: Path;
}

type Best = Record<string, unknown> & { probability: number; kind?: string };

interface BestShots {
  direct: Best | null;
  bank: Best | null;
  no_direct?: string;
  no_bank?: string;
}

/** How shots end: words, and the shares of the answer that belong together. */
const ENDS: [string, string[], "made" | "missed"][] = [
  ["swish", ["swish"], "made"],
  ["off the ring", ["ring"], "made"],
  ["off the board", ["board", "board_and_ring"], "made"],
  ["short", ["short"], "missed"],
  ["long", ["long"], "missed"],
  ["left", ["left"], "missed"],
  ["right", ["right"], "missed"],
  ["in and out", ["in_and_out"], "missed"],
  ["air ball", ["airball"], "missed"],
  ["over the board", ["over"], "missed"],
  ["stuck", ["lodged", "unresolved"], "missed"],
];

/** The shots of a rough number, and the rest of the controls after which a sharp one is asked. */
const ROUGH = { budget: 4096 };
const REST_MS = 100;

const PLAY = [
  ["1", "real speed"],
  ["0.25", "slow motion"],
] as const;

interface Props {
  state: ShotState;
  start: Start;
  folder: Folder | null;
  change: (change: Partial<ShotState>) => void;
  replace: (state: ShotState) => void;
}

/** The question without the shot: a fitted player's profile with another place, or the page's own. */
function profileRequest(state: ShotState, fit: Fit | null) {
  if (state.player === "") return { toml: profileToml(state), origin: "the page" };
  if (fit === null || fit.name !== state.player) return null;
  return {
    toml: fit.profiles[state.fitPlace] ?? fit.profiles[0] ?? "",
    origin: state.player,
    units: state.units,
    distance: text(state.distance, "length", state.units),
    angle: `${state.angle} deg`,
  };
}

export function ShotPage({ state, start, folder, change, replace }: Props) {
  const [fit, setFit] = useState<Fit | null>(null);
  const [answer, setAnswer] = useState<Probability | null>(null);
  /** The question whose answer is sharp. */
  const [sharpKey, setSharpKey] = useState("");
  const [notes, setNotes] = useState<string[]>([]);
  const [refused, setRefused] = useState<Refused | null>(null);
  const [isSearching, setSearching] = useState(false);
  const [swarm, setSwarm] = useState<SwarmShot[]>([]);
  const question = useMemo(() => profileRequest(state, fit), [state, fit]);
  const system = state.units;

  // A fitted player brings a profile, a place, and the current shot.
  useEffect(() => {
    if (state.player === "") return setFit(null);
    let isGone = false;
    get<Fit>(`/api/fits/${state.player.split("/").map(encodeURIComponent).join("/")}`).then(
      (found) => isGone || setFit(found),
      (error: unknown) => isGone || (error instanceof Refused && setRefused(error)),
    );
    return () => {
      isGone = true;
    };
  }, [state.player]);

  // One question is under way at a time. Changes that come before its first number wait, and only
  // the last of them is asked next.
  const asking = useRef({ isBusy: false, next: null as { question: object; key: string } | null });
  const send = (probability: object, key: string) => {
    const now = asking.current;
    if (now.isBusy) {
      now.next = { question: probability, key };
      return;
    }
    now.isBusy = true;
    const free = () => {
      now.isBusy = false;
      const next = now.next;
      now.next = null;
      if (next) send(next.question, next.key);
    };
    let isFree = false;
    const once = () => {
      if (!isFree) {
        isFree = true;
        free();
      }
    };
    ask<Probability>(probability, (draft) => {
      setAnswer(draft);
      setRefused(null);
      once();
    }, key === "" ? "" : state.player).then(
      (answered) => {
        if (answered && (now.next === null || key === "")) {
          setAnswer(answered.answer);
          if (key !== "") setNotes(answered.notes);
          setSharpKey(key);
          setRefused(null);
        }
        once();
      },
      (error: unknown) => {
        if (error instanceof Refused) {
          setRefused(error);
          setAnswer(null);
          setNotes([]);
        }
        once();
      },
    );
  };
  const shot = shotRequest(state);
  const key = JSON.stringify([question, shot]);
  const isSharp = sharpKey === key;
  useEffect(() => {
    if (question === null) return;
    // A rough number while the controls move, and a sharp one when they rest.
    send({ question: "probability", profile: question, shot, effort: ROUGH }, "");
    const timer = setTimeout(() => {
      send({ question: "probability", profile: question, shot }, key);
      ask<{ shots: SwarmShot[] }>({ question: "swarm", profile: question, shot, shots: 60 }).then(
        (answered) => answered && setSwarm(answered.answer.shots),
        () => setSwarm([]),
      );
    }, REST_MS);
    return () => clearTimeout(timer);
  }, [key]);

  const x = inMetres(state.distance, system) * Math.cos((state.angle * Math.PI) / 180);
  const y = inMetres(state.distance, system) * Math.sin((state.angle * Math.PI) / 180);
  const move = (mx: number, my: number) => {
    const distance = Number(inSystem(Math.hypot(mx, my), "length", system).toFixed(2));
    change({ distance, angle: Number(((Math.atan2(my, mx) * 180) / Math.PI).toFixed(1)) });
  };
  const wrong = (field: string) => refused?.of(field);
  const slider = (field: keyof ShotState, label: string, unitName: string, min: number, max: number, step: number, serverField?: string) => (
    <Slider
      label={label}
      unit={unitName}
      value={state[field] as number}
      min={min}
      max={max}
      step={step}
      error={serverField ? wrong(serverField) : undefined}
      onChange={(value) => change({ [field]: value })}
    />
  );
  const feet = system === "imperial";
  const players: [string, string][] = (folder?.fits ?? []).map((name) => [name, shortName(name)]);
  const choosePlayer = (player: string) => {
    if (player === "") return change({ player: "", fitPlace: 0 });
    get<Fit>(`/api/fits/${player.split("/").map(encodeURIComponent).join("/")}`).then(
      (found) => replace(playersShot(state, found, 0)),
      (error: unknown) => error instanceof Refused && setRefused(error),
    );
  };
  const place = start.places.find((place) => Math.hypot(place.x_m - x, place.y_m - y) < 0.08);
  const hoop = (start.physics.find((physics) => physics.name === state.physics) ?? start.physics[0]!).hoop;
  const ownFaults = refused?.faults.filter((fault) => fault.field === null || !["speed", "pitch", "aim", "backspin", "side_spin"].includes(fault.field)) ?? [];

  return (
    <div class="shot-page">
      <section class="panel controls" aria-label="the shot">
        <h2>Shot</h2>
        {slider("speed", "speed", unit("speed", system), feet ? 12 : 3.6, feet ? 40 : 12.2, feet ? 0.05 : 0.01, "speed")}
        {slider("pitch", "angle", "deg", 25, 80, 0.1, "pitch")}
        {slider("aim", "direction (+ left)", "deg", -10, 10, 0.05, "aim")}
        {slider("backspin", "backspin", "rev/s", 0, 5, 0.05, "backspin")}
        {slider("side", "side spin", "rev/s", -3, 3, 0.05, "side_spin")}
        <BestShotCard state={state} question={question} answer={answer} isSharp={isSharp} change={change} searching={setSearching} />
        <h2>Place</h2>
        <Choice
          label="place"
          value={place?.name ?? ""}
          options={[["", place ? "" : "chosen on the court"], ...start.places.map((place) => [place.name, place.name] as const)]}
          onChange={(name) => {
            const chosen = start.places.find((place) => place.name === name);
            if (chosen) move(chosen.x_m, chosen.y_m);
          }}
        />
        <CourtMap court={start.court} chosen={{ x, y }} label="half a court; click to shoot from there" onChoose={move} />
        {slider("distance", "distance", unit("length", system), feet ? 3 : 0.9, feet ? 30 : 9.2, feet ? 0.05 : 0.01, "location.distance")}
        {slider("angle", "court angle (+ right)", "deg", -90, 90, 0.5, "location.angle")}
        <h2>Player</h2>
        <Choice
          label="numbers of"
          value={state.player}
          options={[["", "the controls below"], ...players]}
          onChange={choosePlayer}
        />
        {state.player === "" ? (
          <>
            {slider("height", "release height", unit("length", system), feet ? 4 : 1.2, feet ? 9 : 2.75, feet ? 0.05 : 0.01)}
            <h3>Scatter (one standard deviation)</h3>
            {slider("sdSpeed", "speed", unit("speed", system), 0, feet ? 1 : 0.3, feet ? 0.005 : 0.001)}
            {slider("sdPitch", "angle", "deg", 0, 4, 0.01)}
            {slider("sdPolar", "direction", "deg", 0, 4, 0.01)}
            {slider("sdBackspin", "backspin", "rev/s", 0, 1.5, 0.01)}
            <Choice
              label="ball and hoop"
              value={state.physics}
              options={start.physics.map((physics) => [physics.name, `${physics.name}: ${physics.description}`] as const)}
              onChange={(physics) => change({ physics })}
            />
          </>
        ) : (
          fit && <FittedPlayer fit={fit} state={state} replace={replace} />
        )}
        <div class="buttons">
          <CopyButton words="Copy link" text={() => location.href.replace(/\?token=[^#]*/, "")} />
          <CopyButton
            words="Copy as TOML"
            text={async () => {
              return (await post<{ toml: string }>("/api/profile", { profile: question, shot })).toml;
            }}
          />
          <CopyButton words="Copy as command" text={() => command(state, folder)} />
          <button type="button" class="quiet" onClick={() => replace(inUnits(state, feet ? "metric" : "imperial"))}>
            {feet ? "Use metres" : "Use feet"}
          </button>
        </div>
        {state.player === "" && <p class="help">Save the TOML as player.toml; the command reads it from there.</p>}
      </section>
      <div class="view">
        <Answer answer={answer} isSharp={isSharp} isRefused={refused !== null} />
        {ownFaults.length > 0 && (
          <p class="error" role="alert">
            {ownFaults.map((fault) => (fault.field ? `${fault.field}: ${fault.message}` : fault.message)).join("\n")}
          </p>
        )}
        <Court3d isBusy={(!isSharp && refused === null) || isSearching} start={start} hoop={hoop} swarm={swarm} shooter={{ x, y, height: inMetres(state.height, system) }} />
        {notes.length > 0 && (
          <ul class="notes">
            {notes.map((note) => (
              <li key={note}>{note}</li>
            ))}
          </ul>
        )}
      </div>
    </div>
  );
}

const inMetres = (length: number, system: ShotState["units"]) => length / inSystem(1, "length", system);

function command(state: ShotState, folder: Folder | null): string {
  if (state.player === "") return `bankshot shot player.toml ${shotFlags(state)}`;
  const place = `--distance '${text(state.distance, "length", state.units)}' --angle '${state.angle} deg'`;
  return `bankshot shot '${folder?.folder ?? "results"}/${state.player}' ${place} --units ${state.units} ${shotFlags(state)}`;
}

function FittedPlayer({ fit, state, replace }: { fit: Fit; state: ShotState; replace: (state: ShotState) => void }) {
  const mean = (name: string) => fit.fit.parameters.find((parameter) => parameter.name === name);
  const names = { speed: "speed", pitch: "angle", polar: "direction", backspin: "backspin" };
  const rows = Object.entries(names).map(([name, words]) => [words, mean(`${name}_sd`)] as const);
  return (
    <div class="fitted">
      <p>
        Scatter of {fit.fit.shooter}, from measured shots:{" "}
        {rows
          .filter(([, sd]) => sd)
          .map(([name, sd]) => `${name} ${sd!.mean.toFixed(2)} ${sd!.unit}`)
          .join(", ")}
        .
      </p>
      {fit.profiles.length > 1 && (
        <Choice
          label="place of the fit"
          value={String(state.fitPlace)}
          options={fit.profiles.map((_, index) => [String(index), `place ${index + 1}`] as const)}
          onChange={(index) => replace(playersShot(state, fit, Number(index)))}
        />
      )}
      <button type="button" class="quiet" onClick={() => replace(playersShot(state, fit, state.fitPlace))}>
        Set the player's current shot
      </button>
    </div>
  );
}

function Answer({ answer, isSharp, isRefused }: { answer: Probability | null; isSharp: boolean; isRefused: boolean }) {
  const shares = answer?.shares ?? {};
  const share = (keys: string[]) => keys.reduce((sum, key) => sum + (shares[key] ?? 0), 0);
  const error = answer ? 100 * answer.standard_error : 0;
  return (
    <section class="panel answer" aria-label="makes" data-sharp={isSharp ? "yes" : "no"}>
      <p class="makes" aria-live="polite">
        <span class="big" data-testid="makes" data-value={answer?.probability ?? ""}>
          {answer ? per100(answer.over_draws?.mean ?? answer.probability, isSharp ? 1 : 0) : "\u2013"}
        </span>{" "}
        <span class="unbroken">of 100 go in</span>
      </p>
      <p class="faint">
        {answer
          ? `simulation error ${error < 0.05 ? error.toFixed(2) : error.toFixed(1)} per 100, from ${answer.shots.toLocaleString("en")} simulated shots`
          : isRefused
            ? "no number: see below what is wrong"
            : "waiting for the first number"}
      </p>
      {answer?.over_draws && (
        <p data-testid="interval">
          95 % interval {per100(answer.over_draws.low, 0)} to {per100(answer.over_draws.high, 0)}, from the measured shots
        </p>
      )}
      <dl class="shares">
        {ENDS.map(([words, keys, side]) => (
          <div key={words} class={side}>
            <dt>{words}</dt>
            <dd>
              <span class="bar" style={{ width: `${100 * share(keys)}%` }} />
              <span class="value">{per100(share(keys), isSharp ? 1 : 0)}</span>
            </dd>
          </div>
        ))}
      </dl>
    </section>
  );
}

interface CardProps {
  state: ShotState;
  question: object | null;
  answer: Probability | null;
  isSharp: boolean;
  change: (change: Partial<ShotState>) => void;
  searching: (isBusy: boolean) => void;
}

/** The best direct and the best bank shot, and what the current shot loses. */
function BestShotCard({ state, question, answer, isSharp, change, searching }: CardProps) {
  const [best, setBest] = useState<{ direct: Best | null; bank: Best | null; isDraft: boolean } | null>(null);
  const [isBusy, setBusy] = useState(false);
  const [problem, setProblem] = useState("");
  const profile = JSON.stringify(question);
  const asked = useRef("");
  // Of another profile or place the old answer is wrong.
  useEffect(() => {
    if (asked.current !== profile) setBest(null);
  }, [profile]);
  const search = () => {
    if (question === null) return;
    asked.current = profile;
    setBusy(true);
    searching(true);
    setProblem("");
    ask<BestShots, { shots: Best[] }>({ question: "best_shots", profile: question }, (draft) => {
      const of = (kind: string) => draft.shots.find((shot) => shot.kind === kind) ?? null;
      setBest({ direct: of("direct"), bank: of("bank"), isDraft: true });
    })
      .then(
        (answered) => answered && setBest({ direct: answered.answer.direct, bank: answered.answer.bank, isDraft: false }),
        (error: unknown) => setProblem(error instanceof Error ? error.message : String(error)),
      )
      .finally(() => {
        setBusy(false);
        searching(false);
      });
  };
  const use = (shot: Best) => {
    const value = (name: string, decimals: number) => Number((valueOf(shot, name) ?? 0).toFixed(decimals));
    change({
      speed: value("speed", 2),
      pitch: value("pitch", 1),
      aim: Number(((valueOf(shot, "polar") ?? 0) - state.angle).toFixed(2)),
      backspin: value("backspin", 2),
    });
  };
  const shown = best && ([["direct", best.direct], ["bank", best.bank]] as const);
  const most = Math.max(best?.direct?.probability ?? 0, best?.bank?.probability ?? 0);
  return (
    <div class="best" data-testid="best" data-draft={best ? (best.isDraft ? "yes" : "no") : ""}>
      <button type="button" class="main" disabled={isBusy || question === null} onClick={search}>
        {isBusy ? "Searching\u2026" : "Best shot"}
      </button>
      {problem !== "" && (
        <p class="error" role="alert">
          {problem}
        </p>
      )}
      {shown?.map(([kind, shot]) =>
        shot ? (
          <div key={kind} class="best-shot">
            <p>
              <strong>
                Best {kind} shot: {per100(shot.probability, best?.isDraft ? 0 : 1)} of 100
              </strong>
              <br />
              {(valueOf(shot, "speed") ?? 0).toFixed(2)} {unit("speed", state.units)}, {(valueOf(shot, "pitch") ?? 0).toFixed(1)} deg,{" "}
              {(valueOf(shot, "backspin") ?? 0).toFixed(1)} rev/s
              {aimWords(kind, shot)}
            </p>
            <button type="button" class="quiet" onClick={() => use(shot)}>
              Set this shot
            </button>
          </div>
        ) : (
          <p key={kind}>No {kind} shot goes in from here.</p>
        ),
      )}
      {best && !best.isDraft && answer && isSharp && most > 0 && (
        <p>
          {most - answer.probability < 0.002
            ? "The current shot is as good as the best shot."
            : `The best shot makes ${per100(most - answer.probability)} per 100 more than the current shot.`}
        </p>
      )}
    </div>
  );
}

/** Where to aim, in words; a draft does not know it. */
function aimWords(kind: string, shot: Best): string {
  const value = (name: string) => valueOf(shot, name);
  const unitOf = (name: string) => (Object.keys(shot).some((key) => key === `${name}_cm`) ? "cm" : "in");
  if (kind === "bank") {
    const [across, above] = [value("board_aim_across"), value("board_aim_above_hoop")];
    if (across === undefined || above === undefined) return "";
    const side = Math.abs(across) < 0.5 ? "on its middle line" : `${Math.abs(across).toFixed(0)} ${unitOf("board_aim_across")} ${across > 0 ? "right" : "left"} of its middle`;
    return `; board: ${above.toFixed(0)} ${unitOf("board_aim_above_hoop")} above the ring, ${side}`;
  }
  const past = value("aim_past_centre");
  if (past === undefined) return "";
  return `; ${Math.abs(past).toFixed(0)} ${unitOf("aim_past_centre")} ${past > 0 ? "past" : "before"} the ring's centre`;
}

interface SceneProps {
  start: Start;
  hoop: Start["physics"][number]["hoop"];
  swarm: SwarmShot[];
  shooter: { x: number; y: number; height: number };
  isBusy: boolean;
}

function Court3d({ start, hoop, swarm, shooter, isBusy }: SceneProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<CourtScene | null>(null);
  const [isPlaying, setPlaying] = useState(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  const [rate, setRate] = useState("1");
  const [problem, setProblem] = useState("");
  const slider = useRef<HTMLInputElement>(null);
  const theme = useTheme();

  useEffect(() => {
    try {
      scene.current = new CourtScene(canvas.current!, sceneColours());
    } catch {
      return setProblem("This browser shows no 3-D pictures (WebGL is off); the numbers are not affected.");
    }
    scene.current.onTime = (share) => {
      if (slider.current) slider.current.value = String(share);
    };
    // For the browser tests: frames drawn so far.
    Object.defineProperty(canvas.current!, "drawnFrames", { configurable: true, get: () => scene.current?.frames ?? 0 });
    return () => {
      scene.current?.dispose();
      scene.current = null;
    };
  }, []);
  useEffect(() => scene.current?.setCourt(start.court, hoop), [hoop]);
  useEffect(() => scene.current?.setColours(sceneColours(), start.court), [theme]);
  useEffect(() => scene.current?.setBalls(swarm.map(({ made, path }) => ({ isSecond: !made, path }))), [swarm]);
  const place = `${shooter.x.toFixed(2)} ${shooter.y.toFixed(2)}`;
  useEffect(() => {
    scene.current?.setShooter(shooter.x, shooter.y, shooter.height);
    scene.current?.look("side");
  }, [place]);
  useEffect(() => scene.current?.play(isPlaying, Number(rate)), [isPlaying, rate]);
  useEffect(() => scene.current?.setBusy(isBusy), [isBusy]);

  const keys = (event: KeyboardEvent) => {
    const turns: Record<string, [number, number, number?]> = {
      ArrowLeft: [-0.1, 0],
      ArrowRight: [0.1, 0],
      ArrowUp: [0, 0.08],
      ArrowDown: [0, -0.08],
      "+": [0, 0, 1.15],
      "-": [0, 0, 1 / 1.15],
    };
    const turn = turns[event.key];
    if (!turn) return;
    event.preventDefault();
    scene.current?.turn(...turn);
  };
  const save = () => {
    const link = document.createElement("a");
    link.href = scene.current?.picture() ?? "";
    link.download = "shot.png";
    link.click();
  };
  const made = swarm.filter((shot) => shot.made).length;
  return (
    <section class="panel stage" aria-label="simulated shots">
      <div class="canvas">
        <canvas
          ref={canvas}
          tabIndex={0}
          role="img"
          aria-label={`${swarm.length} simulated shots: ${made} go in, ${swarm.length - made} miss. Arrow keys turn the view, plus and minus zoom.`}
          onKeyDown={keys}
        />
        {problem !== "" && <p class="error">{problem}</p>}
        <p class="legend">
          <span class="dot made" /> goes in <span class="dot missed" /> misses
        </p>
      </div>
      <div class="stage-controls">
        <button type="button" onClick={() => setPlaying(!isPlaying)}>
          {isPlaying ? "Pause" : "Play"}
        </button>
        <label class="rate">
          <span class="hidden">speed of the play</span>
          <select value={rate} onChange={(event) => setRate(event.currentTarget.value)}>
            {PLAY.map(([value, words]) => (
              <option key={value} value={value}>
                {words}
              </option>
            ))}
          </select>
        </label>
        <input
          ref={slider}
          type="range"
          min={0}
          max={1}
          step={0.001}
          aria-label="time of the flight"
          onInput={(event) => {
            setPlaying(false);
            scene.current?.seek(Number(event.currentTarget.value));
          }}
        />
        {(["side", "shooter", "hoop", "above"] as const).map((from) => (
          <button key={from} type="button" class="quiet" onClick={() => scene.current?.look(from)}>
            From {from === "side" ? "the side" : from === "above" ? "above" : `the ${from}`}
          </button>
        ))}
        <button type="button" class="quiet" onClick={save}>
          Save picture
        </button>
      </div>
    </section>
  );
}
