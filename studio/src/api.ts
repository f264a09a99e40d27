// The server's interface: docs/studio.openapi.json describes it.

export interface Fault {
  field: string | null;
  message: string;
}

/** A request that was refused. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly faults: Fault[],
  ) {
    super(faults.map((fault) => (fault.field ? `${fault.field}: ${fault.message}` : fault.message)).join("\n"));
  }

  /** What is wrong with one field. */
  of(field: string): string | undefined {
    return this.faults.find((fault) => fault.field === field)?.message;
  }
}

/** The name that a file is kept under: characters that some systems have no use for become dashes. */
function keptName(name: string): string {
  const clean = (text: string) => text.replace(/[^\p{L}\p{N} \-_.()+]/gu, "-");
  const dot = name.lastIndexOf(".");
  const [stem, end] = dot > 0 ? [name.slice(0, dot), clean(name.slice(dot)).slice(0, 10)] : [name, ""];
  const kept = clean(stem).replace(/^[^\p{L}\p{N}]+/u, "").slice(0, 60 - end.length).replace(/[. ]+$/, "");
  return (kept || "shots") + end;
}

/** Tells this page from others of the same browser: a newer question of a page ends its older one. */
const PAGE = Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16).padStart(2, "0")).join("");

async function refusal(response: Response): Promise<Refused> {
  try {
    const body = (await response.json()) as { errors?: Fault[] };
    if (Array.isArray(body.errors)) return new Refused(response.status, body.errors);
  } catch {
    // The answer is not ours; its status says enough.
  }
  return new Refused(response.status, [{ field: null, message: `the studio answered ${response.status} ${response.statusText}` }]);
}

async function send(path: string, init: RequestInit): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, init);
  } catch {
    throw new Refused(0, [{ field: null, message: "the studio does not answer; is it still running in the terminal?" }]);
  }
  if (!response.ok) throw await refusal(response);
  return response;
}

export async function get<T>(path: string): Promise<T> {
  return (await (await send(path, {})).json()) as T;
}

export async function post<T>(path: string, body: unknown): Promise<T> {
  const init = { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) };
  return (await (await send(path, init)).json()) as T;
}

export async function remove(path: string): Promise<void> {
  await send(path, { method: "DELETE" });
}

export async function upload(file: File): Promise<string> {
  const path = `/api/uploads/${encodeURIComponent(keptName(file.name))}`;
  const answer = await (await send(path, { method: "PUT", body: file })).json();
  return (answer as { name: string }).name;
}

interface Line<T, D> {
  draft?: D;
  answer?: T;
  notes?: string[];
  stopped?: boolean;
  errors?: Fault[];
}

export interface Answered<T> {
  answer: T;
  notes: string[];
}

/** Asks a question. `draft` gets what is known early. `null` if a newer question ended this one. */
export async function ask<T, D = T>(question: object, draft: (draft: D) => void = () => {}, fit = ""): Promise<Answered<T> | null> {
  const headers: Record<string, string> = { "content-type": "application/json", "x-page": PAGE };
  if (fit !== "") headers["x-fit"] = encodeURIComponent(fit);
  const response = await send("/api/answer", { method: "POST", headers, body: JSON.stringify(question) });
  const reader = response.body!.pipeThrough(new TextDecoderStream()).getReader();
  let rest = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return null;
    rest += value;
    const lines = rest.split("\n");
    rest = lines.pop() ?? "";
    for (const text of lines) {
      const line = JSON.parse(text) as Line<T, D>;
      if (line.errors) throw new Refused(400, line.errors);
      if (line.stopped) return null;
      if (line.draft) draft(line.draft);
      if (line.answer) return { answer: line.answer, notes: line.notes ?? [] };
    }
  }
}

export interface Hoop {
  hoop_height_m: number;
  board_distance_m: number;
  board_width_m: number;
  board_height_m: number;
  board_centre_height_m: number;
  ring_radius_m: number;
  bracket_width_m: number;
  ball_radius_m: number;
}

export interface CourtLines {
  baseline_x_m: number;
  half_line_x_m: number;
  half_width_m: number;
  lane_half_width_m: number;
  free_throw_x_m: number;
  circle_radius_m: number;
  restricted_radius_m: number;
  three_radius_m: number;
  three_corner_y_m: number;
  three_break_x_m: number;
}

export interface NamedPlace {
  name: string;
  x_m: number;
  y_m: number;
}

export interface Start {
  version: string;
  commit: string;
  physics: { name: string; description: string; hoop: Hoop }[];
  court: CourtLines;
  places: NamedPlace[];
}

export interface FileEntry {
  name: string;
  bytes: number;
  written_s: number;
}

export interface Folder {
  folder: string;
  fits: string[];
  sweeps: string[];
  uploads: string[];
  files: FileEntry[];
}

export type Stage = "waiting" | "running" | "done" | "failed" | "stopped";

export interface Job {
  id: number;
  request: { job: string; name: string; [key: string]: unknown };
  stage: Stage;
  step: string;
  done: number;
  total: number;
  exit_code: number | null;
  answer: string;
  remarks: string;
  folder: string;
}

/** The name of a fit for people: the player first. */
export function shortName(name: string): string {
  const parts = name.split("/");
  const from = parts.length > 2 ? parts[1] : parts[0];
  return parts.length > 1 ? `${parts.at(-1)} (${from})` : name;
}

/** The address of a file of the folder. */
export const fileAddress = (name: string) => `/files/${name.split("/").map(encodeURIComponent).join("/")}`;
