// What the Shot page shows, and the address that says it.

import type { System } from "./units";
import { converted, text, valueOf } from "./units";

/** The numbers of the controls, in the chosen units. */
export interface ShotState {
  units: System;
  /** The folder of a fitted player; empty for the numbers below. */
  player: string;
  /** The index of the place of the player's fit. */
  fitPlace: number;
  distance: number;
  angle: number;
  height: number;
  physics: string;
  speed: number;
  pitch: number;
  aim: number;
  backspin: number;
  side: number;
  sdSpeed: number;
  sdPitch: number;
  sdPolar: number;
  sdBackspin: number;
}

export const START: ShotState = {
  units: "imperial",
  player: "",
  fitPlace: 0,
  distance: 13.75,
  angle: 0,
  height: 7,
  physics: "ncaa",
  speed: 24.3,
  pitch: 53.5,
  aim: 0,
  backspin: 3,
  side: 0,
  sdSpeed: 0.25,
  sdPitch: 1.2,
  sdPolar: 1.22,
  sdBackspin: 0.3,
};

const TEXTS = ["units", "player", "physics"] as const;

/** The part of the address behind `#/shot?`: only what differs from the start. */
export function toAddress(state: ShotState): string {
  const parts = Object.entries(state).filter(([key, value]) => value !== START[key as keyof ShotState]);
  return new URLSearchParams(parts.map(([key, value]) => [key, String(value)])).toString();
}

export function fromAddress(search: string): ShotState {
  const state: Record<string, unknown> = { ...START };
  for (const [key, value] of new URLSearchParams(search)) {
    if (!(key in START)) continue;
    if ((TEXTS as readonly string[]).includes(key)) state[key] = value;
    else if (value !== "" && Number.isFinite(Number(value))) state[key] = Number(value);
  }
  if (state.units !== "metric") state.units = "imperial";
  return state as unknown as ShotState;
}

const LENGTHS = ["distance", "height"] as const;
const SPEEDS = ["speed", "sdSpeed"] as const;

/** The same shot in the other units. */
export function inUnits(state: ShotState, units: System): ShotState {
  if (units === state.units) return state;
  const next = { ...state, units };
  for (const key of LENGTHS) next[key] = converted(state[key], "length", state.units, units);
  for (const key of SPEEDS) next[key] = converted(state[key], "speed", state.units, units);
  return next;
}

/** The text of a profile of the page's own numbers. */
export function profileToml(state: ShotState): string {
  const { units } = state;
  const spins = `max_backspin = "${Math.max(state.backspin, 3)} rev/s"\n`;
  return (
    `[shooter]\nname = "player"\nrelease_height = "${text(state.height, "length", units)}"\n${spins}\n` +
    `[shooter.errors]\nspeed = "${text(state.sdSpeed, "speed", units)}"\npitch = "${state.sdPitch} deg"\n` +
    `polar = "${state.sdPolar} deg"\nbackspin = "${state.sdBackspin} rev/s"\n\n` +
    `[location]\ndistance = "${text(state.distance, "length", units)}"\nangle = "${state.angle} deg"\n\n` +
    `[physics]\npreset = "${state.physics}"\n\n[output]\nunits = "${units}"\n`
  );
}

/** A fit, as far as the Shot page uses it. */
export interface Fit {
  name: string;
  fit: {
    shooter: string;
    parameters: { name: string; unit: string; mean: number }[];
    places: Record<string, unknown>[];
  };
  profiles: string[];
}

/** A fitted player at the place of the fit, with the current shot there. */
export function playersShot(state: ShotState, fit: Fit, place: number): ShotState {
  const parameter = (name: string) => {
    const own = place === 0 ? [name] : [`${name}_place_${place + 1}`, name];
    return own.map((one) => fit.fit.parameters.find((parameter) => parameter.name === one)).find((one) => one !== undefined);
  };
  const mean = (name: string) => parameter(`${name}_mean`)?.mean ?? 0;
  const units: System = parameter("speed_mean")?.unit === "m/s" ? "metric" : "imperial";
  const at = fit.fit.places[place] ?? {};
  const value = (name: string) => valueOf(at, name) ?? 0;
  const angle = value("court_angle");
  const shot: ShotState = {
    ...inUnits(state, units),
    player: fit.name,
    fitPlace: place,
    distance: Number(value("distance").toFixed(3)),
    angle: Number(angle.toFixed(2)),
    height: Number(value("release_height").toFixed(3)),
    speed: Number(mean("speed").toFixed(3)),
    pitch: Number(mean("pitch").toFixed(2)),
    aim: Number((mean("polar") - angle).toFixed(3)),
    backspin: Number(mean("backspin").toFixed(3)),
    side: 0,
  };
  return inUnits(shot, state.units);
}

/** The shot as the server takes it. */
export function shotRequest(state: ShotState) {
  return {
    speed: text(state.speed, "speed", state.units),
    pitch: `${state.pitch} deg`,
    aim: `${state.aim} deg`,
    backspin: `${state.backspin} rev/s`,
    ...(state.side === 0 ? {} : { side_spin: `${state.side} rev/s` }),
  };
}

/** The flags of the shot for `bankshot shot`. */
export function shotFlags(state: ShotState): string {
  const flags = Object.entries(shotRequest(state)).map(([name, value]) => `--${name.replace("_", "-")} '${value}'`);
  return flags.join(" ");
}
