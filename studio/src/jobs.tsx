// Long work: how far it is, and a button to stop it.

import { createContext } from "preact";
import { useContext, useEffect, useState } from "preact/hooks";
import type { Job } from "./api";
import { get, remove } from "./api";

export const JobsContext = createContext<Job[]>([]);

/** The jobs as the server sends them; the connection is taken up again by itself. */
export function useJobEvents(): { jobs: Job[]; lost: string } {
  const [jobs, setJobs] = useState<Job[]>([]);
  const [lost, setLost] = useState("");
  useEffect(() => {
    const source = new EventSource("/api/events");
    source.onmessage = (event) => {
      setLost("");
      setJobs(JSON.parse(event.data as string) as Job[]);
    };
    source.onerror = () => {
      // Why: the studio has ended, or this page is of an earlier start.
      get("/api/jobs").then(
        () => setLost(""),
        (error: unknown) => setLost(error instanceof Error ? error.message : String(error)),
      );
    };
    return () => source.close();
  }, []);
  return { jobs, lost };
}

const NAMES: Record<string, string> = {
  players: "Fit",
  advise: "Advice",
  team: "Team page",
  compare: "Sessions",
  sweep: "Sweep",
  continue: "Sweep",
  table: "Launcher table",
};

export const isOpen = (job: Job) => job.stage === "waiting" || job.stage === "running";

/** The jobs of some kinds, the newest first. */
export function useJobs(kinds: string[]): Job[] {
  return useContext(JobsContext)
    .filter((job) => kinds.includes(job.request.job))
    .reverse();
}

export function JobCard({ job }: { job: Job }) {
  const share = job.total > 0 ? job.done / job.total : undefined;
  const words = {
    waiting: "waits for the job before it",
    running: job.step === "" ? "starting" : job.step,
    done: job.exit_code === 0 ? "done" : "done, with remarks",
    failed: "failed",
    stopped: "stopped; what was finished is kept",
  }[job.stage];
  return (
    <section class={`job ${job.stage}`} aria-label={`${NAMES[job.request.job] ?? job.request.job} ${job.request.name}`}>
      <div class="job-line">
        <strong>
          {NAMES[job.request.job] ?? job.request.job}: {job.request.name}
        </strong>
        <span role="status">{words}</span>
        {isOpen(job) && (
          <button type="button" class="quiet" onClick={() => void remove(`/api/jobs/${job.id}`)}>
            Stop
          </button>
        )}
      </div>
      {job.stage === "running" && (
        <progress aria-label="progress" max={1} {...(share === undefined ? {} : { value: share })} />
      )}
      {job.remarks.trim() !== "" && <pre class={job.stage === "failed" ? "error" : "remarks"}>{job.remarks.trim()}</pre>}
    </section>
  );
}
