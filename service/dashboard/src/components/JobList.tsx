import { useClassifications, useJobs } from "../api/queries";
import { isTerminal } from "../api/types";
import type { Classification, Job } from "../api/types";
import { useNow } from "../hooks/useNow";
import { ago, duration, jobKind, jobState, parseTime } from "../lib/format";
import { formatRoute } from "../lib/route";
import { Problem } from "./Problem";

/** The newest jobs; drawing a thumbnail is only worth a line while it runs or when it failed. */
export function JobList({ hideEmpty = false }: { hideEmpty?: boolean }) {
  const jobs = useJobs();
  const classifications = useClassifications();
  const now = useNow(2000);
  const shown = (jobs.data?.items ?? [])
    .filter((job) => job.kind !== "render_thumbnail" || job.state === "failed" || job.state === "running")
    .toSorted((a, b) => b.created_at.localeCompare(a.created_at))
    .slice(0, 20);
  if (hideEmpty && shown.length === 0 && !jobs.error) return null;
  return (
    <section className="jobs" aria-labelledby="jobs-title">
      <h2 id="jobs-title">Recent jobs</h2>
      {jobs.error && !jobs.data && <Problem error={jobs.error} onRetry={() => void jobs.refetch()} />}
      {jobs.isSuccess && shown.length === 0 && (
        <p className="muted">Nothing has run yet. Training, classifying and estimating show up here.</p>
      )}
      {shown.length > 0 && (
        <ul className="job-rows">
          {shown.map((job) => (
            <li key={job.id} className="job-row" data-state={job.state}>
              <span className="dot" aria-hidden="true" />
              <span className="job-kind">{jobKind(job.kind)}</span>
              <span className="job-state" title={job.error?.detail}>
                {describe(job)}
              </span>
              <span className="job-took">{took(job, now)}</span>
              <span className="job-when">{ago(parseTime(job.created_at), now)}</span>
              <span className="job-open">
                <ResultLink job={job} classifications={classifications.data?.items ?? []} />
              </span>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}

function describe(job: Job): string {
  if (job.state === "running") return `${Math.round((job.progress?.fraction ?? 0) * 100)} %  ${job.progress?.message ?? ""}`;
  if (job.state === "failed" && job.error) return `Failed: ${job.error.title}`;
  return jobState(job.state);
}

function took(job: Job, now: Date): string {
  if (!job.started_at) return "";
  const end = job.finished_at ? parseTime(job.finished_at) : isTerminal(job.state) ? null : now;
  return end ? duration(Math.max(0, end.getTime() - parseTime(job.started_at).getTime()) / 1000) : "";
}

/** Leads to what the job is about, where the page has a place for it. */
function ResultLink({ job, classifications }: { job: Job; classifications: Classification[] }) {
  const id = job.result_url?.split("/").pop();
  if (!id) return null;
  if (job.kind === "index_collection") return <a href={formatRoute({ kind: "collection", id })}>Open</a>;
  if (job.kind === "retrieve") return <a href={formatRoute({ kind: "retrieval", id })}>Open</a>;
  if (job.kind === "estimate") return <a href={formatRoute({ kind: "estimation", id })}>Open</a>;
  const meshId = classifications.find((classification) => classification.id === id)?.mesh_id;
  if (job.kind === "classify" && meshId) return <a href={formatRoute({ kind: "mesh", id: meshId })}>Open</a>;
  return null;
}
