// The studio: four pages and their addresses. It shows what the program answers and computes
// nothing of its own.

import { render } from "preact";
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import type { Folder, Start } from "./api";
import { Refused, get } from "./api";
import type { Nominal } from "./court";
import { CourtPage } from "./court";
import { JobsContext, isOpen, useJobEvents } from "./jobs";
import { LauncherPage } from "./launcher";
import { PlayersPage } from "./players";
import { ShotPage } from "./shot";
import type { Fit, ShotState } from "./state";
import { fromAddress, playersShot, toAddress } from "./state";
import "./studio.css";
import type { Theme } from "./theme";
import { setTheme, storedTheme } from "./theme";
import { inSystem } from "./units";

const PAGES = [
  ["shot", "Shot"],
  ["players", "Players"],
  ["court", "Court"],
  ["launcher", "Launcher"],
] as const;

type Page = (typeof PAGES)[number][0];

function address(): { page: Page; state: ShotState } {
  const [path = "", search = ""] = location.hash.replace(/^#\/?/, "").split("?");
  const page = PAGES.find(([name]) => name === path)?.[0] ?? "shot";
  return { page, state: fromAddress(search) };
}

function App() {
  const [{ page, state }, setAddress] = useState(address);
  const [start, setStart] = useState<Start | null>(null);
  const [folder, setFolder] = useState<Folder | null>(null);
  const [problem, setProblem] = useState("");
  const [theme, choose] = useState<Theme>(storedTheme);
  const { jobs, lost } = useJobEvents();

  useEffect(() => {
    const changed = () => setAddress(address());
    addEventListener("hashchange", changed);
    return () => removeEventListener("hashchange", changed);
  }, []);
  const reload = useCallback(() => {
    get<Folder>("/api/folder").then(setFolder, () => {});
  }, []);
  useEffect(() => {
    get<Start>("/api/start").then(setStart, (error: unknown) => setProblem(error instanceof Refused ? error.message : String(error)));
    reload();
  }, []);
  // What a job has written appears when it ends.
  const ended = jobs.filter((job) => !isOpen(job)).length;
  useEffect(reload, [ended, page]);

  // The address follows the controls, a little behind, so that a moving slider leaves no trail.
  const timer = useRef(0);
  const go = (page: Page, state: ShotState, isNew: boolean) => {
    setAddress({ page, state });
    const search = toAddress(state);
    const hash = `#/${page}${search === "" ? "" : `?${search}`}`;
    clearTimeout(timer.current);
    if (isNew) history.pushState(null, "", hash);
    else timer.current = window.setTimeout(() => history.replaceState(null, "", hash), 250);
  };
  const change = (change: Partial<ShotState>) => go("shot", { ...state, ...change }, false);
  const openPlace = (x: number, y: number, shot: Nominal | null) => {
    const angle = (Math.atan2(y, x) * 180) / Math.PI;
    const next = { ...state, distance: Number(inSystem(Math.hypot(x, y), "length", state.units).toFixed(4)), angle: Number(angle.toFixed(2)) };
    if (shot) {
      next.speed = Number(inSystem(shot.speed_m_s, "speed", state.units).toFixed(3));
      next.pitch = Number(((shot.pitch_rad * 180) / Math.PI).toFixed(1));
      next.aim = Number(((shot.polar_rad * 180) / Math.PI - angle).toFixed(2));
      next.backspin = Number((shot.backspin_rad_s / (2 * Math.PI)).toFixed(2));
    }
    go("shot", next, true);
  };
  const working = jobs.filter(isOpen).length;
  return (
    <JobsContext.Provider value={jobs}>
      <header>
        <a class="skip" href="#main" onClick={(event) => (event.preventDefault(), document.getElementById("main")?.focus())}>
          To the content
        </a>
        <h1>bankshot studio</h1>
        <nav aria-label="pages">
          {PAGES.map(([name, words]) => (
            <a
              key={name}
              href={`#/${name}`}
              aria-current={name === page ? "page" : undefined}
              onClick={(event) => {
                event.preventDefault();
                go(name, state, true);
              }}
            >
              {words}
            </a>
          ))}
        </nav>
        <label class="theme">
          <span class="hidden">colours</span>
          <select
            value={theme}
            onChange={(event) => {
              const next = event.currentTarget.value as Theme;
              choose(next);
              setTheme(next);
            }}
          >
            <option value="system">colours of the system</option>
            <option value="light">light</option>
            <option value="dark">dark</option>
          </select>
        </label>
      </header>
      {lost !== "" && problem === "" && (
        <p class="banner" role="alert">
          {lost}
        </p>
      )}
      {problem !== "" && (
        <p class="banner" role="alert">
          {problem}
        </p>
      )}
      {working > 0 && page !== "players" && page !== "court" && page !== "launcher" && (
        <p class="banner quiet" role="status">
          {working === 1 ? "One job runs." : `${working} jobs run or wait.`} The numbers here come more slowly meanwhile.
        </p>
      )}
      <main id="main" tabIndex={-1}>
        {start && page === "shot" && <ShotPage state={state} start={start} folder={folder} change={change} replace={(next) => go("shot", next, false)} />}
        {start && page === "players" && (
          <PlayersPage folder={folder} reload={reload} places={start.places.map((place) => place.name)} openShot={(fit: Fit) => go("shot", playersShot(state, fit, 0), true)} />
        )}
        {start && page === "court" && <CourtPage start={start} folder={folder} state={state} openPlace={openPlace} reload={reload} />}
        {start && page === "launcher" && <LauncherPage start={start} folder={folder} />}
      </main>
      <footer>
        {start && `bankshot ${start.version} (${start.commit})`}
        {folder && `, results in ${folder.folder}`}
      </footer>
    </JobsContext.Provider>
  );
}

setTheme(storedTheme());
render(<App />, document.getElementById("app")!);
