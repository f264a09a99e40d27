// The script of a report: the shots in the view of the studio, and tables that sort. It is part of the
// page's one file and loads nothing.

import type { CourtLines, Hoop } from "./api";
import type { Path } from "./scene";
import { CourtScene } from "./scene";

interface Shot {
  place: number;
  kind: "direct" | "bank";
  x_m: number;
  y_m: number;
  where: string;
  words: string;
  path?: Path;
  mirror_of?: number;
}

interface Data {
  shots: Shot[];
  court: CourtLines & Hoop;
  first_place: number;
  places_are?: string;
}

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

const data = JSON.parse(element("data").textContent ?? "") as Data;
const { shots } = data;
const places = [...new Set(shots.map((shot) => shot.place))];
const state = { place: Math.max(0, places.indexOf(data.first_place)), kind: "both", isPlaying: false };

/** A mirror image has the path of its other side. */
function pathOf(shot: Shot): Path {
  if (shot.path) return shot.path;
  const other = shots[shot.mirror_of ?? -1]?.path ?? [];
  return other.map(([t, x, y, z]) => [t, x, -y, z]);
}

function current(): Shot[] {
  const here = shots.filter((shot) => shot.place === places[state.place]);
  const chosen = here.filter((shot) => state.kind === "both" || shot.kind === state.kind);
  return chosen.length > 0 ? chosen : here;
}

const canvas = element<HTMLCanvasElement>("view");
const time = element<HTMLInputElement>("time");
const place = element<HTMLInputElement>("place");
const kind = element<HTMLSelectElement>("kind");
const playButton = element<HTMLButtonElement>("play");

function view(): CourtScene | null {
  const colours = { balls: ["#0072b2", "#b85c00"] as [string, string], floor: "#e2cba4", line: "#ffffff", background: "#f3f5f6" };
  try {
    const scene = new CourtScene(canvas, colours, true);
    scene.setCourt(data.court, data.court);
    return scene;
  } catch {
    canvas.replaceWith("This browser shows no 3-D pictures (WebGL is off); the words and the tables say the same.");
    return null;
  }
}

const scene = view();

function play(isOn: boolean) {
  state.isPlaying = isOn;
  playButton.textContent = isOn ? "Stop" : "Play";
  playButton.setAttribute("aria-pressed", String(isOn));
  scene?.play(isOn);
}

/** Shows the shots of the place. */
function show(isNewPlace: boolean) {
  const here = current();
  const first = here[0];
  const where = first && places.length > 1 ? (data.places_are ? `${first.where}: ` : `From ${first.where}. `) : "";
  const shown = element("shown");
  shown.textContent = where + here.map((shot) => shot.words).join(" ");
  canvas.setAttribute("aria-label", `The flight of the ball, to be turned with the arrow keys. ${shown.textContent}`);
  for (const row of document.querySelectorAll<HTMLElement>("tr[data-shot]")) {
    const shot = shots[Number(row.dataset.shot)];
    row.classList.toggle("chosen", shot !== undefined && here.includes(shot));
  }
  element("place-name").textContent = first?.where ?? "";
  scene?.setBalls(here.map((shot) => ({ isSecond: shot.kind === "bank", path: pathOf(shot) })));
  scene?.seek(Number(time.value) / 1000);
  if (first && isNewPlace) {
    scene?.setShooter(first.x_m, first.y_m, data.court.hoop_height_m + (pathOf(first)[0]?.[3] ?? 0));
    scene?.look("side");
  }
}

playButton.addEventListener("click", () => play(!state.isPlaying));
if (scene) {
  scene.onTime = (share) => {
    time.value = String(Math.round(1000 * share));
    // Once is enough on a page to read.
    if (share >= 1) play(false);
  };
}
time.addEventListener("input", () => {
  play(false);
  scene?.seek(Number(time.value) / 1000);
});
place.max = String(places.length - 1);
place.value = String(state.place);
place.addEventListener("input", () => {
  state.place = Number(place.value);
  show(true);
});
kind.addEventListener("change", () => {
  state.kind = kind.value;
  show(false);
});
// Nothing to choose, nothing to tell apart.
if (places.length < 2) place.closest("label")!.hidden = true;
if (data.places_are) element("places-are").textContent = data.places_are;
if (new Set(shots.map((shot) => shot.kind)).size < 2) {
  kind.closest("label")!.hidden = true;
  element("colours").hidden = true;
}

canvas.addEventListener("keydown", (event) => {
  const turns: Record<string, [number, number, number?]> = {
    ArrowLeft: [-0.1, 0],
    ArrowRight: [0.1, 0],
    ArrowUp: [0, 0.08],
    ArrowDown: [0, -0.08],
    "+": [0, 0, 1.2],
    "-": [0, 0, 1 / 1.2],
  };
  const turn = turns[event.key];
  if (turn) scene?.turn(...turn);
  else if (event.key === " ") play(!state.isPlaying);
  else return;
  event.preventDefault();
});
// On a narrow screen a figure fits the width; a tap enlarges it.
for (const figure of document.querySelectorAll("figure")) figure.addEventListener("click", () => figure.classList.toggle("enlarged"));
addEventListener("beforeprint", () => scene?.picture());

/** Sorts the rows by a column, numbers before texts as numbers. */
function sort(table: HTMLTableElement, column: number, isDown: boolean) {
  const value = (row: HTMLTableRowElement) => row.cells[column]?.dataset.value ?? row.cells[column]?.textContent ?? "";
  const compare = (a: HTMLTableRowElement, b: HTMLTableRowElement) => {
    const [x, y] = [value(a), value(b)];
    const [p, q] = [Number(x), Number(y)];
    const order = x !== "" && y !== "" && !Number.isNaN(p) && !Number.isNaN(q) ? p - q : x.localeCompare(y);
    return isDown ? -order : order;
  };
  const body = table.tBodies[0]!;
  body.append(...[...body.rows].sort(compare));
}

for (const table of document.querySelectorAll<HTMLTableElement>("table.sortable")) {
  const heads = [...table.tHead!.rows[0]!.cells];
  heads.forEach((head, column) => {
    head.querySelector("button")?.addEventListener("click", () => {
      const isDown = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", isDown ? "descending" : "ascending");
      sort(table, column, isDown);
    });
  });
  table.tBodies[0]!.addEventListener("click", (event) => {
    const row = (event.target as HTMLElement).closest<HTMLElement>("tr[data-shot]");
    const shot = row && shots[Number(row.dataset.shot)];
    if (!shot) return;
    state.place = places.indexOf(shot.place);
    place.value = String(state.place);
    show(true);
  });
}

show(true);
// For tests: what the page shows.
Object.assign(window, { bankshot: { state, shots, places, picture: () => scene?.picture() ?? "" } });
